"""Fading-memory weighted least squares, with the standard deviation of its result.

A sample of variance s^2 enters with weight 1 / s^2, and every update multiplies the older weights by
lambda. Under white noise the result's covariance is A^-1 B A^-1, where A sums the weights and B the weights
times their fading once more. What fades is replaced, up to the start's information, by the present value, so
that poor samples cannot wind a memory down to nothing.
"""

import math

from numba import njit

from estimator.stick_slip.kernel import clamped, count_mu_c, count_r


@njit(error_model="numpy")
def learn_mu_c(state, p, y, variance, v):
    """One measured friction y = mu_c + viscosity v; both parameters follow.

    The viscosity keeps a prior of zero mean that does not fade.
    """
    a, b, keep = state.information, state.noise, p.forgetting
    w = 1.0 / variance
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
    b[0], b[1], b[2] = fade * b[0] + w + refill, fade * b[1] + w * v, fade * b[2] + w * v * v
    a[0], a[1], a[2] = a_11, a_12, a_22
    state.vector[0], state.vector[1] = y_1, y_2
    count_mu_c(state, p)
    return True


@njit(error_model="numpy")
def sd_mu_c(state, p):
    """Standard deviation of mu_c under the noise model, [-]; untouched: mu_c."""
    if state.updates_mu_c == 0:
        return state.mu_c
    a, b = state.information, state.noise
    prior = 1.0 / p.sd_viscosity**2
    determinant = a[0] * (a[2] + prior) - a[1] * a[1]
    g, h = (a[2] + prior) / determinant, -a[1] / determinant
    return math.sqrt(max(g * g * b[0] + 2.0 * g * h * b[1] + h * h * (b[2] + prior), 0.0))


@njit(error_model="numpy")
def learn_r(state, p, y, variance, borrowed):
    """One measured radius y [m] of the given variance [m^2].

    Args:
        state: STATE record, changed in place.
        p: JointParameters record.
        y: Radius [m].
        variance: What is independent from sample to sample in it [m^2].
        borrowed: 1 if y comes from mu_c, whose error all such samples have in common; else 0.
    """
    w = 1.0 / variance
    refill = (1.0 - p.forgetting) / p.sd_r0**2
    information = p.forgetting * state.information_r + w + refill
    if not (math.isfinite(information) and w > 0.0 and math.isfinite(y)):
        return False
    state.r = clamped(state.r + w / information * (y - state.r), p.r_min, p.r_max)
    state.borrowed += w / information * (borrowed - state.borrowed)
    state.information_r = information
    state.noise_r = p.forgetting**2 * state.noise_r + w + refill
    state.product_information = 0.0
    count_r(state, p)
    return True


@njit(error_model="numpy")
def learn_product(state, p, y, variance):
    """One measured product y = mu_c r [m] of the given variance [m^2], for the time when mu_c is known."""
    w = 1.0 / variance
    information = p.forgetting * state.product_information + w
    if math.isfinite(information) and w > 0.0 and math.isfinite(y):
        state.product += w / information * (y - state.product)
        state.product_information = information
        state.product_noise = p.forgetting**2 * state.product_noise + w


@njit(error_model="numpy")
def r_of_product(state, p):
    """Until r is measured itself it is the product of an earlier spin over the present mu_c.

    Returns:
        Whether there is such a product.
    """
    if state.product_information == 0.0:
        return False
    y = state.product / state.mu_c
    information = (state.mu_c * state.product_information) ** 2 / state.product_noise
    if not (math.isfinite(y) and math.isfinite(information) and information > 0.0):
        return False
    state.r = clamped(y, p.r_min, p.r_max)
    state.information_r = state.noise_r = information
    state.borrowed = 1.0
    count_r(state, p)
    return True


@njit(error_model="numpy")
def sd_r(state, error_mu_c):
    """Standard deviation of r under the noise model, [m]; untouched: r.

    Args:
        state: STATE record.
        error_mu_c: That of mu_c [-].
    """
    if state.updates_r == 0:
        return state.r
    own = math.sqrt(state.noise_r) / state.information_r
    common = state.borrowed * state.r * error_mu_c / state.mu_c
    return math.sqrt(own * own + common * common)
