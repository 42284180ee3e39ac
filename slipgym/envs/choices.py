"""Checks of an environment's keyword arguments and actions."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from slipgym.config.errors import unknown

DEFAULT_ESTIMATOR = "disc"
"""First of the leaderboard (docs/leaderboard.md), at a sixth of the cost of the filter beside it."""


def one_of(name: str, value: object, valid: Iterable[str]) -> str:
    """Return `value` if it is one of the valid names, or raise ValueError."""
    if not isinstance(value, str) or value not in tuple(valid):
        raise ValueError(unknown(name, value, valid))
    return value


def refuse_unknown(given: Iterable[str], known: Iterable[str]) -> None:
    """Raise TypeError if a keyword argument was given that is not known."""
    for name in given:
        raise TypeError(unknown("keyword argument", name, known))


def check_action(action: Any) -> float:
    """Return the single component of an action, clipped to [-1, 1].

    Raises:
        ValueError: The action is not numeric, has the wrong shape or is not finite.
    """
    try:
        array = np.asarray(action, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise ValueError(f"action = {action!r} must be an array of numbers, within [-1, 1]") from error
    if array.shape != (1,):
        raise ValueError(f"action must have shape (1,), got {array.shape}: {action!r}")
    value = array.item()
    if not -np.inf < value < np.inf:
        raise ValueError(f"action = {value!r} must be finite, within [-1, 1]")
    return min(max(value, -1.0), 1.0)
