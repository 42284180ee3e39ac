"""The "adaptive" estimator: a robust fit over a moving window of slips, on a family of limit surfaces.

docs/adaptive.md describes the model; `estimator.window` is the code, in the order of a sample's way:
`sensors` (zero errors, delay), `intervals` (motion and rest), `sticks` and `window` (entries), `residuals`,
`fit`, `change`.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from estimator._numba.caching import njit
from estimator._numba.entry_point import entry_point
from estimator.estimate import confidence_of
from estimator.registry import FilterMatrices, Specification
from estimator.sample import clamped, norm, publish, readable
from estimator.window.intervals import add_sample, lose_contact
from estimator.window.layout import FALLS, GROWS, MU, RATIO, SAMPLES, STATE, R, initial_states
from estimator.window.parameters import AdaptiveParameters
from estimator.window.sensors import find_delay, is_unloaded, learn_zeros
from estimator.window.sticks import learn_drop

_confidence = njit(confidence_of, error_model="numpy")


def filter_matrices(states: NDArray[np.void]) -> FilterMatrices:
    """Covariance of (ln mu_c, ln r) [-]."""
    kept: Any = (MU, R)
    return FilterMatrices(covariance=states["covariance"][:, kept][:, :, kept].copy())


@njit(error_model="numpy")
def _publish_fit(state, p, f_n):
    """Writes the values of the state at a normal force [N], with deviations and confidence.

    The covariance of the fit contains every state that the motion does not show. Added are the errors that no
    motion shows: gain, cross-talk and anisotropy (`sd_gain`), the zero error of f_n, slips that were springs,
    the error of the law once more for a second without a slip and for what all break-aways share.
    """
    x, c, by = state.x, state.covariance, math.log(f_n) - state.reference
    of_mu = c[MU, MU] + by * (by * c[FALLS, FALLS] - 2.0 * c[MU, FALLS])
    of_r = c[R, R] + by * (by * c[GROWS, GROWS] + 2.0 * c[R, GROWS])
    of_both = c[MU, R] + by * (c[MU, GROWS] - c[R, FALLS] - by * c[FALLS, GROWS])
    # the load of a spring is anywhere up to the limit, so that its mean squared distance from that is a third
    gain, law = p.sd_gain * p.sd_gain + state.springs / 3.0, p.law_error * p.law_error
    hidden = gain + state.variance_normal / (f_n * f_n) + law * (state.t - state.fit_time)
    state.mu_c = clamped(math.exp(x[MU] - x[FALLS] * by), p.mu_min, p.mu_max)
    state.sd_mu_c, state.confidence_mu_c = _known(state.mu_c, of_mu + hidden)
    if state.updates_r > 0:
        r = math.exp(x[R] + x[GROWS] * by)
        state.at_bound = 1.0 if r > p.r_max else 0.0
        state.r = clamped(r, p.r_min, p.r_max)
        # an r beyond the pad follows a torque that is not that of a slip
        beyond = state.at_bound * p.sd_log_r0 * p.sd_log_r0
        state.sd_r, state.confidence_r = _known(state.r, of_r + gain + beyond)
    lever = max(of_mu + of_r + 2.0 * of_both, 0.0) + hidden
    state.sd_lever = state.mu_c * state.r * math.sqrt(lever)
    # where break-aways are known, they say what mu_s is, whatever mu_c is
    left = min(c[RATIO, RATIO] / state.variance[RATIO], 1.0)
    state.mu_s = clamped(math.exp(x[MU] - x[FALLS] * by + x[RATIO]), p.mu_min, p.mu_max)
    state.sd_mu_s, sure = _known(state.mu_s, c[RATIO, RATIO] + left * left * of_mu + hidden + law)
    state.confidence_mu_s = sure if state.events_mu_s > 0 else 0.0


@njit(error_model="numpy")
def _known(value, square):
    """Standard deviation and confidence of a value, by its squared relative deviation."""
    return value * math.sqrt(square), _confidence(square)


@njit(error_model="numpy")
def _touch(state, p, wrench, f_n, twist):
    """Takes a sample in contact."""
    at = state.samples % SAMPLES
    state.in_a_row += 1
    for j in range(4):
        state.wrenches[at, j] = wrench[j] if j != 2 else f_n
    for j in range(3):
        state.twists[at, j] = twist[j]
    if p.unmeasured == 0:
        find_delay(state, p)
        add_sample(state, p)
    elif p.unmeasured == 1:
        learn_drop(state, p)
    if state.updates_mu_c > 0:
        _publish_fit(state, p, f_n)


@njit(error_model="numpy")
def _update(state, p, t, wrench, twist, estimate):
    """One finger, one sample, with the wrench as it is read."""
    f_n, f_t, tau = wrench[2] - state.zeros[2], norm(wrench[0], wrench[1]), abs(wrench[3])
    v_t, omega = norm(twist[0], twist[1]), abs(twist[2])
    if not readable(state, t, f_t, f_n, tau, v_t + omega):
        return
    updates_mu_c, updates_r = state.updates_mu_c, state.updates_r
    state.elapsed = t - state.t if state.samples > 0 else 1.0
    gamma_t, gamma_tau = 0.0, 0.0
    unloaded = is_unloaded(state, p, wrench[2])
    if unloaded or f_n < p.eps_fn:
        lose_contact(state, p)
        if unloaded:
            learn_zeros(state, p, wrench)
    else:
        _touch(state, p, wrench, f_n, twist)
        moves = state.run > 0
        across, rim = (v_t, state.r * omega) if moves else (f_t, tau / state.r)
        size = norm(across, rim)
        if size > 0.0:
            gamma_t, gamma_tau = across / size, rim / size
    state.slipping = state.run > 0
    saw_mu_c, saw_r = state.updates_mu_c != updates_mu_c, state.updates_r != updates_r
    publish(state, t, f_n, gamma_t, gamma_tau, False, saw_mu_c, saw_r, estimate)
    estimate.sd_lever = state.sd_lever


@entry_point(STATE, AdaptiveParameters.dtype())
def update_batch(states, parameters, t, wrenches, twists, estimates):
    """Updates n fingers by one sample each; see `estimator.registry.Specification`."""
    for i in range(len(states)):
        p = parameters[min(i, len(parameters) - 1)]
        wrench = wrenches[i, 0], wrenches[i, 1], wrenches[i, 2], wrenches[i, 3]
        twist = twists[i, 0], twists[i, 1], twists[i, 2]
        _update(states[i], p, t, wrench, twist, estimates[i])


SPECIFICATION = Specification("adaptive", AdaptiveParameters, initial_states, update_batch, filter_matrices)
