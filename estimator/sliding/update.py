"""One sample of an estimator that learns from each instant of true sliding: all but the learning."""

import math

from numba import njit

from estimator.limit_surface.inverse import load_size
from estimator.sliding.timing import boundary, squared_speed
from estimator.stick_slip.kernel import (
    append,
    clear_buffer,
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

JUMP = 3.0
"""Standard deviations of a change of mu_s that are no longer scatter."""


@njit
def _learn_mu_s(state, p, value):
    """Averages events; one too far off for their scatter starts the average afresh: mu_s has changed."""
    change, gain = abs(value - state.mu_s), state.gain_mu_s
    spread = math.sqrt(state.scatter_mu_s * (1.0 + gain))
    jumps = change > max(p.jump_mu_s * state.mu_s, JUMP * spread)
    new = jumps or state.events_mu_s == 0
    learn_mu_s(state, value, 1.0 if new else max(gain / (1.0 + gain), p.gain_mu_s), jumps)


@njit
def _stick_slip(state, p, f_t, f_n, tau, still, moves, halted):
    """mu_s at each start of a slip: the largest mu of the stick before it, in units of the limit surface.

    A torque beyond the gate empties the buffer: of the spin that it may start, the loads before tell nothing.
    """
    if not state.slipping and not halted:
        if shares(f_t, tau / state.r)[0] > p.eps_t:
            append(state, p, load_size(p.disc, f_t, tau / state.r) / f_n)
        else:
            clear_buffer(state)
    starts, stops = transition(state, p, still, moves)
    if starts and not halted and state.buffer_size >= p.n_a:
        _learn_mu_s(state, p, take_event(state, p))
    if starts or stops:
        clear_buffer(state)


@njit
def open_sample(state, p, t, wrench, twist):
    """Takes a sample in: whether it is valid, and whether there is an instant of sliding to learn from.

    Args:
        state: Record whose dtype holds SLIDING_STATE, changed in place.
        p: Record of a subclass of SlidingParameters.
        t: Time [s].
        wrench: (4,) f_x, f_y, f_n, tau [N, N, N, N m].
        twist: (3,) v_x, v_y, omega [m/s, m/s, rad/s].

    Returns:
        taken: Whether the sample is finite and later than the last; if not, nothing has changed.
        halted: Whether the heuristic holds all updates back.
        slid: Whether to learn from the instant.
        instant: f_t, f_n, |tau|, v_t, |omega| of it [N, N, N m, m/s, rad/s], variances of v_t and omega.
        seen: f_t, f_n, |tau|, v_t, |omega| and squared scaled speed of the sample itself.
    """
    f_t, f_n, tau = norm(wrench[0], wrench[1]), wrench[2], abs(wrench[3])
    speed_2 = squared_speed(p, twist[0], twist[1], twist[2])
    seen = (f_t, f_n, tau, norm(twist[0], twist[1]), abs(twist[2]), speed_2)
    nothing = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    if not readable(state, t, f_t, f_n, tau, speed_2):
        return False, False, False, nothing, seen
    if f_n < p.eps_fn:
        lose_contact(state)
        state.in_a_row = 0
        return True, False, False, nothing, seen
    elapsed = t - state.t
    halted = halts(state, p, f_n, elapsed)
    slid, instant = boundary(state, p, f_t, f_n, tau, twist, speed_2 > p.eps_v * p.eps_v, elapsed)
    return True, halted, slid and not halted, instant, seen


@njit
def close_sample(state, p, t, seen, halted, saw_mu_c, saw_r, estimate):
    """Runs the stick-slip machine and publishes.

    Args:
        state: As in `open_sample`, like the next two.
        p: Parameters.
        t: Time [s].
        seen: From `open_sample`, like the next.
        halted: Whether all updates are held back.
        saw_mu_c: Whether mu_c was learnt.
        saw_r: Whether r was learnt.
        estimate: ESTIMATE record, written.
    """
    f_t, f_n, tau, v_t, omega, speed_2 = seen
    gamma_t, gamma_tau = 0.0, 0.0
    if f_n >= p.eps_fn:
        moves = speed_2 > p.eps_v * p.eps_v
        _stick_slip(state, p, f_t, f_n, tau, speed_2 <= p.stick_band * p.stick_band, moves, halted)
        if moves:
            gamma_t, gamma_tau = shares(v_t, state.r * omega)
        else:
            gamma_t, gamma_tau = shares(f_t, tau / state.r)
    state.elapsed = t - state.t
    publish(state, t, f_n, gamma_t, gamma_tau, halted, saw_mu_c, saw_r, estimate)
