"""Checks of an environment's keyword arguments."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict
from typing import Any

from gymnasium.vector import AutoresetMode

import estimator as estimators
from estimator.registry import specification
from slipgym.config.errors import unknown

DEFAULT_ESTIMATOR = estimators.DEFAULT
LATENCY = "velocity_delay"
"""Parameter by which an estimator is told how old a velocity is."""


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


def chosen_estimator(choice: str | Mapping[str, Any]) -> dict[str, Any]:
    """Name and all parameters; one that asks how old a velocity is, is told unless it was given that."""
    if isinstance(choice, str):
        choice = {"name": choice}
    if not isinstance(choice, Mapping) or not isinstance(choice.get("name"), str):
        raise ValueError(
            f"estimator = {choice!r} must be a name or a mapping with a name; "
            f"valid: {', '.join(estimators.names())}"
        )
    given = dict(choice)
    name = given.pop("name")
    parameters = asdict(specification(name).parameters.create(**given))
    if LATENCY not in given:
        parameters.pop(LATENCY, None)
    return {"name": name, **parameters}
