"""Separates the imperfections of the sensors "lab"."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from slipgym.config import load
from slipgym.config.errors import unknown

Values = dict[str, dict[str, Any]]
IMPERFECTIONS = {
    "bias": {"force_torque": ("bias_tangential", "bias_normal", "bias_torque")},
    "drift": {"force_torque": ("drift_tangential", "drift_normal", "drift_torque")},
    "tilt": {"force_torque": ("tilt",)},
    "cross-talk": {"force_torque": ("crosstalk",)},
    "off centre": {"force_torque": ("off_centre",)},
    "fingertip": {"force_torque": ("tip_mass", "tip_mass_spread")},
    "late force": {"force_torque": ("latency_spread", "own_latency")},
    "vibration": {"force_torque": ("mode_frequency", "mode_damping")},
    "late velocity": {"slip": ("latency_samples", "latency_spread", "own_latency", "jitter")},
    "resting chips": {"slip": ("rest_after", "rest_period", "speed_max")},
    "scale": {"slip": ("scale_error",)},
    "lost chip": {"slip": ("chip_failure",)},
    "lost readings": {"force_torque": ("dropout",), "slip": ("dropout",)},
}
"""Label -> for each sensor the parameters in which "lab" differs from "realistic"."""


def values_of(label: str, preset: str = "lab") -> Values:
    """Values of a preset of the sensors for one of `IMPERFECTIONS`: sensor -> parameter -> value.

    Raises:
        ValueError: There is no such imperfection.
    """
    if label not in IMPERFECTIONS:
        raise ValueError(unknown("imperfection", label, IMPERFECTIONS))
    sensors = load(sensors=preset).sensors
    return {
        sensor: {name: getattr(getattr(sensors, sensor), name) for name in names}
        for sensor, names in IMPERFECTIONS[label].items()
    }


def without(labels: Sequence[str]) -> Mapping[str, Any]:
    """Overrides of the configuration that give sensors what "realistic" has instead of some imperfections.

    They are named as in `IMPERFECTIONS`; hyphens may stand for spaces.

    Raises:
        ValueError: There is no such imperfection.
    """
    found: Values = {}
    spaced = {label.replace(" ", "-"): label for label in IMPERFECTIONS}
    for label in labels:
        for sensor, values in values_of(spaced.get(label, label), "realistic").items():
            found[sensor] = {**found.get(sensor, {}), **values}
    return {"sensors": found} if found else {}
