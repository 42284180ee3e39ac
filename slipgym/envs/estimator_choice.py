"""Which estimators an environment has, and what they know of its sensors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, fields
from typing import Any

import estimator as estimators
from estimator.registry import specification
from slipgym.config import Config

LATENCY = "velocity_delay"
"""Parameter of an estimator: the latency of the slip velocity."""


def chosen_estimator(choice: str | Mapping[str, Any]) -> dict[str, Any]:
    """Return the estimator's name and parameters.

    `velocity_delay` is left out unless the user gave it.
    """
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


def informed(choice: dict[str, Any], config: Config) -> dict[str, Any]:
    """The choice with what an estimator knows of the sensors: the latency that the preset states.

    It does not know what an episode samples on top.
    """
    known = {field.name for field in fields(specification(choice["name"]).parameters)}
    return {LATENCY: config.sensors.slip.latency_samples, **choice} if LATENCY in known else choice
