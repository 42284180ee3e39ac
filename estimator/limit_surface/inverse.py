"""From the friction and the twist of a slip back to mu_c and r, on the ellipsoid or on a uniform disc.

On both surfaces q = tau omega / (f_t v_t), which contains neither mu_c nor r, determines the position of the
slip. On the ellipsoid (Waltersson & Karayiannidis, arXiv 2507.06824, eqs. 1-2) the solution is

    mu_c f_n / f_t = sqrt(1 + q),    r = sqrt(q) v_t / omega.

On a disc both have additional factors that depend on s = 1 / (1 + q) alone. They are bounded and smooth, and
are tabulated here once from the exact surface (`disc_friction`). Linear interpolation is off by at most 2e-5.
"""

import math

import numpy as np

from estimator._numba.caching import njit
from estimator._numba.uncompiled import uncompiled
from estimator.limit_surface.disc import DISC_RADIUS, disc_friction

_INTERVALS = 512


def _factors() -> tuple[np.ndarray, np.ndarray]:
    """Disc over ellipsoid at knots in [0, 1].

    Returns:
        Over s: the factor of mu_c, the derivative of its logarithm, the same of r; (knots, 4).
        Over the squared fraction f_t / load: the factor of mu_c; (knots,).
    """
    ratio = np.concatenate(
        [np.geomspace(1e-4, 0.5, 400), np.linspace(0.5, 2.0, 1200), np.geomspace(2.0, 1e4, 400)]
    )
    force, torque = np.array([*map(uncompiled(disc_friction), ratio.tolist())]).T
    q = torque / (force * ratio)
    tilt = torque / (DISC_RADIUS * force)  # (tau / r) / f_t
    knots = np.linspace(0.0, 1.0, _INTERVALS + 1)

    def over(square: np.ndarray, factor: np.ndarray) -> np.ndarray:
        return np.interp(knots, 1.0 / (1.0 + square), factor)

    friction = over(q, 1.0 / (force * np.sqrt(1.0 + q)))
    radius = over(q, DISC_RADIUS / (ratio * np.sqrt(q)))
    slopes = [np.gradient(np.log(factor), knots, edge_order=2) for factor in (friction, radius)]
    table = np.column_stack([friction, slopes[0], radius, slopes[1]])
    return table, over(tilt**2, 1.0 / (force * np.sqrt(1.0 + tilt**2)))


_SLIP, _LOAD = _factors()


@njit
def _place(s):
    """Interval of the table that holds s in [0, 1], and the position in it."""
    at = min(int(s * _INTERVALS), _INTERVALS - 1)
    return at, s * _INTERVALS - at


@njit
def slip_factors(disc, s):
    """Factors of mu_c and r of a slip relative to the ellipsoid.

    Args:
        disc: Whether the surface is a uniform disc's; else the ellipsoid.
        s: 1 / (1 + q), in [0, 1].

    Returns:
        mu_c f_n / (f_t sqrt(1 + q)), the derivative of ln mu_c by ln(1 + q),
        r omega / (v_t sqrt(q)), the derivative of ln r by ln q [-].
    """
    if not disc:
        return 1.0, 0.5, 1.0, 0.5
    at, x = _place(s)
    low, high = _SLIP[at], _SLIP[at + 1]
    friction_slope = low[1] + x * (high[1] - low[1])
    radius_slope = low[3] + x * (high[3] - low[3])
    return (
        low[0] + x * (high[0] - low[0]),
        0.5 - s * friction_slope,
        low[2] + x * (high[2] - low[2]),
        0.5 - s * (1.0 - s) * radius_slope,
    )


@njit
def spin_radius(disc, arm, pivot):
    """Radius of the equivalent rim contact of a spin whose f_t is within its noise.

    Args:
        disc: As in `slip_factors`.
        arm: tau / (mu_c f_n) [m].
        pivot: v_t / omega, small against the radius for a disc [m].
    """
    if not disc:
        return math.sqrt(0.5 * arm * (arm + math.sqrt(arm * arm + 4.0 * pivot * pivot)))
    # tau / (mu_c f_n R) = 2/3 - ratio^2 / 2, the next term is ratio^4 / 16
    return 0.5 * (arm + math.sqrt(arm * arm + 4.0 / 3.0 * pivot * pivot))


@njit
def load_size(disc, f_t, rim):
    """Smallest mu f_n [N] that carries the load of f_t and rim = tau / r [N]; 0 without load."""
    size = math.sqrt(f_t * f_t + rim * rim)
    if not disc or size == 0.0:
        return size
    fraction = f_t / size
    at, x = _place(fraction * fraction)
    return size * (_LOAD[at] + x * (_LOAD[at + 1] - _LOAD[at]))
