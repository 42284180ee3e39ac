"""Tabulates the limit surfaces of three pressures, and interpolates between them by one number, the shape.

Friction of a slip over mu_c f_n and its torque over mu_c f_n r depend on theta = atan2(r |omega|, v_t) alone.
Shape 0 is the ellipsoid, 1 a uniform disc, 1.5 a ring; a Hertzian pressure is 0.91, 0.4 % rms. So one
state stands for the hypotheses, and its deviation says how far the motion separates them.
"""

import math

import numpy as np
from numpy.typing import NDArray

from estimator._numba.caching import njit

RING = 1.5  # Shape of a ring: where the straight line through ellipsoid and disc comes closest to it
ANGLES = 64  # Intervals of the table; with 60 rings the disc is 0.2 % off


def _pressure(radii: NDArray[np.float64]) -> NDArray[np.float64]:
    """Fractions of friction and torque (ANGLES + 1, 2) of rings that carry the same load each."""
    around = 2.0 * np.pi * (np.arange(720) + 0.5) / 720
    x, y = (radii[:, None] * np.cos(around)).ravel(), (radii[:, None] * np.sin(around)).ravel()
    r, rows = radii.mean(), []
    for theta in np.linspace(0.0, 0.5 * np.pi, ANGLES + 1):
        v_x, v_y = np.cos(theta) - np.sin(theta) / r * y, np.sin(theta) / r * x
        speed = np.maximum(np.hypot(v_x, v_y), 1e-12)
        rows.append(((v_x / speed).mean(), ((x * v_y - y * v_x) / speed).mean() / r))
    return np.array(rows)


def _table() -> NDArray[np.float64]:
    """Fractions on the ellipsoid, and their slopes by the shape up to the disc and from there to the ring."""
    theta = np.linspace(0.0, 0.5 * np.pi, ANGLES + 1)
    ellipsoid = np.column_stack([np.cos(theta), np.sin(theta)])
    disc, ring = _pressure(np.sqrt((np.arange(60) + 0.5) / 60)), _pressure(np.ones(1))
    return np.column_stack([ellipsoid, disc - ellipsoid, (ring - disc) / (RING - 1.0)])


_TABLE = _table()
_PER_RADIAN = ANGLES / (0.5 * math.pi)


@njit(error_model="numpy")
def surface(shape, theta):
    """Fractions of friction and of torque, both derivatives by theta, and both by the shape [-].

    Args:
        shape: Of the limit surface; linear beyond 0 and 1.5, too.
        theta: Angle in [0, pi / 2] [rad].
    """
    place = theta * _PER_RADIAN
    i = min(int(place), ANGLES - 1)
    u, a, b, k = place - i, _TABLE[i], _TABLE[i + 1], 4 if shape > 1.0 else 2
    up_to, beyond = min(shape, 1.0), max(shape - 1.0, 0.0)
    force, force_after = a[0] + up_to * a[2] + beyond * a[4], b[0] + up_to * b[2] + beyond * b[4]
    torque, torque_after = a[1] + up_to * a[3] + beyond * a[5], b[1] + up_to * b[3] + beyond * b[5]
    by_force, by_torque = force_after - force, torque_after - torque
    return (
        force + u * by_force,
        torque + u * by_torque,
        by_force * _PER_RADIAN,
        by_torque * _PER_RADIAN,
        a[k] + u * (b[k] - a[k]),
        a[k + 1] + u * (b[k + 1] - a[k + 1]),
    )
