"""From the friction and the twist of a slip back to mu_c and r, on the ellipsoid or on a uniform disc.

Both surfaces are told by q = tau omega / (f_t v_t), which holds neither mu_c nor r. On the ellipsoid
(Waltersson & Karayiannidis, arXiv 2507.06824, eqs. 1-2) in closed form:

    f_t / (mu_c f_n) = 1 / sqrt(1 + q),    r = sqrt(q) v_t / omega.

A disc's differ by factors that depend on s = 1 / (1 + q) alone, are bounded and smooth, and are tabulated
here from its exact surface (`disc_friction`), once. Between knots they are linear: off by at most 2e-5.
"""

import math

import numpy as np
from numba import njit

from estimator.limit_surface.disc import DISC_RADIUS, disc_friction

_INTERVALS = 512


def _factors() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Disc over ellipsoid at knots of s: f_t, v_t / (r omega), and f_t again where s is that of the force."""
    ratio = np.concatenate(
        [np.geomspace(1e-4, 0.5, 400), np.linspace(0.5, 2.0, 1200), np.geomspace(2.0, 1e4, 400)]
    )
    force, torque = np.array([disc_friction.py_func(x) for x in ratio]).T
    q = torque / (force * ratio)
    pivot = ratio / DISC_RADIUS
    tilt = torque / (DISC_RADIUS * force)  # (tau / r) / f_t
    knots = np.linspace(0.0, 1.0, _INTERVALS + 1)

    def over(square: np.ndarray, factor: np.ndarray) -> np.ndarray:
        return np.interp(knots, 1.0 / (1.0 + square), factor)

    return (
        over(q, force * np.sqrt(1.0 + q)),
        over(q, pivot * np.sqrt(q)),
        over(tilt**2, force * np.sqrt(1.0 + tilt**2)),
    )


_FORCE, _PIVOT, _SIZE = _factors()


@njit
def _interpolated(table, s):
    """Value and slope of a factor at s in [0, 1]."""
    at = min(int(s * _INTERVALS), _INTERVALS - 1)
    step = table[at + 1] - table[at]
    return table[at] + (s * _INTERVALS - at) * step, step * _INTERVALS


@njit
def slip_share(disc, q):
    """Tangential friction of a slip as a share of mu_c f_n.

    Args:
        disc: Whether the surface is a uniform disc's; else the ellipsoid.
        q: tau omega / (f_t v_t), >= 0, finite.

    Returns:
        f_t / (mu_c f_n), and minus its logarithm's derivative by q [-].
    """
    s = 1.0 / (1.0 + q)
    if not disc:
        return math.sqrt(s), 0.5 * s
    factor, slope = _interpolated(_FORCE, s)
    return factor * math.sqrt(s), 0.5 * s + slope / factor * s * s


@njit
def slip_radius(disc, q, pivot):
    """Radius of the equivalent rim contact.

    Args:
        disc: As in `slip_share`.
        q: tau omega / (f_t v_t), >= 0, finite.
        pivot: v_t / omega [m].

    Returns:
        r [m], and the derivative of its logarithm by that of q [-].
    """
    if not disc:
        return math.sqrt(q) * pivot, 0.5
    s = 1.0 / (1.0 + q)
    factor, slope = _interpolated(_PIVOT, s)
    return math.sqrt(q) * pivot / factor, 0.5 + slope / factor * s * (1.0 - s)


@njit
def spin_radius(disc, arm, pivot):
    """Radius of the equivalent rim contact of a spin whose f_t is too small to be seen.

    Args:
        disc: As in `slip_share`.
        arm: tau / (mu_c f_n) [m].
        pivot: v_t / omega, small against the radius for a disc [m].
    """
    if not disc:
        return math.sqrt(0.5 * arm * (arm + math.sqrt(arm * arm + 4.0 * pivot * pivot)))
    # tau / (mu_c f_n R) = 2/3 - ratio^2 / 2, of which the first term left out is ratio^4 / 16
    return 0.5 * (arm + math.sqrt(arm * arm + 4.0 / 3.0 * pivot * pivot))


@njit
def load_size(disc, f_t, rim):
    """Least mu f_n that carries a load.

    Args:
        disc: As in `slip_share`.
        f_t: Tangential force [N].
        rim: tau / r [N].

    Returns:
        [N]; 0 without load.
    """
    size = math.sqrt(f_t * f_t + rim * rim)
    if not disc or size == 0.0:
        return size
    share = f_t / size
    return size / _interpolated(_SIZE, share * share)[0]
