"""Lists what "adaptive" found about the sensors: delay, zero errors, tilt, centre of pressure, viscosity.

Each value is what the fit holds, with its deviation, beside the spread that it had before the record.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from estimator.reasons import Doubts, doubts
from estimator.records.record import Array

CALIBRATES = "adaptive"
"""Name of the estimator that finds them."""
KNOWN = 0.95
"""Deviation over the spread at the start below which a record has shown something."""


@dataclass(frozen=True)
class Found:
    """One error of the sensors."""

    name: str
    """What it is, in words."""
    unit: str
    """Unit of the values."""
    value: float
    """Estimate."""
    sd: float
    """Its standard deviation."""
    spread: float
    """Standard deviation before the record."""

    @property
    def seen(self) -> bool:
        """Whether the record has shown it."""
        return self.sd < KNOWN * self.spread


@dataclass(frozen=True)
class Calibration:
    """Errors of the sensors that a run found since the last gap."""

    delay: int
    """Delay of the velocity against the force [samples]."""
    correlation: float
    """Largest correlation of the changes of force and velocity at it [-]."""
    delay_seen: bool
    """Whether that exceeded the gate; otherwise the delay is the nominal one."""
    errors: tuple[Found, ...]
    """Errors of the sensors, and the viscosity."""
    doubts: Doubts
    """What the last slips say against the law."""

    @property
    def misfit(self) -> float:
        """Mean squared normalised residual of the last slips; noise alone makes it 1 [-]."""
        return self.doubts.misfit


def calibration(state: np.void, parameters: Any, correlation: float, f_n: Array) -> Calibration:
    """Reads the last state of "adaptive".

    Args:
        state: Record of its state dtype.
        parameters: Its AdaptiveParameters.
        correlation: Largest `timing` of the state so far [-].
        f_n: Normal forces, (k,) [N].
    """
    from estimator.window.layout import COP, SIGMA, STATES, TILT, TORQUE, ZERO
    from estimator.window.sensors import GATE

    p, errors = parameters, []
    loaded = f_n[f_n >= p.eps_fn]
    load = float(np.median(loaded)) if len(loaded) else 0.0
    x, variance = state["x"], state["variance"]
    covariance, spreads = state["covariance"] if state["fits"] else np.diag(variance), np.sqrt(variance)
    spreads[ZERO : TORQUE + 1] = p.sd_zero, p.sd_zero, p.sd_zero_torque

    def add(name: str, unit: str, weights: dict[int, float], scale: float = 1.0) -> None:
        a = np.zeros(STATES)
        a[list(weights)] = np.array(list(weights.values())) * scale
        spread = math.sqrt(np.square(a * spreads).sum())
        errors.append(Found(name, unit, float(a @ x), math.sqrt(max(a @ covariance @ a, 0.0)), spread))

    for k, axis in enumerate("xy"):
        add(f"zero of f_{axis}", "N", {ZERO + k: 1.0})
    for k, axis in enumerate("xy"):
        add(f"tilt: f_{axis} by f_n", "-", {TILT + k: 1.0})
    for k, axis in enumerate("xy"):
        add(f"both at {load:.1f} N: f_{axis}", "N", {ZERO + k: 1.0, TILT + k: load})
    for k, axis in enumerate("xy"):
        add(f"CoP, {axis}", "mm", {COP + k: 1.0}, 1e3)
    sd = math.sqrt(float(state["variance_normal"]))
    errors.append(Found("zero of f_n", "N", float(state["zeros"][2]), sd, p.sd_zero))
    add("zero of tau", "N m", {TORQUE: 1.0})
    add("sigma_2", "s/m", {SIGMA: 1.0})
    return Calibration(int(state["delay"]), correlation, correlation > GATE, tuple(errors), doubts(state))


def calibration_rows(found: Calibration, step: float) -> list[list[str]]:
    """A heading, then a row of cells for the delay and for each error; dashes for what was not seen.

    To calibrate with it, subtract a zero error from the readings and f_n times the tilt from f_x and f_y;
    give the CoP as `cop_x` and `cop_y`. `step` is the time between two velocity samples [s].
    """
    samples = f"{found.delay} sample{'' if abs(found.delay) == 1 else 's'}"
    seen = f"correlation {found.correlation:.2f}" if found.delay_seen else "not seen: assumed"
    rows = [
        ["sensors", "found", "sd", "sd before"],
        ["delay", f"{samples}, {1e3 * step * found.delay:.1f} ms".replace("-", "−"), seen, ""],
    ]
    for error in found.errors:
        digits = max(0, 2 - math.floor(math.log10(error.spread)))
        sd, spread = f"{error.sd:.{digits}f}", f"{error.spread:.{digits}f}"
        cells = (
            [f"{round(error.value, digits) + 0.0:+.{digits}f}".replace("-", "−"), sd]
            if error.seen
            else ["–", "–"]
        )
        rows.append([f"{error.name} [{error.unit}]", *cells, spread])
    return rows
