"""Stated deviations and confidence: noise, misfit, and the errors that the motion does not show."""

import math

from estimator._numba.caching import njit
from estimator.augmented.slip_law import COP, MU, SHAPE, TILT, ZERO, R
from estimator.augmented.static_friction import order
from estimator.sample import clamped


@njit(error_model="numpy")
def _squared(state, p, mu, r):
    """Variance of mu ln mu_c + r ln r: of the filter, and from errors larger than it assumes.

    The error that a linear filter makes for a unit error of the prior mean of another state is the covariance
    with that state over its prior variance.
    """
    first, second = state.covariance[MU], state.covariance[R]
    total, normal = 0.0, state.smooth[3]
    for at in range(ZERO, SHAPE + 1):
        spread = p.sd_zero if at < TILT else p.sd_tilt if at < COP else p.sd_cop if at < SHAPE else p.sd_shape
        unseen = (mu * first[at] + r * second[at]) / spread
        total += unseen * unseen
    assumed = p.caution * p.caution
    square = total * (1.0 - assumed) / (assumed * assumed)
    filtered = mu * mu * first[MU] + 2.0 * mu * r * first[R] + r * r * second[R]
    square += max(state.misfit, 1.0) * max(filtered, 0.0)
    square += (0.5 * state.leverage) ** 2 + p.sd_gain * p.sd_gain
    square += mu * state.variance_normal / (normal * normal)
    return square + r * state.variance_torque / (state.mu_c * state.r * normal) ** 2


@njit(error_model="numpy")
def deviate(state, p):
    """Standard deviations and confidence; the order of mu_s and mu_c."""
    if state.updates_mu_c > 0:
        state.mu_c = clamped(math.exp(state.x[MU]), p.mu_min, p.mu_max)
        state.r = clamped(math.exp(state.x[R]), p.r_min, p.r_max)
        square = _squared(state, p, 1.0, 0.0)
        state.sd_mu_c = state.mu_c * math.sqrt(square)
        state.confidence_mu_c = 1.0 / (1.0 + 100.0 * square)
        state.sd_lever = state.mu_c * state.r * math.sqrt(_squared(state, p, 1.0, 1.0))
    if state.updates_r > 0:
        square = _squared(state, p, 0.0, 1.0)
        state.sd_r = state.r * math.sqrt(square)
        state.confidence_r = 1.0 / (1.0 + 100.0 * square)
    if state.events_mu_s > 0:
        square = state.variance_mu_s + state.common_mu_s
        state.sd_mu_s = state.mu_s * math.sqrt(square)
        state.confidence_mu_s = 1.0 / (1.0 + 100.0 * square)
    order(state)
