"""The "adaptive" estimator: a robust fit over a moving window of slips, on a family of limit surfaces.

docs/adaptive.md describes the model; `estimator.window` is the code, in the order of a sample's way:
`unloaded` (zero errors), `timing` (delay), `intervals` (motion and rest), `sticks` and `window` (entries),
`slide` and `stick` (residuals), `fit`, `change`, `published`; without a slip velocity `drops` alone.
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
from estimator.window.drops import learn_drop
from estimator.window.intervals import add_sample, lose_contact
from estimator.window.layout import MU, RATIO, SAMPLES, STATE, R, initial_states
from estimator.window.parameters import AdaptiveParameters
from estimator.window.sensors import correlate, is_unloaded, learn_zeros
from estimator.window.window import refer

NEARLY = 0.02  # Relative change of the normal force for which the values are computed again
LATER, AGEING = 1.0, 1e-3
"""Time after which they are computed again [s]; variance of ln mu_c that a second without slips adds."""
EVENTS = 0.05  # Relative error that all break-aways share: the time in stick, the place
SPRUNG = 0.6  # Relative error of a slip that was a spring of the pad: its load is anywhere up to the limit
_confidence = njit(confidence_of, error_model="numpy")


def filter_matrices(states: NDArray[np.void]) -> FilterMatrices:
    """Covariance of (ln mu_c, ln r) [-].

    Args:
        states: Structured array (n,) of dtype STATE.
    """
    kept: Any = (MU, R)
    return FilterMatrices(covariance=states["covariance"][:, kept][:, :, kept].copy())


@njit(error_model="numpy")
def _publish_fit(state, p, f_n):
    """Writes the values of the state at a normal force [N], if they have changed since."""
    if state.fitted:
        state.fit_time = state.t
    again = abs(f_n - state.load) > NEARLY * state.load or state.t > state.look_time + LATER
    if not (state.fitted or again) or state.updates_mu_c == 0:
        return
    refer(state, f_n)
    state.fitted, state.load, state.look_time = False, f_n, state.t
    x, c = state.x, state.covariance
    hidden = p.sd_gain * p.sd_gain + state.variance_normal / (f_n * f_n) + AGEING * (state.t - state.fit_time)
    sprung = SPRUNG * SPRUNG * state.springs
    hidden += sprung
    square = c[MU, MU] + hidden
    state.mu_c = clamped(math.exp(x[MU]), p.mu_min, p.mu_max)
    state.sd_mu_c, state.confidence_mu_c = state.mu_c * math.sqrt(square), _confidence(square)
    if state.updates_r > 0:
        state.at_bound = 1.0 if math.exp(x[R]) > p.r_max else 0.0
        state.r = clamped(math.exp(x[R]), p.r_min, p.r_max)
        # an r beyond the pad follows a torque that is not that of a slip
        square = c[R, R] + p.sd_gain * p.sd_gain + sprung + state.at_bound * p.sd_log_r0 * p.sd_log_r0
        state.sd_r, state.confidence_r = state.r * math.sqrt(square), _confidence(square)
    square = max(c[MU, MU] + c[R, R] + 2.0 * c[MU, R], 0.0) + hidden
    state.sd_lever = state.mu_c * state.r * math.sqrt(square)
    # where break-aways are known, they say what mu_s is, whatever mu_c is
    left = min(c[RATIO, RATIO] / state.variance[RATIO], 1.0)
    square = c[RATIO, RATIO] + left * left * c[MU, MU] + hidden + EVENTS * EVENTS
    state.mu_s = clamped(math.exp(x[MU] + x[RATIO]), p.mu_min, p.mu_max)
    state.sd_mu_s = state.mu_s * math.sqrt(square)
    state.confidence_mu_s = _confidence(square) if state.events_mu_s > 0 else 0.0


@njit(error_model="numpy")
def _touch(state, p, wrench, f_n, twist):
    """Takes a sample in contact."""
    elapsed = state.elapsed
    at = state.samples % SAMPLES
    state.in_a_row += 1
    for j in range(4):
        state.wrenches[at, j] = wrench[j] if j != 2 else f_n
    for j in range(3):
        state.twists[at, j] = twist[j]
    if p.unmeasured > 0:
        if p.unmeasured == 1:
            learn_drop(state, p)
        return
    correlate(state, p, elapsed)
    add_sample(state, p, elapsed)
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
