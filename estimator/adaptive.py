"""The "adaptive" estimator: a robust fit over a moving window of slips, on a family of limit surfaces.

docs/adaptive.md describes the model; `estimator.window` is the code, in the order of a sample's way:
`unloaded` (zero errors), `timing` (delay), `intervals` (motion and rest), `sticks` and `window` (entries),
`slide` and `stick` (residuals), `fit`, `change`, `published`; without a slip velocity `drops` alone.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from estimator._numba.caching import njit
from estimator._numba.entry_point import entry_point
from estimator.registry import FilterMatrices, Specification
from estimator.sample import norm, publish, readable
from estimator.window.drops import learn_drop
from estimator.window.intervals import add_sample, lose_contact
from estimator.window.layout import MU, SAMPLES, STATE, R, initial_states
from estimator.window.parameters import AdaptiveParameters
from estimator.window.published import publish_fit
from estimator.window.timing import correlate
from estimator.window.unloaded import is_unloaded, learn_zeros


def filter_matrices(states: NDArray[np.void]) -> FilterMatrices:
    """Covariance of (ln mu_c, ln r) [-]."""
    kept: Any = (MU, R)
    return FilterMatrices(covariance=states["covariance"][:, kept][:, :, kept].copy())


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
    publish_fit(state, p, f_n)


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
