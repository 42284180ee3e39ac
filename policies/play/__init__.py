"""Watching policies: in a window, as a film, as one picture."""

from policies.play.screenshot import own_policy, portrait, write_portraits
from policies.play.video import FILM_TYPES, Film
from policies.play.watch import Outcome, watch

__all__ = ["FILM_TYPES", "Film", "Outcome", "own_policy", "portrait", "watch", "write_portraits"]
