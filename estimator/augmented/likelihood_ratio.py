"""Tests whether mu_c has changed since the last slip, by how the filter itself would answer to such a change.

While the contact rests, nothing shows that friction has changed. The next slip shows it, but there the filter
can explain a change otherwise: by the exponent of the load, if the grip is another one, or by r, if the slip
turns. So a test of the innovations alone is late. This one is the generalised likelihood ratio of Willsky &
Jones (A generalized likelihood ratio approach to the detection and estimation of jumps in linear systems,
IEEE Transactions on Automatic Control 21(1), 1976): `response` is the error that all states have now for a
change of ln mu_c by 1 before the slip, and what it adds to each innovation is fitted to the innovations. If
the fit is much more probable than slips that differ by `sd_between_slips`, every state moves by its response
times the change, so that the exponent and r are again what they were.

A hypothesis begins with a slip. It gives way to a new one at a later slip, if what slips have shown since
then speaks against it. Tilt and zero errors that are learned at rest are taken to have nothing to do with
the change. Where one change after the other is found, slips differ by that much, and the next change has to
be larger.
"""

import math

from estimator._numba.caching import fused, njit
from estimator.augmented.model_error import START
from estimator.augmented.slip_law import FALLS, GROWS, MU, STATES, without
from estimator.augmented.whitening import weighted, whitened
from estimator.sample import clamped

FORGOTTEN = 0.3
"""Response of ln mu_c below which the filter has learned the friction after a change."""
LEAST = 2
"""Innovations that a change needs: one sample is none."""
UNLIKELY, MANY = 1.0, 8
"""A hypothesis whose evidence is below this after so many innovations is dropped."""


@njit(error_model="numpy")
def size_of_change(state, p):
    """Most probable change of ln mu_c before the slip, and the information on it that includes the prior."""
    information = state.change_information + 1.0 / (p.sd_jump * p.sd_jump)
    return state.change_fit / information, information


@njit(error_model="numpy")
def _evidence(state, square, least):
    """Logarithm of the likelihood of a change with the variance `square` over that of one with `least`."""
    fit, known = state.change_fit, state.change_information
    large, small = 1.0 + square * known, 1.0 + least * known
    return 0.5 * (fit * fit * (square / large - least / small) - math.log(large / small))


@njit(error_model="numpy")
def suspect(state, p):
    """Begins a hypothesis at the first sample of a slip, unless an earlier one is still possible."""
    square = p.sd_jump * p.sd_jump
    learned = square * state.change_information > 1.0 or abs(state.response[MU]) < FORGOTTEN
    if state.suspected and not (learned and _evidence(state, square, 0.0) < 0.0):
        return
    forget_change(state)
    state.suspected, state.change_events, state.response[MU] = True, state.events_mu_s, 1.0


@njit(error_model="numpy")
def forget_change(state):
    """Drops the hypothesis."""
    state.suspected, state.change_fit, state.change_information = False, 0.0, 0.0
    state.change_samples = 0
    state.response[:] = 0.0


@fused
def respond(state, h, f_n, crossed, w, a, b, c):
    """Takes a wrench from which the filter has learned into the response and the fit.

    Args:
        state: Changed in place.
        h: (3, 12), derivatives of the measurements; those by zero error and tilt, 1 and f_n, are not read.
        f_n: Normal force [N].
        crossed: (3, 12), covariances of states and measurements.
        w: `whitening` of the innovation's covariance.
        a: First innovation, whitened.
        b: As a.
        c: As a.
    """
    if not state.suspected:
        return
    x, y, z = whitened(w, *without(0.0, 0.0, 0.0, h, f_n, state.response))
    state.change_fit -= x * a + y * b + z * c
    state.change_information += x * x + y * y + z * z
    state.change_samples += 1
    x, y, z = weighted(w, x, y, z)
    for k in range(STATES):
        state.response[k] += crossed[0, k] * x + crossed[1, k] * y + crossed[2, k] * z


@njit(error_model="numpy")
def respond_to_ratio(state, h, crossed, weight, innovation):
    """As `respond`, for a scalar measurement.

    Args:
        state: Changed in place.
        h: (12,), derivatives of the measurement.
        crossed: (12,), covariances of the states with it.
        weight: 1 / variance of the innovation.
        innovation: Measurement less its expectation.
    """
    if not state.suspected:
        return
    shown = 0.0
    for k in range(STATES):
        shown += h[k] * state.response[k]
    state.change_fit += shown * innovation * weight
    state.change_information += shown * shown * weight
    state.change_samples += 1
    for k in range(STATES):
        state.response[k] -= crossed[k] * weight * shown


@njit(error_model="numpy")
def decide(state, p):
    """Moves all states and mu_s if mu_c has changed before this slip; whether it has.

    The bounds of the states are the caller's.
    """
    least = p.sd_between_slips * p.sd_between_slips + state.changes / (START + state.separate)
    square = p.sd_jump * p.sd_jump + least
    if state.change_samples < LEAST:
        return False
    size, information = size_of_change(state, p)
    most = 0.5 * state.change_fit * size
    if most < p.jump_odds:  # an upper bound of the evidence, without a logarithm
        if most < UNLIKELY and state.change_samples >= MANY:
            forget_change(state)
        return False
    if not _evidence(state, square, least) > p.jump_odds:
        return False
    variance, response = 1.0 / information, state.response
    # no exponent is less known than at the start
    for j, spread in ((FALLS, p.sd_load_exponent), (GROWS, p.sd_radius_exponent)):
        unknown = max(spread * spread - state.covariance[j, j], 0.0)
        if response[j] != 0.0:
            variance = min(variance, unknown / (response[j] * response[j]))
    for j in range(STATES):
        state.x[j] += size * response[j]
        for k in range(STATES):
            state.covariance[j, k] += variance * (response[j] * response[k])
    if state.events_mu_s > 0 and state.change_events == state.events_mu_s:  # mu_s is that before the change
        state.event = clamped(state.event * math.exp(size), p.mu_min, p.mu_max)
    state.changes += size * size
    state.contrast += size * size  # as a difference between slips, see `estimator.augmented.model_error`
    state.runs[:] = 0.0
    forget_change(state)
    return True
