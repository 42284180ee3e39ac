"""Independent formulations of tilt: pads by quadrature, a balance by root finding, Euler's equations."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.integrate import dblquad, solve_ivp
from scipy.optimize import brentq, root
from scipy.spatial.transform import Rotation


def pressed(depth: float, slope: float, stiffness: float, radius: float) -> tuple[float, float]:
    """Normal force and moment of a disc of springs, by quadrature over its compressed part [N, N m].

    Args:
        depth: At the centre [m].
        slope: Of the face [-].
        stiffness: [N/m].
        radius: [m].
    """

    def integral(weight: Callable[[float], float]) -> float:
        if slope == 0.0:
            start = -radius if depth > 0.0 else radius
        else:
            start = min(max(-depth / slope, -radius), radius)
        value = dblquad(
            lambda _, x: weight(x) * (depth + slope * x),
            start,
            radius,
            lambda x: -math.sqrt(max(0.0, radius**2 - x**2)),
            lambda x: math.sqrt(max(0.0, radius**2 - x**2)),
            epsabs=1e-16,
            epsrel=1e-8,
        )[0]
        return stiffness / (math.pi * radius**2) * value

    return integral(lambda _: 1.0), integral(lambda x: x)


def depth_at(force: float, slope: float, stiffness: float, radius: float) -> float:
    """Depth at a pad's centre under a force on a sloping face, by bisection [m]."""
    reach = slope * radius + force / stiffness
    found: Any = brentq(lambda d: pressed(d, slope, stiffness, radius)[0] - force, -reach, reach, xtol=1e-15)
    return found


def slope_of_balance(forces: tuple[float, float], moment: float, stiffness: float, radius: float) -> float:
    """Slope at which two pads with these normal forces [N] carry a tilting moment [N m]."""

    def missing(slope: np.ndarray) -> float:
        value = float(np.ravel(slope)[0])
        depths = [depth_at(force, value, stiffness, radius) for force in forces]
        return sum(pressed(d, value, stiffness, radius)[1] for d in depths) - moment

    return float(root(missing, 2.0 * moment / (stiffness * radius**2), tol=1e-9).x[0])


def free_attitude(principal: np.ndarray, spin: np.ndarray, times: np.ndarray) -> Rotation:
    """Attitude of a free rigid body that starts upright, by Euler's equations on its own axes.

    Args:
        principal: Moments of inertia (3,) [kg m^2].
        spin: Angular velocity at the start (3,) [rad/s].
        times: (n,) [s].
    """

    def rate(_: float, state: np.ndarray) -> np.ndarray:
        omega, (x, y, z, w) = state[:3], state[3:]
        faster = np.cross(principal * omega, omega) / principal
        a, b, c = omega
        turning = (
            w * a + y * c - z * b,
            w * b + z * a - x * c,
            w * c + x * b - y * a,
            -x * a - y * b - z * c,
        )
        return np.concatenate([faster, 0.5 * np.array(turning)])

    start = np.concatenate([spin, [0.0, 0.0, 0.0, 1.0]])
    found = solve_ivp(rate, (0.0, times[-1]), start, t_eval=times, rtol=1e-11, atol=1e-12, method="DOP853")
    return Rotation.from_quat(found.y[3:].T)
