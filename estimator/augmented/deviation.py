"""Stated deviations and confidence: noise, misfit, and the errors that the motion does not show."""

import math

from estimator._numba.caching import njit
from estimator.augmented.load import exponents
from estimator.augmented.model_error import START, doubt_of, of_slips
from estimator.augmented.slip_law import FALLS, GROWS, MU, SHAPE, ZERO, R
from estimator.augmented.static_friction import order
from estimator.estimate import confidence_of
from estimator.sample import clamped

_confidence = njit(confidence_of, error_model="numpy")
EVERY = 8
"""Samples after which drifts and deviations are brought up to date while nothing is learned."""


@njit(error_model="numpy")
def _squared(state, weights, hidden, mu, r):
    """Variance of mu ln mu_c + r ln r: of the filter, and from errors larger than it assumes.

    The error that a linear filter makes for a unit error of the prior mean of another state is the covariance
    with that state over its prior variance.

    Args:
        state: Record with `covariance` and `misfit`.
        weights: Of the squared covariances with zero error, tilt, CoP and shape.
        hidden: What is added.
        mu: Factor of ln mu_c.
        r: Factor of ln r.
    """
    first, second = state.covariance[MU], state.covariance[R]
    filtered = mu * mu * first[MU] + 2.0 * mu * r * first[R] + r * r * second[R]
    square = hidden + max(state.misfit, state.scatter, 1.0) * max(filtered, 0.0)
    for group in range(3):
        at = ZERO + 2 * group
        a, b = mu * first[at] + r * second[at], mu * first[at + 1] + r * second[at + 1]
        square += weights[group] * (a * a + b * b)
    a = mu * first[SHAPE] + r * second[SHAPE]
    return square + weights[3] * a * a


@njit(error_model="numpy")
def _share(state, i, j):
    """Change of state i that goes with a change of state j."""
    return state.covariance[i, j] / state.covariance[j, j]


@njit(error_model="numpy")
def deviate(state, p, changed):
    """Standard deviations and confidence; the order of mu_s and mu_c.

    Args:
        state: Changed in place.
        p: Parameters.
        changed: Whether the states changed at this sample.
    """
    if not changed and state.samples % EVERY != 0:
        return
    of_mu_c, of_mu_s = 0.0, 0.0
    n, of_n, b, of_b = exponents(state, p)
    if state.updates_mu_c > 0:
        share, step = _share(state, MU, FALLS), n - state.x[FALLS]
        state.mu_c = clamped(math.exp(state.x[MU] + share * step), p.mu_min, p.mu_max)
        of_fall = share * share * (of_n - state.covariance[FALLS, FALLS])
        share, step = _share(state, R, GROWS), b - state.x[GROWS]
        if state.updates_r > 0:
            state.r = clamped(math.exp(state.x[R] + share * step), p.r_min, p.r_max)
        of_growth = share * share * (of_b - state.covariance[GROWS, GROWS])
        assumed = p.caution * p.caution
        factor, normal = (1.0 - assumed) / (assumed * assumed), 1.0 / state.smooth[3]
        weights = (
            factor / (p.sd_zero * p.sd_zero),
            factor / (p.sd_tilt * p.sd_tilt),
            factor / (p.sd_cop * p.sd_cop),
            factor / (p.sd_shape * p.sd_shape),
        )
        hidden = (0.5 * state.leverage) ** 2 + p.sd_gain * p.sd_gain
        of_normal = state.variance_normal * normal * normal
        slips = of_slips(state, p)
        doubt = 0.0 if state.certain else doubt_of(p, state.mu_c, p.mu_c0)
        surface = doubt + slips + p.sd_surface * p.sd_surface
        of_mu_c = state.mu_c * state.mu_c * surface
        of_torque = state.variance_torque * (normal / (state.mu_c * state.r)) ** 2
        square = _squared(state, weights, hidden + of_normal + surface + of_fall, 1.0, 0.0)
        state.sd_mu_c = state.mu_c * math.sqrt(square)
        state.confidence_mu_c = _confidence(square)
        square = _squared(state, weights, hidden + of_normal + of_torque + surface, 1.0, 1.0)
        state.sd_lever = state.mu_c * state.r * math.sqrt(square)
        if state.updates_r > 0:
            square = _squared(state, weights, hidden + of_torque + slips + of_growth, 0.0, 1.0)
            state.sd_r = state.r * math.sqrt(square)
            state.confidence_r = _confidence(square)
    if state.events_mu_s > 0:
        step = math.log(state.load / state.event_load)
        state.mu_s = clamped(state.event * math.exp(-n * step), p.mu_min, p.mu_max)
        square = state.variance_mu_s + state.common_mu_s + max(state.scatter_mu_s, 0.0)
        surface = p.sd_surface * p.sd_surface + p.sd_slip * p.sd_slip / (START + state.events_mu_s)
        surface += state.doubt + step * step * of_n
        square += surface
        of_mu_s = state.mu_s * state.mu_s * surface
        state.sd_mu_s = state.mu_s * math.sqrt(square)
        state.confidence_mu_s = _confidence(square)
    order(state, of_mu_c, of_mu_s)
