"""Sensors at the start of an episode."""

from __future__ import annotations

import numpy as np

from slipgym.compiled import compiled
from slipgym.sensors.slip_velocity import AXES


def start_sensors(force_torque: np.ndarray, chips: np.ndarray, rng: np.random.Generator) -> None:
    """Forget all samples, and draw the keys of the noise and what each chip has not counted yet.

    Args:
        force_torque: FORCE_TORQUE, any shape.
        chips: SLIP_SENSOR, likewise.
        rng: Source of the draws.
    """
    n = chips.size
    keys = rng.bit_generator.random_raw(3 * n).reshape(3, n)
    _start(force_torque.reshape(n), chips.reshape(n), keys, rng.uniform(-1.0, 1.0, (n, AXES)))


@compiled
def _start(force_torque, chips, keys, carries):
    for i in range(chips.shape[0]):
        wrench, slip = force_torque[i], chips[i]
        for k in range(wrench.kept):
            for a in range(6):
                wrench.history[k, a] = 0.0
        wrench.read = 0
        wrench.key, wrench.drift_key, slip.key = keys[0, i], keys[1, i], keys[2, i]
        slip.counted[:] = 0.0
        slip.history[:] = 0.0
        slip.moved[:] = 0.0
        slip.travel[:] = 0.0
        slip.taken = 0
        for a in range(AXES):
            slip.carry[a] = slip.count * carries[i, a]
