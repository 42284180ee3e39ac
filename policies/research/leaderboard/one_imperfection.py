"""Which imperfection of the sensors "lab" makes which error: each alone, beside "realistic" and "lab"."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from slipgym.config import load

Values = dict[str, dict[str, Any]]
IMPERFECTIONS = {
    "bias": {"force_torque": ("bias_tangential", "bias_normal", "bias_torque")},
    "drift": {"force_torque": ("drift_tangential", "drift_normal", "drift_torque")},
    "tilt": {"force_torque": ("tilt",)},
    "cross-talk": {"force_torque": ("crosstalk",)},
    "off centre": {"force_torque": ("off_centre",)},
    "late force": {"force_torque": ("latency_spread",)},
    "late velocity": {"slip": ("latency_samples", "latency_spread", "jitter")},
    "scale": {"slip": ("scale_error",)},
    "lost chip": {"slip": ("chip_failure",)},
    "lost readings": {"force_torque": ("dropout",), "slip": ("dropout",)},
}
"""Label -> for each sensor the parameters in which "lab" differs from "realistic"."""


def one_imperfection() -> Mapping[str, Mapping[str, Any]]:
    """Label -> arguments of the environments: none, one imperfection of "lab" each, all."""
    cases: dict[str, Mapping[str, Any]] = {"realistic": {"sensors": "realistic"}}
    for label in IMPERFECTIONS:
        cases[label] = {"sensors": "realistic", "config": {"sensors": values_of(label)}}
    return cases | {"lab": {"sensors": "lab"}}


def values_of(label: str) -> Values:
    """What "lab" has for an imperfection: sensor -> parameter -> value."""
    lab = load(sensors="lab").sensors
    return {
        sensor: {name: getattr(getattr(lab, sensor), name) for name in names}
        for sensor, names in IMPERFECTIONS[label].items()
    }
