"""The exact limit surface of a uniformly loaded disc, and friction of a slip on it or on the ellipsoid.

A disc of radius R slips about a centre of rotation at the distance v_t / |omega| from its own. Friction of
each area element opposes its velocity; integrated over the disc (Farkas, Bartels, Unger & Wolf, Frictional
coupling between sliding and spinning motion, Phys. Rev. Lett. 90, 2003; Goyal, Ruina & Papadopoulos, Planar
sliding with dry friction, Wear 143, 1991) it consists of complete elliptic integrals. With

    B = integral cos^2 / Delta,    D = integral sin^2 / Delta,    C = (D - B) / k^2,
    Delta = sqrt(1 - k^2 sin^2) over a quarter turn,    k the smaller of ratio and 1 / ratio,

every term is positive and nothing cancels, even close to pure translation or pure spin.
"""

import math

from estimator._numba.caching import njit

DISC_RADIUS = 2.0 / 3.0
"""Radius of the equivalent rim contact of a uniform disc, in radii of the disc."""

_COMPLEMENT_MIN = 1e-17  # below it B is 1 to rounding, and the rest is multiplied by it


@njit
def _elliptic(k_squared):
    """B, D and C of the modulus k, by the arithmetic-geometric mean (DLMF 19.8)."""
    complement = max(math.sqrt(max(1.0 - k_squared, 0.0)), _COMPLEMENT_MIN)
    a, b = 1.0, complement
    gap, weight = 0.5 / (1.0 + complement), 1.0  # half the difference of a and b over k^2, 2^(n - 1)
    a, b = 0.5 * (a + b), math.sqrt(a * b)
    total = gap * gap
    while k_squared * gap > 1e-17 * a:
        a, b = 0.5 * (a + b), math.sqrt(a * b)
        gap = 0.25 * k_squared * gap * gap / a
        weight *= 2.0
        total += weight * gap * gap
    k_integral = 0.5 * math.pi / a
    part = k_squared * total
    return k_integral * (0.5 - part), k_integral * (0.5 + part), 2.0 * k_integral * total


@njit
def disc_friction(ratio):
    """Steady friction of a uniform disc.

    Args:
        ratio: v_t / (R |omega|), distance of the centre of rotation in radii of the disc, in [0, inf].

    Returns:
        f_t / (mu_c f_n), from 0 (spin) to 1 (translation), and |tau| / (mu_c f_n R), from 2/3 to 0 [-].
    """
    if ratio <= 1.0:
        k_squared = ratio * ratio
        rest = 1.0 - k_squared
        b, d, _ = _elliptic(k_squared)
        force = ratio * (2.0 * b + rest * d)
        torque = (2.0 + rest) * b + rest * (1.0 + 2.0 * rest) * d
    else:
        k = 1.0 / ratio
        k_squared = k * k
        b, d, c = _elliptic(k_squared)
        force = 2.0 * b + (1.0 - k_squared) * d
        torque = k * (3.0 * b - d + c)
    return 4.0 / (3.0 * math.pi) * force, 4.0 / (9.0 * math.pi) * torque


@njit
def slip_friction(disc, v_t, rim_speed):
    """Steady friction of a slip as fractions of mu_c f_n and of mu_c f_n r.

    Args:
        disc: Whether the surface is a uniform disc's; else the ellipsoid.
        v_t: Speed of translation [m/s], >= 0.
        rim_speed: r |omega| [m/s], >= 0; not both speeds are zero.

    Returns:
        f_t / (mu_c f_n) and |tau| / (mu_c f_n r) [-].
    """
    if not disc:
        speed = math.sqrt(v_t * v_t + rim_speed * rim_speed)
        return v_t / speed, rim_speed / speed
    ratio = DISC_RADIUS * v_t / rim_speed if rim_speed > 0.0 else math.inf
    force, torque = disc_friction(ratio)
    return force, torque / DISC_RADIUS
