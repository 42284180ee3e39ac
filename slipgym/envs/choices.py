"""Checks of an environment's keyword arguments."""

from __future__ import annotations

from collections.abc import Iterable

from gymnasium.vector import AutoresetMode

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


def whole(name: str, value: object, least: int) -> int:
    """Return `value` if it is a whole number of at least `least`, or raise ValueError."""
    if isinstance(value, bool) or not isinstance(value, int) or value < least:
        raise ValueError(f"{name} = {value!r} must be a whole number >= {least}")
    return value


def autoreset(mode: str | AutoresetMode) -> AutoresetMode:
    """Return an autoreset mode, or raise ValueError."""
    try:
        return AutoresetMode(mode)
    except ValueError:
        raise ValueError(unknown("autoreset_mode", mode, [each.value for each in AutoresetMode])) from None
