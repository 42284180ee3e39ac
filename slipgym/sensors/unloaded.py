"""Reads the force/torque sensors of the open gripper, before the grasp: an estimator can zero them.

Zero error, noise, drift, quantisation and lost readings are those of the episode. There is no load but the
weight of the fingertip in the pose of the grasp, and a late reading is like any other. Random numbers are
taken from the sensor's keys, at indices that no later reading uses.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.sensors.force_torque import reading_at, resolve_at_cop
from slipgym.sensors.measure import CONTACT_THRESHOLD
from slipgym.sensors.misalignment import mixed, share
from slipgym.sensors.noise import standard_normal

READINGS = 24
"""Readings before the grasp, one per control step."""
_BEFORE = 1 << 38
"""Index of the first random number; the noise after the grasp uses smaller ones."""
_LOST = 1 << 21
"""Number of `share` of the first reading that may be lost; later readings use smaller ones."""


@compiled
def _step_of_bias(sensor: Any, k: int, a: int) -> float:
    """Change of the bias of an axis between the readings k and k + 1 before the grasp [N or N m]."""
    if not sensor.drift[a] > 0.0:
        return 0.0
    return sensor.drift[a] * standard_normal(sensor.drift_key, _BEFORE + 6 * k + a)


@compiled
def read_unloaded(sensor: Any, wrenches: np.ndarray) -> None:
    """The readings of a sensor before the grasp; its bias drifts to what it is at the grasp.

    Args:
        sensor: FORCE_TORQUE record at the start of an episode; `tip_load` is the weight of its fingertip.
        wrenches: Output (READINGS, 4): (f_x, f_y, f_n, tau) at the measured centre of pressure, as
            `slipgym.sensors.measure.measure` has it [N, N, N, N m].
    """
    bias, reading, cop, load = np.empty(6), np.empty(6), np.empty(2), np.zeros(6)
    load[0], load[1] = sensor.tip_load[0], sensor.tip_load[1]
    for a in range(6):
        bias[a] = sensor.bias[a]
        if sensor.tip_mass > 0.0:
            bias[a] += mixed(sensor, load, a) if sensor.misaligned else load[a]
        for k in range(READINGS):
            bias[a] -= _step_of_bias(sensor, k, a)
    for k in range(READINGS):
        lost = k > 0 and sensor.dropout > 0.0 and share(sensor.key, _LOST + k) < sensor.dropout
        for a in range(6):
            if not lost:
                reading[a] = reading_at(sensor, a, bias[a], _BEFORE + 6 * k + a)
            bias[a] += _step_of_bias(sensor, k, a)
        resolve_at_cop(sensor, reading, CONTACT_THRESHOLD, wrenches[k], cop)
