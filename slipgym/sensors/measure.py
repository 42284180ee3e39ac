"""Reads both sensors of both fingers at a control step."""

from __future__ import annotations

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.sensors.force_torque import read_force_torque, resolve_at_cop
from slipgym.sensors.slip_velocity import read_slip, sample_slip

CONTACT_THRESHOLD = 0.2  # [N]; below it the centre of pressure is not defined


@compiled
def measure(
    worlds: np.ndarray,
    force_torque: np.ndarray,
    slip_sensors: np.ndarray,
    wrenches: np.ndarray,
    twists: np.ndarray,
) -> None:
    """Sample the slip sensors and read all sensors.

    Args:
        worlds: WORLD (n,), for the time.
        force_torque: FORCE_TORQUE (n, 2).
        slip_sensors: SLIP_SENSOR (n, 2).
        wrenches: Output (n, 2, 4): (f_x, f_y, f_n, tau) at the measured centre of
            pressure, pad frame [N, N, N, N m].
        twists: Output (n, 2, 3): (v_x, v_y, omega) there [m/s, m/s, rad/s].
    """
    reading, cop = np.empty(6), np.empty(2)
    for i in range(worlds.shape[0]):
        for f in range(2):
            sample_slip(slip_sensors[i, f])
            read_slip(slip_sensors[i, f], twists[i, f])
            read_force_torque(force_torque[i, f], worlds[i].tick, reading)
            resolve_at_cop(force_torque[i, f], reading, CONTACT_THRESHOLD, wrenches[i, f], cop)
            omega = twists[i, f, 2]
            twists[i, f, 0] -= omega * cop[1]
            twists[i, f, 1] += omega * cop[0]
