"""Lists the parameters that a log can show: prior, unit, transform and place in the rollouts.

One line of `PARAMETERS` is one parameter. Its prior is normal in the transformed value: the value itself, or
its logarithm.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Parameter:
    """One parameter and what is believed of it before the log."""

    name: str
    """Its name in reports."""
    unit: str
    """Its SI unit."""
    prior: float
    """Median before the log."""
    deviation: float
    """Standard deviation of the prior, in the transformed value."""
    log: bool = False
    """Whether the transformed value is the logarithm; otherwise the value itself."""
    key: str = ""
    """Dotted key of the configuration that takes the value as it is; empty: `overrides` places it."""
    low: float = -np.inf
    """Least value of the configuration."""
    high: float = np.inf
    """Largest value of the configuration."""


_PAD = "contact.pad."
PARAMETERS = (
    Parameter("mu_c", "-", 0.4, 0.6, True, low=0.001, high=10.0),
    # the ratio is what stays positive: mu_s = mu_c (1 + excess)
    Parameter("static excess", "-", 0.3, 0.8, True, low=0.0, high=10.0),
    Parameter("v_s", "m/s", 1e-3, 1.0, True, "contact.stribeck_velocity", 1e-5, 0.1),
    Parameter("sigma_2", "s/m", 0.2, 1.0, True, "contact.sigma_2", 0.0, 1000.0),
    Parameter("r", "m", 0.010, 0.3, True, "contact.radius", 1e-4, 0.2),
    Parameter("load exponent", "-", 0.0, 0.15, False, _PAD + "load_exponent", -0.4, 0.5),
    Parameter("radius exponent", "-", 0.12, 0.10, False, _PAD + "radius_exponent", 0.0, 1.0 / 3.0),
    Parameter("shear compliance", "m/N", 3e-5, 1.0, True, _PAD + "shear_compliance", 0.0, 1e-3),
    Parameter("cop x", "m", 0.0, 2e-3),
    Parameter("cop y", "m", 0.0, 2e-3),
    Parameter("lag", "s", 0.015, 0.7, True, "gripper.lag", 0.0, 1.0),
    Parameter("dead time", "s", 0.008, 0.7, True, "gripper.dead_time", 0.0, 1.0),
    Parameter("force gain", "-", 1.0, 0.1, True, low=0.1, high=10.0),
    Parameter("wrench latency", "s", 0.005, 0.7, True, "sensors.force_torque.latency", 0.0, 10.0),
    Parameter("slip latency", "s", 0.015, 0.7, True, low=0.0, high=1.0),
    Parameter("zero f_x", "N", 0.0, 0.2),
    Parameter("zero f_y", "N", 0.0, 0.2),
    Parameter("zero f_n", "N", 0.0, 0.3),
    Parameter("zero tau", "N m", 0.0, 2e-3),
)
"""Every parameter, in the order of the columns of a rollout's input."""
NAMES = tuple(each.name for each in PARAMETERS)
START = np.array([np.log(each.prior) if each.log else each.prior for each in PARAMETERS])
DEVIATION = np.array([each.deviation for each in PARAMETERS])
"""Transformed medians and standard deviations of the priors, (p,)."""


def values_of(points: np.ndarray) -> np.ndarray:
    """Values of transformed points (..., p), within the configuration's ranges, (..., p)."""
    columns = []
    for k, each in enumerate(PARAMETERS):
        column = np.exp(points[..., k]) if each.log else points[..., k]
        columns.append(np.clip(column, each.low, each.high))
    return np.stack(columns, axis=-1)
