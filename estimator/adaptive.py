"""The "adaptive" estimator: a filter that identifies the imperfections of its sensors while it works.

An iterated extended Kalman filter on twelve states: ln mu_c, ln r, the viscosity sigma_2, a zero error and a
tilt of the force sensor, an offset of the centre of pressure, the shape of the limit surface, and the
exponents with which mu_c falls and r grows with the normal force (`estimator.augmented.load`). The
measurement is the wrench as a vector (`estimator.augmented.slip_law`). States that the motion does not show
keep their prior variance, and their covariance with mu_c and r carries it into the stated deviations. The
delay between velocity and force is found from their changes (`estimator.augmented.timing`); a sample is
learned from only if the velocity moved for a sample more on either side than that delay asks for, so an
error of one sample does no harm.
"""

import math

import numpy as np
from numpy.typing import NDArray

from estimator._numba.caching import njit
from estimator._numba.entry_point import entry_point
from estimator.augmented.change import test_for_jump, widen
from estimator.augmented.deviation import EVERY, deviate
from estimator.augmented.holding import hold, stiffen
from estimator.augmented.load import at_load, bound_exponent
from estimator.augmented.mounting import learn_tilt
from estimator.augmented.parameters import AdaptiveParameters
from estimator.augmented.prefetching import prefetch
from estimator.augmented.short_slips import learn_short_slip
from estimator.augmented.sliding import slide, store
from estimator.augmented.slip_law import COP, MILLIMETRE, TILT, ZERO
from estimator.augmented.state import STATE, initial_states
from estimator.augmented.static_friction import learn_static_friction
from estimator.augmented.unloaded import drift_zero, learn_zero, without_load
from estimator.limit_surface import DISC_RADIUS
from estimator.registry import FilterMatrices, Specification
from estimator.sample import LARGEST, norm, publish, readable
from estimator.stick_slip import halts, lose_contact


def filter_matrices(states: NDArray[np.void]) -> FilterMatrices:
    """Covariance of (ln mu_c, ln r) [-].

    Args:
        states: Structured array (n,) of dtype STATE.
    """
    return FilterMatrices(covariance=states["covariance"][:, :2, :2].copy())


@njit(error_model="numpy")
def _update(state, p, t, read, twist, estimate):
    """One finger, one sample, with the wrench as it is read."""
    x, f_n = state.x, read[2] - state.zero_normal
    wrench = read[0], read[1], f_n, read[3] - state.zero_torque
    c_x, c_y = MILLIMETRE * x[COP], MILLIMETRE * x[COP + 1]
    f_x, f_y = wrench[0] - x[ZERO] - f_n * x[TILT], wrench[1] - x[ZERO + 1] - f_n * x[TILT + 1]
    f_t, tau = norm(f_x, f_y), abs(wrench[3] - c_x * f_y + c_y * f_x)
    v_t, omega = norm(twist[0] - twist[2] * c_y, twist[1] + twist[2] * c_x), abs(twist[2])
    rim = DISC_RADIUS * p.r_max * omega
    speed_2 = v_t * v_t + rim * rim
    if not readable(state, t, f_t, f_n, tau, speed_2):
        return
    halted, saw_mu_c, saw_r, gamma_t, gamma_tau = False, False, False, 0.0, 0.0
    events, changed = state.events_mu_s, False
    elapsed = min(t - state.t, LARGEST) if state.samples > 0 else p.sample_time
    unloaded = without_load(state, p, read[2])
    if unloaded or f_n < p.eps_fn:
        lose_contact(state)
        state.in_a_row, state.moved, state.beyond, state.first, state.held = 0, 0, 0, -1, 0.0
        state.resting = 0
        if unloaded:
            learn_zero(state, p, read)
    else:
        halted = halts(state, p, f_n, elapsed)
        moves = speed_2 > p.eps_v * p.eps_v
        store(state, p, wrench, twist, moves, elapsed)
        stiffen(state, p)
        if p.tilt_from_sticks:
            learn_tilt(state, p, wrench, moves, f_t)
        if state.samples % EVERY == 0:
            rest = EVERY * p.drift_at_rest * p.drift_at_rest
            widen(state, rest, p.sd_log_mu_c0**2)
            hold(state, p, f_t, f_n)
            if p.exponent_from_sticks:
                bound_exponent(state, p, f_t, f_n)
        if not halted and slide(state, p):
            saw_mu_c = True
            state.updates_mu_c += 1
            saw_r = omega > p.noise_gate * p.sd_spin and v_t < 3.0 * p.r_max * omega
            if saw_r:
                state.updates_r += 1
        elif not halted:
            updates_r = state.updates_r
            score = learn_short_slip(state, p, moves)
            if math.isfinite(score):
                saw_mu_c, saw_r = True, state.updates_r > updates_r
                state.updates_mu_c += 1
                test_for_jump(state, p, score)
        changed = saw_mu_c | at_load(state, p, f_n)
        still = speed_2 <= p.stick_band * p.stick_band
        moves = state.beyond > 0
        learn_static_friction(state, p, f_t, f_n, tau, still, moves, halted)
        rim = state.r * omega if moves else tau / state.r
        across = v_t if moves else f_t
        size = norm(across, rim)
        if 0.0 < size < math.inf:
            gamma_t, gamma_tau = across / size, rim / size
    if state.samples % EVERY == 0:
        drift_zero(state, p, EVERY * elapsed)
    deviate(state, p, changed or state.events_mu_s != events)
    state.elapsed = elapsed
    publish(state, t, f_n, gamma_t, gamma_tau, halted, saw_mu_c, saw_r, estimate)
    estimate.sd_lever = state.sd_lever


@entry_point(STATE, AdaptiveParameters.dtype())
def update_batch(states, parameters, t, wrenches, twists, estimates):
    """Updates n fingers by one sample each; see `estimator.registry.Specification`."""
    for i in range(len(states)):
        prefetch(states, i)
        p = parameters[min(i, len(parameters) - 1)]
        wrench = wrenches[i, 0], wrenches[i, 1], wrenches[i, 2], wrenches[i, 3]
        twist = twists[i, 0], twists[i, 1], twists[i, 2]
        _update(states[i], p, t, wrench, twist, estimates[i])


SPECIFICATION = Specification("adaptive", AdaptiveParameters, initial_states, update_batch, filter_matrices)
