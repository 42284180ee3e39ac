"""What makes a task."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from slipgym.tasks.options import EpisodeOptions


class Column(NamedTuple):
    """One entry of the observation."""

    name: str
    low: float
    high: float
    unit: str
    meaning: str


@dataclass(frozen=True)
class Task:
    """A task as functions over a leading batch axis, so that every world can run it."""

    name: str
    """Name in the environment's id."""
    key: str
    """Its group under `tasks` in the configuration."""
    options: type[EpisodeOptions]
    """What `reset(options=...)` can fix."""
    terms: tuple[str, ...]
    """Names of the reward terms, in the order of the configuration's `reward` group."""
    columns: tuple[Column, ...]
    """The task's part of the observation."""
    start: Callable[..., None]
    """Fills one EPISODE row: (config, options, rng, episode)."""
    plan: Callable[..., None]
    """Compiled, before a control step: (episodes, worlds) sets wrist motion and disturbance."""
    judge: Callable[..., None]
    """Compiled, after a control step: (episodes, worlds, fingers, columns)."""
    action_mode: str = "grip_force"
    """Of its environment, unless another is asked for."""
