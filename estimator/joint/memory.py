"""Fading-memory weighted least squares, with the standard deviation of its result.

A sample enters with weight w = 1 / (s^2 + l^2), s the deviation of its noise and l what the friction law
itself may be off by; every update multiplies the older weights by lambda. The noise's part of the result's
covariance is A^-1 B A^-1, where A sums the weights and B their squares times s^2, all with their fading.
"""

import math

from numba import njit

from estimator.stick_slip.kernel import clamped, count_mu_c, count_r


@njit
def priors(p):
    """Information of the start values.

    Returns:
        Of mu_c and of r, as much as refills a memory in one update, and of the viscosity, all of it.
    """
    fading = 1.0 - p.forgetting
    return fading / p.sd_mu_c0**2, fading / p.sd_r0**2, 1.0 / p.sd_viscosity**2


@njit
def learn_mu_c(state, p, prior, y, noise, v):
    """One measured friction y = mu_c + viscosity v of a relative noise variance; both parameters follow.

    The viscosity keeps a prior of zero mean that does not fade. What fades is replaced, up to the start's
    information, by the present mu_c, so that poor samples cannot wind the memory down to nothing.
    """
    a, b, keep = state.information, state.noise, p.forgetting
    refill, _, of_viscosity = prior
    y_squared = y * y
    w = 1.0 / (y_squared * (noise + p.law_error * p.law_error))
    wv = w * v
    a_11, a_12, a_22 = keep * a[0] + w + refill, keep * a[1] + wv, keep * a[2] + wv * v
    y_1, y_2 = keep * state.vector[0] + w * y + refill * state.mu_c, keep * state.vector[1] + wv * y
    whole = a_22 + of_viscosity
    determinant = a_11 * whole - a_12 * a_12
    inverse = 1.0 / determinant
    mu_c = (whole * y_1 - a_12 * y_2) * inverse
    fade, spread = keep * keep, w * w * y_squared * noise
    b_11, b_12 = fade * b[0] + spread + refill, fade * b[1] + spread * v
    b_22 = fade * b[2] + spread * v * v
    g, h = whole * inverse, a_12 * inverse
    variance = max(g * g * b_11 - 2.0 * g * h * b_12 + h * h * b_22, 0.0)
    if not (math.isfinite(mu_c + variance + b_22) and 0.0 < determinant < math.inf and w > 0.0):
        return False
    state.viscosity = (a_11 * y_2 - a_12 * y_1) * inverse
    state.mu_c = clamped(mu_c, p.mu_min, p.mu_max)
    b[0], b[1], b[2] = b_11, b_12, b_22
    a[0], a[1], a[2] = a_11, a_12, a_22
    state.vector[0], state.vector[1] = y_1, y_2
    state.sd_mu_c = math.sqrt(variance)
    count_mu_c(state, p)
    return True


@njit
def learn_r(state, p, prior, y, noise):
    """One measured radius y [m] of a relative noise variance."""
    _, refill, _ = prior
    y_squared = y * y
    w = 1.0 / (y_squared * (noise + p.law_error * p.law_error))
    information = p.forgetting * state.information_r + w + refill
    spread = p.forgetting * p.forgetting * state.noise_r + w * w * y_squared * noise + refill
    if not (math.isfinite(information) and math.isfinite(spread) and w > 0.0 and math.isfinite(y)):
        return False
    inverse = 1.0 / information
    state.r = clamped(state.r + w * inverse * (y - state.r), p.r_min, p.r_max)
    state.information_r = information
    state.noise_r = spread
    state.sd_r = math.sqrt(state.noise_r) * inverse
    count_r(state, p)
    return True
