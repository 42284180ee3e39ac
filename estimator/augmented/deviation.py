"""Stated deviations and confidence: noise, misfit, and the errors that the motion does not show."""

import math

from estimator._numba.caching import njit
from estimator.augmented.slip_law import COP, MU, SHAPE, TILT, ZERO, R
from estimator.augmented.static_friction import order
from estimator.sample import clamped


@njit(error_model="numpy")
def _unseen(covariance, p, of):
    """Variance of ln mu_c or ln r from errors larger than the filter assumes.

    The error that a linear filter makes for a unit error of the prior mean of another state is the covariance
    with that state over its prior variance.
    """
    row = covariance[of]
    total = (row[ZERO] * row[ZERO] + row[ZERO + 1] * row[ZERO + 1]) / (p.sd_zero * p.sd_zero)
    total += (row[TILT] * row[TILT] + row[TILT + 1] * row[TILT + 1]) / (p.sd_tilt * p.sd_tilt)
    total += (row[COP] * row[COP] + row[COP + 1] * row[COP + 1]) / (p.sd_cop * p.sd_cop)
    total += row[SHAPE] * row[SHAPE] / (p.sd_shape * p.sd_shape)
    assumed = p.caution * p.caution
    return total * (1.0 - assumed) / (assumed * assumed)


@njit(error_model="numpy")
def deviate(state, p):
    """Standard deviations and confidence; the order of mu_s and mu_c."""
    excess = max(state.misfit, 1.0)
    covariance = state.covariance
    hidden = (0.5 * state.leverage) ** 2 + p.sd_gain * p.sd_gain
    if state.updates_mu_c > 0:
        state.mu_c = clamped(math.exp(state.x[MU]), p.mu_min, p.mu_max)
        state.r = clamped(math.exp(state.x[R]), p.r_min, p.r_max)
        square = excess * covariance[MU, MU] + _unseen(covariance, p, MU) + hidden
        square += state.variance_normal / (state.smooth[3] * state.smooth[3])
        state.sd_mu_c = state.mu_c * math.sqrt(square)
        state.confidence_mu_c = 1.0 / (1.0 + 100.0 * square)
    if state.updates_r > 0:
        square = excess * covariance[R, R] + _unseen(covariance, p, R) + hidden
        square += state.variance_torque / (state.mu_c * state.r * state.smooth[3]) ** 2
        state.sd_r = state.r * math.sqrt(square)
        state.confidence_r = 1.0 / (1.0 + 100.0 * square)
    if state.events_mu_s > 0:
        square = state.variance_mu_s + state.common_mu_s
        state.sd_mu_s = state.mu_s * math.sqrt(square)
        state.confidence_mu_s = 1.0 / (1.0 + 100.0 * square)
    order(state)
