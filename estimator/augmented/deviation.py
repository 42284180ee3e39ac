"""Stated deviations and confidence: noise, misfit, and the errors that the motion does not show."""

import math

from estimator._numba.caching import njit
from estimator._numba.memory import matrix
from estimator.augmented.exponents import by_groups, exponents, group_weights
from estimator.augmented.model_error import START, doubt_of, of_slips
from estimator.augmented.slip_law import FALLS, GROWS, MU, STATES, R
from estimator.augmented.static_friction import order
from estimator.estimate import confidence_of
from estimator.sample import clamped

_confidence = njit(confidence_of, error_model="numpy")
EVERY = 8
"""Samples after which drifts and deviations are brought up to date while nothing is learned."""


@njit(error_model="numpy")
def _condition(covariance, known):
    """Rows of ln mu_c and ln r in the filter's covariance if both exponents were known.

    Args:
        covariance: (12, 12).
        known: Output (2, 12).

    Returns:
        Change of ln mu_c for one of its exponent and of that of r, and the same of ln r.
    """
    a, b, c = covariance[FALLS, FALLS], covariance[FALLS, GROWS], covariance[GROWS, GROWS]
    scale = 1.0 / (a * c - b * b)
    mu_n = scale * (c * covariance[MU, FALLS] - b * covariance[MU, GROWS])
    mu_b = scale * (a * covariance[MU, GROWS] - b * covariance[MU, FALLS])
    r_n = scale * (c * covariance[R, FALLS] - b * covariance[R, GROWS])
    r_b = scale * (a * covariance[R, GROWS] - b * covariance[R, FALLS])
    for j in range(STATES):
        falls, grows = covariance[FALLS, j], covariance[GROWS, j]
        known[0, j] = covariance[MU, j] - mu_n * falls - mu_b * grows
        known[1, j] = covariance[R, j] - r_n * falls - r_b * grows
    return mu_n, mu_b, r_n, r_b


@njit(error_model="numpy")
def _squared(state, known, weights, mu, r):
    """Variance of mu ln mu_c + r ln r with known exponents: of the filter, and of larger errors.

    Args:
        state: Record with `misfit` and `scatter`.
        known: (2, 12), from `_condition`.
        weights: From `group_weights`.
        mu: Factor of ln mu_c.
        r: Factor of ln r.
    """
    first, second = known[0], known[1]
    filtered = mu * mu * first[MU] + 2.0 * mu * r * first[R] + r * r * second[R]
    square = max(state.misfit, state.scatter, 1.0) * max(filtered, 0.0)
    larger = mu * mu * by_groups(weights, first, first) + r * r * by_groups(weights, second, second)
    return square + larger + 2.0 * mu * r * by_groups(weights, first, second)


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
    weights, known = matrix(1, 4)[0], matrix(2, STATES)
    group_weights(p, weights)
    n, b, of_n, of_both, of_b = exponents(state, p, weights)
    if state.updates_mu_c > 0:
        mu_n, mu_b, r_n, r_b = _condition(state.covariance, known)
        off_n, off_b = n - state.x[FALLS], b - state.x[GROWS]
        state.mu_c = clamped(math.exp(state.x[MU] + mu_n * off_n + mu_b * off_b), p.mu_min, p.mu_max)
        if state.updates_r > 0:
            state.r = clamped(math.exp(state.x[R] + r_n * off_n + r_b * off_b), p.r_min, p.r_max)
        of_fall = mu_n * mu_n * of_n + 2.0 * mu_n * mu_b * of_both + mu_b * mu_b * of_b
        of_growth = r_n * r_n * of_n + 2.0 * r_n * r_b * of_both + r_b * r_b * of_b
        of_either = mu_n * r_n * of_n + (mu_n * r_b + mu_b * r_n) * of_both + mu_b * r_b * of_b
        normal = 1.0 / state.smooth[3]
        hidden = (0.5 * state.leverage) ** 2 + p.sd_gain * p.sd_gain
        of_normal = state.variance_normal * normal * normal
        slips = of_slips(state, p)
        doubt = 0.0 if state.certain else doubt_of(p, state.mu_c, p.mu_c0)
        surface = doubt + slips + p.sd_surface * p.sd_surface
        of_mu_c = state.mu_c * state.mu_c * surface
        of_torque = state.variance_torque * (normal / (state.mu_c * state.r)) ** 2
        square = hidden + of_normal + surface + of_fall + _squared(state, known, weights, 1.0, 0.0)
        state.sd_mu_c = state.mu_c * math.sqrt(square)
        state.confidence_mu_c = _confidence(square)
        square = hidden + of_normal + of_torque + surface + of_fall + 2.0 * of_either + of_growth
        square += _squared(state, known, weights, 1.0, 1.0)
        state.sd_lever = state.mu_c * state.r * math.sqrt(square)
        if state.updates_r > 0:
            square = hidden + of_torque + slips + of_growth + _squared(state, known, weights, 0.0, 1.0)
            # an r that runs to a bound follows a torque that is not that of a slip
            square += state.at_bound * p.sd_log_r0 * p.sd_log_r0
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
