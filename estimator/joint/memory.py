"""Fading-memory weighted least squares, with the standard deviation of its result.

A sample enters with weight w = 1 / (s^2 + l^2), s the deviation of its noise and l what the friction law
itself may be off by; every update multiplies the older weights by lambda. The noise's part of the result's
covariance is A^-1 B A^-1, where A sums the weights and B their squares times s^2, all with their fading.
"""

import math

from numba import njit

from estimator.stick_slip.kernel import clamped, count_mu_c, count_r


@njit(error_model="numpy")
def learn_mu_c(state, p, y, noise, v):
    """One measured friction y = mu_c + viscosity v of a relative noise variance; both parameters follow.

    The viscosity keeps a prior of zero mean that does not fade. What fades is replaced, up to the start's
    information, by the present mu_c, so that poor samples cannot wind the memory down to nothing.
    """
    a, b, keep = state.information, state.noise, p.forgetting
    w = 1.0 / (y * y * (noise + p.law_error * p.law_error))
    spread = w * w * y * y * noise
    refill = (1.0 - keep) / p.sd_mu_c0**2
    a_11, a_12, a_22 = keep * a[0] + w + refill, keep * a[1] + w * v, keep * a[2] + w * v * v
    y_1, y_2 = keep * state.vector[0] + w * y + refill * state.mu_c, keep * state.vector[1] + w * v * y
    prior = 1.0 / p.sd_viscosity**2
    determinant = a_11 * (a_22 + prior) - a_12 * a_12
    mu_c = ((a_22 + prior) * y_1 - a_12 * y_2) / determinant
    if not (math.isfinite(mu_c) and math.isfinite(determinant) and determinant > 0.0 and w > 0.0):
        return False
    state.viscosity = (a_11 * y_2 - a_12 * y_1) / determinant
    state.mu_c = clamped(mu_c, p.mu_min, p.mu_max)
    fade = keep * keep
    b[0] = fade * b[0] + spread + refill
    b[1], b[2] = fade * b[1] + spread * v, fade * b[2] + spread * v * v
    a[0], a[1], a[2] = a_11, a_12, a_22
    state.vector[0], state.vector[1] = y_1, y_2
    count_mu_c(state, p)
    return True


@njit(error_model="numpy")
def sd_mu_c(state, p):
    """Standard deviation of mu_c, of noise alone [-]."""
    a, b = state.information, state.noise
    prior = 1.0 / p.sd_viscosity**2
    determinant = a[0] * (a[2] + prior) - a[1] * a[1]
    g, h = (a[2] + prior) / determinant, -a[1] / determinant
    return math.sqrt(max(g * g * b[0] + 2.0 * g * h * b[1] + h * h * b[2], 0.0))


@njit(error_model="numpy")
def learn_r(state, p, y, noise):
    """One measured radius y [m] of a relative noise variance."""
    w = 1.0 / (y * y * (noise + p.law_error * p.law_error))
    refill = (1.0 - p.forgetting) / p.sd_r0**2
    information = p.forgetting * state.information_r + w + refill
    if not (math.isfinite(information) and w > 0.0 and math.isfinite(y)):
        return False
    state.r = clamped(state.r + w / information * (y - state.r), p.r_min, p.r_max)
    state.information_r = information
    state.noise_r = p.forgetting**2 * state.noise_r + w * w * y * y * noise + refill
    count_r(state, p)
    return True
