"""Samples and resets the sensors' state at the start of an episode."""

from __future__ import annotations

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.sensors.misalignment import LATENCY, TIP, about, mount, share
from slipgym.sensors.slip_velocity import AXES
from slipgym.sensors.structure import forget

KEYS = 3
"""Keys that the noise of a finger's sensors needs."""
SCALE, FAILS, WHICH, SLIP_LATENCY, REST, PHASE = range(1 << 20, (1 << 20) + 6)
"""Numbers of `share` beyond those of the readings: scale, whether a chip fails, which one, latency, rest."""


def draw_sensors(n: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Keys of the noise (KEYS, n), and uniform numbers in [0, 1) for the chips' uncounted rests (n, AXES)."""
    return rng.bit_generator.random_raw(KEYS * n).reshape(KEYS, n), rng.random((n, AXES))


@compiled
def among(key: int, number: int, most: int) -> int:
    """A whole number from 0 to `most`, each equally likely; see `share`."""
    return min(int(share(key, number) * (most + 1)), most)


@compiled
def start_sensors(
    force_torque: np.ndarray, slip_sensors: np.ndarray, keys: np.ndarray, shares: np.ndarray
) -> None:
    """Reset FORCE_TORQUE (n,) and SLIP_SENSOR (n,), with keys and shares from `draw_sensors`."""
    for i in range(slip_sensors.shape[0]):
        wrench, slip = force_torque[i], slip_sensors[i]
        for k in range(wrench.kept):
            for a in range(6):
                wrench.history[k, a] = 0.0
        wrench.read = 0
        wrench.key, wrench.drift_key, slip.key = keys[0, i], keys[1, i], keys[2, i]
        # the fingers' sensors share a bus, and with it the latency, unless each has a port of its own
        late = keys[1, i if wrench.own_delay else 0]
        wrench.delay = wrench.least_delay + among(late, LATENCY, wrench.delay_spread)
        forget(wrench)
        wrench.tip_mass = wrench.least_tip + wrench.tip_spread * share(wrench.drift_key, TIP)
        if wrench.misaligned:
            mount(wrench)
        late = keys[2, i if slip.own_delay else 0]
        slip.delay = slip.least_delay + among(late, SLIP_LATENCY, slip.delay_spread)
        slip.scale = 1.0 + about(slip.key, SCALE, slip.scale_spread)
        slip.rest_samples, slip.still = among(slip.key, REST, slip.rest_most), 0
        slip.rest_phase = among(slip.key, PHASE, max(slip.rest_samples - 1, 0))
        slip.failed, slip.delivered = -1, -1
        if share(slip.key, FAILS) < slip.chip_failure:
            slip.failed = among(slip.key, WHICH, slip.chips - 1)
        slip.last[:] = 0.0
        slip.counted[:] = 0.0
        slip.travel[:] = 0.0
        slip.history[:] = 0.0
        slip.moved[:] = 0.0
        slip.measured_slip[:] = 0.0
        slip.taken = 0
        for a in range(AXES):
            slip.carry[a] = slip.count * (2.0 * shares[i, a] - 1.0)
