"""Both sensors of both fingers, read at one slip-velocity sample."""

from __future__ import annotations

import numpy as np
from numba import njit

from slipgym.sensors.force_torque import read_force_torque, resolve_at_cop
from slipgym.sensors.slip_velocity import read_slip, sample_slip

MEASURED = np.dtype(
    [
        ("reading", "f8", 6),  # force/torque in the finger's frame [N, N m]
        ("wrench", "f8", 4),  # (f_x, f_y, f_n, tau) at the measured CoP, pad frame
        ("twist", "f8", 3),  # (v_x, v_y, omega) at the measured CoP, pad frame
        ("cop", "f8", 2),  # measured centre of pressure, pad frame [m]
    ]
)
CONTACT_THRESHOLD = 0.2  # [N]; below it the centre of pressure is not defined


@njit(cache=True)
def measure(tick, force_torque, chips, noise, measured):
    """Sample the slip sensors and read all sensors of one world.

    Args:
        tick: Time of the sample in ticks.
        force_torque: FORCE_TORQUE records (2,).
        chips: SLIP_SENSOR records (2,).
        noise: Standard normal draws for the chips' axes, shape (2, AXES).
        measured: MEASURED records (2,), output.
    """
    for f in range(2):
        out = measured[f]
        sample_slip(chips[f], noise[f])
        read_slip(chips[f], out.twist)
        read_force_torque(force_torque[f], tick, out.reading)
        resolve_at_cop(force_torque[f], out.reading, CONTACT_THRESHOLD, out.wrench, out.cop)
        omega = out.twist[2]
        out.twist[0] -= omega * out.cop[1]
        out.twist[1] += omega * out.cop[0]
        force_torque[f].drawn = 0
