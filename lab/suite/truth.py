"""Friction and motion of a grasp whose pads are uniformly loaded discs, without bristles."""

from __future__ import annotations

import numpy as np

from lab.limit_surface_exact import exact_friction
from lab.suite.rig import PATCH_RADIUS, Grasp, R

_SCALE = np.array([1.0, 1.0, PATCH_RADIUS / R])


def friction(twist: np.ndarray) -> np.ndarray:
    """Friction in steady slip over the limit mu sum f_n.

    Args:
        twist: Scaled slip twist (v_x, v_z, r omega) at the pad centre, (3,); not zero.

    Returns:
        (f_x, f_z, tau / r) on the object over the limit, (3,) [-].
    """
    return exact_friction("uniform", (twist * _SCALE)[None])[0] * _SCALE


def slide(grasp: Grasp, velocity: np.ndarray, step: float = 5e-4) -> np.ndarray:
    """Where a thrown object comes to rest, by the midpoint rule.

    Args:
        grasp: Object and grip.
        velocity: Of the centre of mass, which is at the pad centre, (3,) [m/s, m/s, rad/s].
        step: Length of a step [s].

    Returns:
        Displacement of the centre of mass, and angle, (3,) [m, m, rad].
    """
    position, velocity = np.zeros(3), np.array(velocity, dtype=float)
    while True:
        middle = velocity + 0.5 * step * acceleration(grasp, position, velocity)
        if middle @ (velocity * (1.0, 1.0, R * R)) <= 0.0:  # it comes to rest within the step
            return position
        after = velocity + step * acceleration(grasp, position + 0.5 * step * velocity, middle)
        position, velocity = position + 0.5 * step * (velocity + after), after


def acceleration(grasp: Grasp, position: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """Acceleration of the centre of mass by friction at the origin, (3,) [m/s^2, m/s^2, rad/s^2]."""
    x, z, _ = position
    omega = velocity[2]
    twist = np.array([velocity[0] + omega * z, velocity[1] - omega * x, R * omega])
    f_x, f_z, scaled = grasp.limit * friction(twist)
    torque = R * scaled + z * f_x - x * f_z
    return np.array([f_x / grasp.mass, f_z / grasp.mass, torque / grasp.inertia])
