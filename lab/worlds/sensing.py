"""Converts a trace into the samples of a finger's sensors."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lab.worlds.scenario import Sensors
from lab.worlds.trace import Trace

FORCE_RATE = 1000
"""Samples of the force sensor in a second [Hz]."""
CHIP_RADIUS = 0.0243
"""Distance of three chips from the pad's centre; each counts along two axes [m]."""
CHIP_ANGLES = np.deg2rad([90.0, 210.0, 330.0])
NOISE = np.array([0.02, 0.02, 0.04, 5e-4])
"""Deviation of the noise of f_x, f_y, f_n, tau at 1 [N, N, N, N m]."""
TWIST_NOISE = np.array([1e-4, 1e-4, 4e-3])
"""The same of v_x, v_y, omega where nothing counts [m/s, m/s, rad/s]."""
FIRST = 3
"""Samples at the beginning that are never lost."""


def sample_steps(trace: Trace, sensors: Sensors, rng: np.random.Generator) -> NDArray[np.int64]:
    """Steps of a trace at whose ends the samples are taken, (m,), ascending."""
    n, each = len(trace.values), trace.rate // sensors.rate
    ends = np.arange(each, n + 1, each)
    if sensors.irregular:
        ends = np.unique(np.clip(ends + rng.integers(-each // 3, each // 3 + 1, len(ends)), 1, n))
    lost = rng.random(len(ends)) < sensors.lost
    lost[:FIRST] = False
    return ends[~lost] - 1


def wrenches(
    trace: Trace, sensors: Sensors, steps: NDArray[np.int64], rng: np.random.Generator
) -> NDArray[np.float64]:
    """f_x, f_y, f_n, tau at the assumed centre of pressure, (m, 4) [N, N, N, N m]."""
    each, (c_x, c_y) = trace.rate // FORCE_RATE, sensors.cop
    at = np.maximum((steps + 1) // each * each - 1, 0)  # the newest sample of the force sensor
    f_x, f_y, tau = sensors.sign * trace.friction[at].T
    f_n, t = trace.normal[at], (steps + 1) / trace.rate
    read = np.column_stack(
        (
            f_x + sensors.tilt[0] * f_n + sensors.drift[0] * t,
            f_y + sensors.tilt[1] * f_n + sensors.drift[1] * t,
            sensors.gain * f_n,
            tau + c_x * f_y - c_y * f_x,
        )
    )
    return read + sensors.zero + sensors.noise * NOISE * rng.standard_normal(read.shape)


def twists(
    trace: Trace, sensors: Sensors, steps: NDArray[np.int64], rng: np.random.Generator
) -> NDArray[np.float64]:
    """Mean v_x, v_y, omega at the assumed centre since the last sample, late, (m, 3) [m/s, m/s, rad/s]."""
    path = np.cumsum(trace.twist, axis=0) / trace.rate
    moved = np.diff(path[steps], axis=0, prepend=np.zeros((1, 3)))
    moved[:, 0] += moved[:, 2] * sensors.cop[1]
    moved[:, 1] -= moved[:, 2] * sensors.cop[0]
    time = np.diff(steps + 1, prepend=0)[:, None] / trace.rate
    if sensors.count > 0.0:
        seen = _counted(moved, sensors.count, rng) / time
    else:
        seen = moved / time + sensors.noise * TWIST_NOISE * rng.standard_normal(moved.shape)
    late = np.arange(len(steps)) - sensors.latency - (rng.random(len(steps)) < sensors.jitter)
    return np.where(late[:, None] >= 0, seen[np.maximum(late, 0)], 0.0)


def _counted(moved: NDArray[np.float64], count: float, rng: np.random.Generator) -> NDArray[np.float64]:
    """Displacements (m, 3) as the chips count them, by least squares."""
    rows = [
        row
        for angle in CHIP_ANGLES
        for row in ((1.0, 0.0, -CHIP_RADIUS * np.sin(angle)), (0.0, 1.0, CHIP_RADIUS * np.cos(angle)))
    ]
    travel = np.cumsum(moved, axis=0) @ np.array(rows).T / count + rng.random(len(rows))
    counts = np.diff(np.floor(travel), axis=0, prepend=0.0)
    return counts * count @ np.linalg.pinv(np.array(rows)).T
