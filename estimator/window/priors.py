"""Adds what is known of the states without any slip: normal distributions, and heavier tails for the pad."""

import math

from estimator._numba.caching import njit
from estimator.window.layout import FALLS, GROWS, OLD, STATES

HARD, RUBBER = 0.045, 0.12
"""Half width of the exponents' Cauchy distribution for a hard pad, and for one that may be rubber: silicones
have exponents of -0.1 to 0.4."""
DRIFT, CHANGE = 0.03**2, 0.5**2
"""Variance of the difference of the newest slips from the older ones: without a change, and with one."""


@njit(error_model="numpy")
def add_priors(state, p, x, changed, a, g):
    """Adds the information of the priors to the normal equations, and returns their cost.

    A Cauchy distribution of half width s has the cost 2 ln(1 + (x / s)^2), whose gradient is that of a normal
    distribution with the variance (s^2 + x^2) / 2. `changed`: whether friction has changed since the older
    slips.
    """
    cost, width = 0.0, HARD if state.spring <= p.compliance else RUBBER
    for j in range(STATES):
        off, variance = x[j] - state.mean[j], state.variance[j]
        if j == OLD:
            variance = CHANGE if changed else DRIFT
        if j in (FALLS, GROWS):
            variance = 0.5 * (width * width + off * off)
            cost += 2.0 * math.log1p((off / width) ** 2)
        else:
            cost += off * off / variance
        a[j, j] += 1.0 / variance
        g[j] -= off / variance
    return cost
