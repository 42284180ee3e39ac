"""Computes the part of static friction in slow slips: the Stribeck effect.

Friction of a slip at the scaled speed w is mu_c + (mu_s - mu_c) exp(-(w / v_s)^2) (Waltersson &
Karayiannidis, Planar friction modelling with LuGre dynamics and limit surfaces, arXiv 2308.01123, whose v_s
is 1 mm/s). An object that pivots between small pads slips more slowly than that. mu_s is that of the
break-aways, as far as it is known, and else in proportion to mu_c. What is left unknown of mu_s and v_s is
noise of the law.
"""

import math

from estimator._numba.caching import njit

ALIKE = 10.0
"""Samples of a slip that share an error which the filter takes for noise."""
SLOWEST = 16.0
"""(w / v_s)^2 from which static friction is forgotten: exp(-16) is 1e-7."""


@njit(error_model="numpy")
def static_friction(state, p):
    """mu_s that slow slips are expected to have, for a mu_c that is not known yet.

    Args:
        state: Record with `events_mu_s`, `mu_s` and `sd_mu_s`.
        p: Parameters.

    Returns:
        a and b of ln mu_s = a + (1 - b) ln mu_c, and the variance of ln mu_s that is left.
    """
    ratio, of_ratio = max(math.log(p.mu_s0 / p.mu_c0), 0.0), p.sd_log_ratio * p.sd_log_ratio
    if state.events_mu_s == 0:
        return ratio, 0.0, of_ratio
    relative = state.sd_mu_s / state.mu_s
    seen = of_ratio / (of_ratio + relative * relative)
    return seen * math.log(state.mu_s) + (1.0 - seen) * ratio, seen, (1.0 - seen) * of_ratio


@njit(error_model="numpy")
def level(p, static, seen, mu, square):
    """Friction at a speed, over mu_c, with its derivatives.

    Args:
        p: Parameters.
        static: First of `static_friction`.
        seen: Second of `static_friction`.
        mu: ln mu_c.
        square: Squared scaled speed of the slip [m^2/s^2].

    Returns:
        Friction over mu_c; the derivatives of the logarithm of friction by ln mu_c, by ln mu_s and by ln v_s.
    """
    slow = square / (p.stribeck_velocity * p.stribeck_velocity)
    if not slow < SLOWEST:
        return 1.0, 1.0, 0.0, 0.0
    ratio, part = math.exp(static - seen * mu), math.exp(-slow)
    ratio = max(ratio, 1.0)
    total = 1.0 + (ratio - 1.0) * part
    of_static = ratio * part / total
    return total, 1.0 - seen * of_static, of_static, 2.0 * slow * (ratio - 1.0) * part / total


@njit(error_model="numpy")
def law_variance(p, variance, of_static, of_v_s):
    """Variance of the logarithm of friction by what is not known of mu_s and of v_s.

    Args:
        p: Parameters.
        variance: Of ln mu_s.
        of_static: Derivative of the logarithm of friction by ln mu_s.
        of_v_s: By ln v_s.
    """
    by_v_s = of_v_s * p.sd_log_stribeck
    return ALIKE * (of_static * of_static * variance + by_v_s * by_v_s)
