"""The limit surfaces of the named pressures without cells, from complete elliptic integrals; needs scipy.

Each is a curve turned about the torque's axis: f_t and tau over the distance q of the centre of rotation,
in radii of the disc. The uniform disc's is `estimator.limit_surface`'s. A round pressure p that falls to
zero at the edge is made of uniform discs: those of radii a to a + da carry the load -p'(a) pi a^2 da, for
Hertz 3/2 a^3 / sqrt(1 - a^2) da, with a = sin(t) 3/2 sin(t)^3 dt, over which Gauss's rule integrates. The
rim's friction is the mean over the edge (k^2 = 4 q / (1 + q)^2):

    mean Delta = 2 (1 + q) E(k) / pi,    mean 1 / Delta = 2 K(k) / (pi (1 + q)),
    Delta = sqrt(1 + q^2 - 2 q sin), the speed of a point over R omega.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import ellipe, ellipkm1

from estimator.limit_surface import disc_friction
from slipgym._numba.compiled import compiled

GAUSS = np.polynomial.legendre.leggauss(64)
"""Nodes and weights for Hertz."""


def uniform_friction(ratio: float) -> tuple[float, float]:
    """`estimator.limit_surface.disc_friction`."""
    return disc_friction(ratio)


def hertz_friction(ratio: float) -> tuple[float, float]:
    """Steady friction of a disc with Hertzian pressure; arguments and result as `rim_friction`."""
    return _hertz(ratio, *GAUSS)


@compiled
def _hertz(ratio: float, nodes: np.ndarray, weights: np.ndarray) -> tuple[float, float]:
    # where a disc's edge passes through the centre of rotation its friction has a logarithm: towards that
    # the nodes are drawn by a square
    bend = math.asin(min(ratio, 1.0))
    force, torque = 0.0, 0.0
    for end in (0.0, 0.5 * math.pi):
        if end == bend:
            continue
        for i in range(len(nodes)):
            near = 0.5 * (nodes[i] + 1.0)
            a = math.sin(bend + (end - bend) * near * near)
            load = 1.5 * a**3 * abs(end - bend) * near * weights[i]
            f, m = disc_friction(ratio / a)
            force, torque = force + load * f, torque + load * a * m
    return force, torque


def rim_friction(ratio: float) -> tuple[float, float]:
    """Steady friction of load on the edge alone.

    Args:
        ratio: v_t / (R |omega|), distance of the centre of rotation in radii of the disc, in [0, inf].

    Returns:
        f_t / (mu_c f_n) and |tau| / (mu_c f_n R) [-].
    """
    if ratio > 1.0:  # Delta / q is that of 1 / q
        torque, force = rim_friction(1.0 / ratio)
        return force, torque
    if ratio < 1e-4:  # the closed form cancels; the next terms of the series are below 1e-13
        return 0.5 * ratio, 1.0 - 0.25 * ratio * ratio
    apart = ((1.0 - ratio) / (1.0 + ratio)) ** 2  # 1 - k^2
    if apart == 0.0:
        return 2.0 / np.pi, 2.0 / np.pi
    mean_speed = 2.0 / np.pi * (1.0 + ratio) * ellipe(1.0 - apart)
    mean_inverse = 2.0 / np.pi * ellipkm1(apart) / (1.0 + ratio)
    across = ((1.0 + ratio * ratio) * mean_inverse - mean_speed) / (2.0 * ratio)  # mean of sin / Delta
    return float(ratio * mean_inverse - across), float(mean_inverse - ratio * across)


FRICTION: dict[str, Callable[[float], tuple[float, float]]] = {
    "uniform": uniform_friction,
    "hertz": hertz_friction,
    "rim": rim_friction,
}
"""By those names of `slipgym.contact.pressure.PRESSURES` whose surface is known so."""


def exact_friction(pressure: str, twists: ArrayLike) -> np.ndarray:
    """Friction of a named pressure on a disc of radius 1.

    Args:
        pressure: A key of `FRICTION`.
        twists: Slip twists (v_x, v_y, R omega), shape (m, 3); none zero.

    Returns:
        (f_x, f_y, tau / R) on the object over mu_c f_n, shape (m, 3) [-].
    """
    v_x, v_y, spin = np.asarray(twists, dtype=float).T
    v_t = np.hypot(v_x, v_y)
    friction = FRICTION[pressure]
    with np.errstate(divide="ignore"):
        force, torque = np.array([friction(float(ratio)) for ratio in v_t / np.abs(spin)]).T
    heading = np.stack([v_x, v_y]) / np.maximum(v_t, np.finfo(float).tiny)
    return -np.column_stack((force * heading[0], force * heading[1], np.sign(spin) * torque))
