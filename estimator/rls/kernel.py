"""The compiled update of the "rls" estimator.

Source: Waltersson & Karayiannidis, Friction Estimation for In-Hand Planar Motion (ISER 2025):
eqs. (1) f_t = gamma_t f_n mu_c and (2) tau = gamma_tau mu_c f_n r, Algorithm 1 for mu_s, and the heuristic
that halts them all. Where this reads the text differently, docs/estimator.md says how, and which parameter
takes the reading back.
"""

import math

from numba import njit

from estimator.compiled import entry_point
from estimator.rls.parameters import RlsParameters
from estimator.rls.state import STATE
from estimator.stick_slip.kernel import (
    append,
    clamped,
    clear_buffer,
    count_mu_c,
    count_r,
    halts,
    learn_mu_s,
    lose_contact,
    norm,
    publish,
    readable,
    shares,
    take_event,
    transition,
)


@njit
def _rls(theta, covariance, y, phi, p, low, high):
    """One scalar RLS step with forgetting for y = phi theta.

    Returns:
        theta within [low, high], its covariance P within covariance_limit p0; both as they were on overflow.
    """
    denominator = p.forgetting + phi * phi * covariance
    innovation = y - phi * theta
    if not (math.isfinite(denominator) and math.isfinite(innovation)):
        return theta, covariance
    theta = theta + covariance * phi / denominator * innovation
    # P / (lambda + phi^2 P) is (1 - K phi) P / lambda without its cancellation: it cannot turn negative.
    covariance = min(covariance / denominator, p.covariance_limit * p.p0)
    return clamped(theta, low, high), covariance


@njit
def _residual(mean_square, theta, covariance, y, phi, p, updates):
    """Mean square of the innovations, each in units of its own spread, with the memory of the estimate."""
    innovation = y - phi * theta
    square = innovation * innovation * p.forgetting / (p.forgetting + phi * phi * covariance)
    share = max(1.0 / (updates + 1.0), 1.0 - p.forgetting)
    updated = (1.0 - share) * mean_square + share * square
    return updated if math.isfinite(updated) else mean_square


@njit
def _stick_slip(state, p, f_t, f_n, gamma_t, speed, halted):
    """Algorithm 1: at each start and stop of slip, mu_s is the mean of the largest f_t / (gamma_t f_n).

    The machine runs on every sample in contact; the gate on gamma_t and a halt keep samples from the buffer
    only. An event with fewer than n_a buffered samples, or during a halt, changes the state but not mu_s.
    """
    gate = gamma_t > p.eps_t
    if gate and not halted:
        append(state, p, f_t / (gamma_t * f_n))
    if p.machine_gated and not gate:
        return
    starts, stops = transition(state, p, speed <= p.stick_band, speed > p.eps_v)
    if starts or stops:
        if not halted and state.buffer_size >= p.n_a:
            learn_mu_s(state, take_event(state, p), 1.0, False)
        clear_buffer(state)


@njit
def _motion(state, p, f_t, f_n, tau, gamma_t, gamma_tau):
    """Motion regime: mu_c from (1), then r from (2) with the new mu_c; both gammas from the previous r.

    The standard deviation of either is the root of its residual variance times P.
    """
    if gamma_t > p.eps_t:
        phi = gamma_t * f_n
        state.residual_mu_c = _residual(
            state.residual_mu_c, state.mu_c, state.covariance_mu_c, f_t, phi, p, state.updates_mu_c
        )
        state.mu_c, state.covariance_mu_c = _rls(
            state.mu_c, state.covariance_mu_c, f_t, phi, p, p.mu_min, p.mu_max
        )
        state.sd_mu_c = math.sqrt(state.residual_mu_c * state.covariance_mu_c)
        count_mu_c(state, p)
    if gamma_tau > p.eps_tau:
        phi = gamma_tau * state.mu_c * f_n
        state.residual_r = _residual(
            state.residual_r, state.r, state.covariance_r, tau, phi, p, state.updates_r
        )
        state.r, state.covariance_r = _rls(state.r, state.covariance_r, tau, phi, p, p.r_min, p.r_max)
        state.sd_r = math.sqrt(state.residual_r * state.covariance_r)
        count_r(state, p)


@njit
def _update(state, p, t, wrench, twist, estimate):
    """One finger, one sample.

    Args:
        state: STATE record, changed in place.
        p: RlsParameters record.
        t: Time [s].
        wrench: (4,) f_x, f_y, f_n, tau [N, N, N, N m].
        twist: (3,) v_x, v_y, omega [m/s, m/s, rad/s].
        estimate: ESTIMATE record, written.
    """
    f_t = norm(wrench[0], wrench[1])
    f_n = wrench[2]
    tau = abs(wrench[3])
    v_t = norm(twist[0], twist[1])
    v_r = state.r * abs(twist[2])
    v = norm(v_t, v_r)
    if not readable(state, t, f_t, f_n, tau, v):
        return

    halted = False
    gamma_t, gamma_tau = 0.0, 0.0
    updates_mu_c, updates_r = state.updates_mu_c, state.updates_r
    if f_n >= p.eps_fn:
        halted = halts(state, p, f_n, t - state.t)
        if v > (p.eps_v if p.low_speed_gamma_from_force else p.stick_band):
            gamma_t, gamma_tau = shares(v_t, v_r)
        else:
            gamma_t, gamma_tau = shares(f_t, tau / state.r)
        _stick_slip(state, p, f_t, f_n, gamma_t, v_t if p.machine_gated else v, halted)
        if v > p.eps_v and not halted:
            _motion(state, p, f_t, f_n, tau, gamma_t, gamma_tau)
    else:
        lose_contact(state)
    saw_mu_c, saw_r = state.updates_mu_c > updates_mu_c, state.updates_r > updates_r
    publish(state, t, f_n, gamma_t, gamma_tau, halted, saw_mu_c, saw_r, estimate)


@entry_point(STATE, RlsParameters.dtype())
def update_batch(states, parameters, t, wrenches, twists, estimates):
    """Update n fingers by one sample each.

    A row with a value that is not finite, or with a t not later than the row's last, is left as it is.

    Args:
        states: (n,) of dtype STATE, changed in place.
        parameters: (1,), shared, or (n,) of dtype RlsParameters.dtype().
        t: Time [s].
        wrenches: (n, 4) f_x, f_y, f_n, tau [N, N, N, N m] at the CoP.
        twists: (n, 3) v_x, v_y, omega [m/s, m/s, rad/s] at the CoP.
        estimates: (n,) of dtype ESTIMATE, written.
    """
    for i in range(len(states)):
        p = parameters[min(i, len(parameters) - 1)]
        wrench = wrenches[i, 0], wrenches[i, 1], wrenches[i, 2], wrenches[i, 3]
        twist = twists[i, 0], twists[i, 1], twists[i, 2]
        _update(states[i], p, t, wrench, twist, estimates[i])
