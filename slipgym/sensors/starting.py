"""Samples and resets the sensors' state at the start of an episode."""

from __future__ import annotations

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.sensors.slip_velocity import AXES

KEYS = 3
"""Keys that the noise of a finger's sensors needs."""


def draw_sensors(n: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Keys of the noise (KEYS, n), and uniform numbers in [0, 1) for the chips' uncounted rests (n, AXES)."""
    return rng.bit_generator.random_raw(KEYS * n).reshape(KEYS, n), rng.random((n, AXES))


@compiled
def start_sensors(
    force_torque: np.ndarray, slip_sensors: np.ndarray, keys: np.ndarray, shares: np.ndarray
) -> None:
    """Reset the sensors; their histories are empty.

    Args:
        force_torque: FORCE_TORQUE (n,).
        slip_sensors: SLIP_SENSOR (n,).
        keys: Keys of the noise, from `draw_sensors`.
        shares: Uniform numbers in [0, 1), from `draw_sensors`.
    """
    for i in range(slip_sensors.shape[0]):
        wrench, slip = force_torque[i], slip_sensors[i]
        for k in range(wrench.kept):
            for a in range(6):
                wrench.history[k, a] = 0.0
        wrench.read = 0
        wrench.key, wrench.drift_key, slip.key = keys[0, i], keys[1, i], keys[2, i]
        slip.counted[:] = 0.0
        slip.history[:] = 0.0
        slip.moved[:] = 0.0
        slip.measured_slip[:] = 0.0
        slip.taken = 0
        for a in range(AXES):
            slip.carry[a] = slip.count * (2.0 * shares[i, a] - 1.0)
