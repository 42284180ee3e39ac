"""Limit surfaces in the form that the estimators solve: by the share that translation has in the power.

A pad in steady slip, of the equivalent rim radius r, has f_t = mu_c f_n F and tau = mu_c f_n r T. Both can be
written with the share s = f_t v_t / (f_t v_t + tau omega), which only holds what a sensor measures:

    F = u(s) sqrt(s),    T = w(s) sqrt(1 - s),    v_t / (r omega) = w / u sqrt(s / (1 - s)).

On the ellipsoid (Waltersson & Karayiannidis, ISER 2025, eqs. 1 and 2) u = w = 1, and sqrt(s) is its gamma_t.
So any other surface corrects the ellipsoid's closed solution by two smooth factors,

    mu_c = mu_c(ellipsoid) / u,    r = r(ellipsoid) u / w,

and its errors by one slope: friction is normal to the surface, hence s dln u + (1 - s) dln w = 0.
The factors of the disc are interpolated linearly between exact nodes.
"""

import math
from pathlib import Path

import numpy as np
from numba import njit

from estimator.caching import compiler
from estimator.limit_surface.disc import DISC_RADIUS, disc_friction

ELLIPSOID, DISC = 0, 1

NODES = 256
"""Intervals of the tables, equal in the share."""

DISC_PIVOT = math.sqrt(2.0 / 3.0)
"""u(0) of the disc: close to spin T = 1 - (u(0) v_t / (r omega))^2 / 2 on any surface."""
DISC_VISCOSITY = 0.5 / DISC_RADIUS**2
"""Mean of the squared lever arm of a uniform disc, R^2 / 2, in r^2."""


@njit
def _shares(ratio):
    """Share of translation in the power, share in the squared wrench (f_t, tau / r), and F, T, of the disc."""
    force, torque = disc_friction(ratio)
    torque /= DISC_RADIUS
    slide, spin = ratio * force / DISC_RADIUS, torque
    return slide / (slide + spin), force * force / (force * force + torque * torque), force, torque


@compiler(Path(__file__).parents[1])
def _disc_tables():
    """Columns 1 / u and u / w by the share of the power; sqrt(F^2 + T^2) by the share of the wrench."""
    table = np.empty((NODES + 1, 3))
    table[0] = 1.0 / DISC_PIVOT, DISC_PIVOT, 1.0
    table[NODES] = 1.0, 4.0 / 3.0, 1.0
    for i in range(1, NODES):
        share = i / NODES
        for kind in range(2):
            low, high = 0.0, 0.5 * math.pi  # both shares grow with the distance of the centre of rotation
            for _ in range(52):
                middle = 0.5 * (low + high)
                if _shares(math.tan(middle))[kind] < share:
                    low = middle
                else:
                    high = middle
            _, _, force, torque = _shares(math.tan(low))
            if kind == 0:
                u, w = force / math.sqrt(share), torque / math.sqrt(1.0 - share)
                table[i, 0], table[i, 1] = 1.0 / u, u / w
            else:
                table[i, 2] = math.sqrt(force * force + torque * torque)
    return table


_DISC = _disc_tables()


@njit
def power_shape(surface, share):
    """Factors at a share s of translation in the power, in [0, 1].

    Returns:
        1 / u, u / w, and the slope dln u / dln s.
    """
    if surface == ELLIPSOID:
        return 1.0, 1.0, 0.0
    i = min(int(share * NODES), NODES - 1)
    part = share * NODES - i
    step = _DISC[i + 1, 0] - _DISC[i, 0]
    inverse_u = _DISC[i, 0] + part * step
    u_by_w = _DISC[i, 1] + part * (_DISC[i + 1, 1] - _DISC[i, 1])
    return inverse_u, u_by_w, -share * NODES * step / inverse_u


@njit
def wrench_shape(surface, share):
    """sqrt(F^2 + T^2) where F^2 has the given share in it, in [0, 1]."""
    if surface == ELLIPSOID:
        return 1.0
    i = min(int(share * NODES), NODES - 1)
    return _DISC[i, 2] + (share * NODES - i) * (_DISC[i + 1, 2] - _DISC[i, 2])


@njit
def pivot_factor(surface):
    """u(0): how much of v_t / (r omega) counts against the torque of a spin."""
    return 1.0 if surface == ELLIPSOID else DISC_PIVOT


@njit
def viscous_arm(surface):
    """Mean square of the lever arm in r^2: the torque of a viscosity sigma in a spin is sigma omega f_n r^2 x this."""
    return 1.0 if surface == ELLIPSOID else DISC_VISCOSITY
