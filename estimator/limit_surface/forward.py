"""Friction of a slip on the ellipsoid or on a uniform disc."""

import math

from numba import njit

from estimator.limit_surface.disc import DISC_RADIUS, disc_friction


@njit
def slip_friction(disc, v_t, rim_speed):
    """Steady friction of a slip as shares of mu_c f_n and of mu_c f_n r.

    Args:
        disc: Whether the surface is a uniform disc's; else the ellipsoid.
        v_t: Speed of translation [m/s], >= 0.
        rim_speed: r |omega| [m/s], >= 0, not zero with v_t.

    Returns:
        f_t / (mu_c f_n) and |tau| / (mu_c f_n r) [-].
    """
    if not disc:
        speed = math.sqrt(v_t * v_t + rim_speed * rim_speed)
        return v_t / speed, rim_speed / speed
    ratio = DISC_RADIUS * v_t / rim_speed if rim_speed > 0.0 else math.inf
    force, torque = disc_friction(ratio)
    return force, torque / DISC_RADIUS
