"""The compiled update of the "rls" estimator.

Source: Waltersson & Karayiannidis, Friction Estimation for In-Hand Planar Motion (ISER 2025):
eqs. (1) f_t = gamma_t f_n mu_c and (2) tau = gamma_tau mu_c f_n r, Algorithm 1 for mu_s, and the heuristic
that halts them all. Where this reads the text differently, docs/estimator.md says how, and which parameter
takes the reading back.

All compiled functions are in this one file: numba's cache does not see changes of callees in other files.
"""

import math

from numba import from_dtype, njit, types

from estimator.estimate import ESTIMATE
from estimator.rls.parameters import RlsParameters
from estimator.rls.state import STATE


@njit
def _shares(translation, rotation):
    """Direction cosines of (translation, rotation); zeros where there is none."""
    norm = math.hypot(translation, rotation)
    if norm > 0.0 and math.isfinite(norm):
        return translation / norm, rotation / norm
    return 0.0, 0.0


@njit
def _clamped(value, low, high):
    return min(max(value, low), high)


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
    return _clamped(theta, low, high), covariance


@njit
def _halted(state, p, f_n, elapsed):
    """Heuristic: a rise of f_n faster than eps_delta halts for halt_duration; each new one starts it afresh.

    The sample at which exactly halt_duration has passed learns again; half a sample of tolerance makes that
    hold for times that carry rounding or jitter.
    """
    if not p.heuristic or state.samples == 0:
        return False
    state.halt_left = max(state.halt_left - elapsed, 0.0)
    if (f_n - state.f_n) / elapsed > p.eps_delta:
        state.halt_left = p.halt_duration - 0.5 * p.sample_time
    return state.halt_left > 0.0


@njit
def _clear(state):
    state.buffer_size = 0
    state.buffer_next = 0


@njit
def _append(state, p, ratio):
    state.buffer[state.buffer_next] = ratio
    state.buffer_next = (state.buffer_next + 1) % p.n_b
    state.buffer_size = min(state.buffer_size + 1, p.n_b)


@njit
def _take_mean_of_largest(state, p):
    """Mean of the n_a largest buffered ratios; takes each out by writing -1 over it, below every ratio."""
    total = 0.0
    for _ in range(p.n_a):
        largest = 0
        for i in range(state.buffer_size):
            if state.buffer[i] > state.buffer[largest]:
                largest = i
        total += state.buffer[largest]
        state.buffer[largest] = -1.0
    return total / p.n_a


@njit
def _stick_slip(state, p, f_t, f_n, gamma_t, speed, halted):
    """Algorithm 1: at each start and stop of slip, mu_s is the mean of the largest f_t / (gamma_t f_n).

    The machine runs on every sample in contact; the gate on gamma_t and a halt keep samples from the buffer
    only. An event with fewer than n_a buffered samples, or during a halt, changes the state but not mu_s.
    """
    gate = gamma_t > p.eps_t
    if gate and not halted:
        _append(state, p, f_t / (gamma_t * f_n))
    if p.machine_gated and not gate:
        return
    state.still_samples = state.still_samples + 1 if speed <= p.stick_band else 0
    starts = not state.slipping and speed > p.eps_v
    stops = state.slipping and state.still_samples >= p.stick_samples
    if starts or stops:
        if state.buffer_size >= p.n_a and not halted:
            state.mu_s = _clamped(_take_mean_of_largest(state, p), p.mu_min, p.mu_max)
            state.events_mu_s += 1
        state.slipping = starts
        _clear(state)


@njit
def _motion(state, p, f_t, f_n, tau, gamma_t, gamma_tau):
    """Motion regime: mu_c from (1), then r from (2) with the new mu_c; both gammas from the previous r."""
    if gamma_t > p.eps_t:
        state.mu_c, state.covariance_mu_c = _rls(
            state.mu_c, state.covariance_mu_c, f_t, gamma_t * f_n, p, p.mu_min, p.mu_max
        )
        state.updates_mu_c += 1
    if gamma_tau > p.eps_tau:
        state.r, state.covariance_r = _rls(
            state.r, state.covariance_r, tau, gamma_tau * state.mu_c * f_n, p, p.r_min, p.r_max
        )
        state.updates_r += 1


@njit
def _publish(state, p, gamma_t, gamma_tau, halted, estimate):
    estimate.mu_s = state.mu_s
    estimate.mu_c = state.mu_c
    estimate.r = state.r
    estimate.gamma_t = gamma_t
    estimate.gamma_tau = gamma_tau
    estimate.support_mu_s = state.events_mu_s / (state.events_mu_s + 1.0)
    estimate.support_mu_c = 1.0 - p.forgetting**state.updates_mu_c
    estimate.support_r = 1.0 - p.forgetting**state.updates_r
    estimate.events_mu_s = state.events_mu_s
    estimate.updates_mu_c = state.updates_mu_c
    estimate.updates_r = state.updates_r
    estimate.slipping = state.slipping
    estimate.halted = halted


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
    f_t = math.hypot(wrench[0], wrench[1])
    f_n = wrench[2]
    tau = abs(wrench[3])
    v_t = math.hypot(twist[0], twist[1])
    v_r = state.r * abs(twist[2])
    v = math.hypot(v_t, v_r)
    elapsed = t - state.t
    force_finite = math.isfinite(f_t) and math.isfinite(f_n) and math.isfinite(tau)
    in_order = math.isfinite(t) and (state.samples == 0 or elapsed > 0.0)
    if not (force_finite and math.isfinite(v) and in_order):
        return

    halted = False
    gamma_t, gamma_tau = 0.0, 0.0
    if f_n >= p.eps_fn:
        halted = _halted(state, p, f_n, elapsed)
        if v > (p.eps_v if p.low_speed_gamma_from_force else p.stick_band):
            gamma_t, gamma_tau = _shares(v_t, v_r)
        else:
            gamma_t, gamma_tau = _shares(f_t, tau / state.r)
        _stick_slip(state, p, f_t, f_n, gamma_t, v_t if p.machine_gated else v, halted)
        if v > p.eps_v and not halted:
            _motion(state, p, f_t, f_n, tau, gamma_t, gamma_tau)
    else:
        state.halt_left = 0.0
        state.slipping = False
        state.still_samples = 0
        _clear(state)

    state.t = t
    state.f_n = f_n
    state.samples += 1
    _publish(state, p, gamma_t, gamma_tau, halted, estimate)


def _array(dtype, ndim):
    return types.Array(dtype, ndim, "C")


_RECORDS = [_array(from_dtype(dtype), 1) for dtype in (STATE, RlsParameters.dtype(), ESTIMATE)]
_SIGNATURE = types.void(
    _RECORDS[0], _RECORDS[1], types.float64, _array(types.float64, 2), _array(types.float64, 2), _RECORDS[2]
)


@njit(_SIGNATURE, cache=True)
def update_batch(states, parameters, t, wrenches, twists, estimates):
    """Update n fingers by one sample each.

    Compiled at import, or read from the cache: no first call is slow.

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
        _update(states[i], parameters[i % len(parameters)], t, wrenches[i], twists[i], estimates[i])
