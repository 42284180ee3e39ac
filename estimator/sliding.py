"""Shared parts of "joint", "disc" and "ukf": everything but the learning of mu_c and r.

They learn from instants of true sliding. A velocity is the mean over a window that closed `velocity_delay`
samples ago; a force is an instant. The force at the boundary of two windows is a force of sliding if both
windows moved: a slip that starts or stops within a window makes it slower than eps_v or makes the next window
empty. The mean of both velocities is the velocity at the boundary, to second order in time; the faster it
changes, the less certain it is, by up to half the change.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from estimator._numba.caching import njit
from estimator.limit_surface import DISC_RADIUS
from estimator.limit_surface.inverse import load_size
from estimator.parameters import RADIUS, parameter
from estimator.sample import direction_cosines, norm, publish, readable
from estimator.stick_slip import (
    BUFFER_CAPACITY,
    STICK_SLIP_STATE,
    StickSlipParameters,
    append,
    clear_buffer,
    halts,
    learn_mu_s,
    lose_contact,
    take_event,
    transition,
)

DELAY_MAX = 6
"""Largest velocity_delay: the forces since then are part of the state, whose size is fixed."""

FORCES = DELAY_MAX + 2
"""Rows of the ring of forces."""

UNEVEN = 1.0 / 12.0
"""Variance of the velocity at a boundary, in squared changes between its windows: uniform in half of one."""

JUMP = 3.0
"""Standard deviations beyond which a change of mu_s is not scatter."""


@dataclass(frozen=True)
class SlidingParameters(StickSlipParameters):
    """Table 1 of Waltersson & Karayiannidis (ISER 2025) where shared; the noise is that of realistic sensors.

    They also say how velocities are paired with forces, and events averaged.

    Raises:
        ValueError: A value has the wrong type, is NaN, lies outside its interval or contradicts another one.
    """

    heuristic: bool = parameter(
        False, "Whether a fast rise of f_n halts all updates; the test of sliding makes it unnecessary."
    )
    r0: float = parameter(0.01, "Start value of r: that of a uniform disc as large as the pad.", RADIUS, "m")
    r_max: float = parameter(0.015, "Radius of the pad: r is kept at or below this.", RADIUS, "m")
    n_a: int = parameter(
        1, "How many of the largest buffered ratios are averaged to mu_s.", f"[1, {BUFFER_CAPACITY}]"
    )
    jump_mu_s: float = parameter(
        0.15, "Relative change, if above three deviations too, at which mu_s starts afresh.", "(0, inf]"
    )

    noise_gate: float = parameter(
        2.0, "How many of its standard deviations a signal must exceed to count.", "(0, inf)"
    )
    sd_force: float = parameter(0.02, "Standard deviation of f_t.", "(0, inf)", "N")
    sd_normal: float = parameter(0.04, "Standard deviation of f_n.", "(0, inf)", "N")
    sd_torque: float = parameter(5e-4, "Standard deviation of tau.", "(0, inf)", "N m")
    sd_speed: float = parameter(1.6e-4, "Standard deviation of v_t.", "(0, inf)", "m/s")
    sd_spin: float = parameter(6.5e-3, "Standard deviation of omega.", "(0, inf)", "rad/s")
    law_error: float = parameter(
        0.02, "Relative error of the friction law in a sample, as if it were white.", "[0, inf)"
    )
    disc: bool = parameter(
        False, "Whether the limit surface is that of a uniform disc; otherwise it is the ellipsoid."
    )
    gain_mu_s: float = parameter(
        0.2, "Weight of a new event in mu_s, once 1 / gain_mu_s events have been averaged.", "(0, 1]"
    )
    velocity_delay: int = parameter(
        1, "Age of the velocity in samples: how long ago its window closed.", f"[0, {DELAY_MAX}]"
    )


SLIDING_STATE: list[tuple[Any, ...]] = [
    *STICK_SLIP_STATE,
    ("elapsed", np.float64),
    ("in_a_row", np.int64),
    ("forces", np.float64, (FORCES, 3)),
    ("twist", np.float64, (3,)),
    ("moved", np.bool_),
]
"""The last samples: `forces` is a ring of (f_t, f_n, |tau|) [N, N, N m], `twist` the previous twist,
`moved` whether it moved, `elapsed` the last interval [s], `in_a_row` how many samples came without a gap."""


@njit
def slides(p, f_t, v_t):
    """Whether f_t [N] and v_t [m/s] are both above their noise."""
    return f_t > p.noise_gate * p.sd_force and v_t > p.noise_gate * p.sd_speed


@njit
def spins(p, tau, omega):
    """Whether |tau| [N m] and |omega| [rad/s] are both above their noise."""
    return tau > p.noise_gate * p.sd_torque and omega > p.noise_gate * p.sd_spin


@njit
def _squared_speed(p, v_x, v_y, omega):
    """Squared scaled speed at the radius of a uniform pad, so that no estimate decides whether it moves."""
    rim_speed = DISC_RADIUS * p.r_max * omega
    return v_x * v_x + v_y * v_y + rim_speed * rim_speed


@njit
def _boundary(state, p, f_t, f_n, tau, twist, moves, elapsed):
    """Stores the newest sample and looks back to the newest boundary of two velocity windows.

    Returns:
        Whether the contact slid there; f_t, f_n, |tau|, v_t, |omega| at that instant; and the variances of
        that v_t and omega.
    """
    if state.samples >= 2 and elapsed > 1.5 * state.elapsed:  # a sample was lost: the windows do not touch
        state.in_a_row = 0
    forces = state.forces[state.samples % FORCES]
    forces[0], forces[1], forces[2] = f_t, f_n, tau
    state.in_a_row += 1
    before = state.twist
    past = state.forces[(state.samples - p.velocity_delay - 1) % FORCES]
    slid = state.in_a_row >= p.velocity_delay + 3 and moves and state.moved
    v_t = 0.5 * norm(before[0] + twist[0], before[1] + twist[1])
    omega = 0.5 * abs(before[2] + twist[2])
    d_x, d_y, d_omega = twist[0] - before[0], twist[1] - before[1], twist[2] - before[2]
    before[0], before[1], before[2] = twist[0], twist[1], twist[2]
    state.moved = moves
    of_speed = p.sd_speed * p.sd_speed + UNEVEN * (d_x * d_x + d_y * d_y)
    of_spin = p.sd_spin * p.sd_spin + UNEVEN * d_omega * d_omega
    return slid, (past[0], past[1], past[2], v_t, omega, of_speed, of_spin)


@njit
def _average_mu_s(state, p, value):
    """Averages events; an event too far off for their scatter means that mu_s has changed: a new average."""
    change, gain = abs(value - state.mu_s), state.gain_mu_s
    spread = math.sqrt(state.scatter_mu_s * (1.0 + gain))
    jumps = change > max(p.jump_mu_s * state.mu_s, JUMP * spread)
    new = jumps or state.events_mu_s == 0
    learn_mu_s(state, value, 1.0 if new else max(gain / (1.0 + gain), p.gain_mu_s), jumps)


@njit
def _stick_slip(state, p, f_t, f_n, tau, still, moves, halted):
    """Learns mu_s at the start of a slip: the largest load / f_n of the stick before it.

    The load is measured in units of the limit surface. A torque beyond the gate empties the buffer: the spin
    that it may start has nothing to do with the loads before it.
    """
    if not state.slipping and not halted:
        if direction_cosines(f_t, tau / state.r)[0] > p.eps_t:
            append(state, p, load_size(p.disc, f_t, tau / state.r) / f_n)
        else:
            clear_buffer(state)
    starts, stops = transition(state, p, still, moves)
    if starts and not halted and state.buffer_size >= p.n_a:
        _average_mu_s(state, p, take_event(state, p))
    if starts or stops:
        clear_buffer(state)


@njit
def open_sample(state, p, t, wrench, twist):
    """Checks and stores a sample, and finds the instant of sliding to learn from.

    `state` holds SLIDING_STATE, `p` is of a subclass of SlidingParameters.

    Returns:
        taken: Whether the sample is finite and later than the last; if not, nothing has changed.
        halted: Whether the heuristic halts all updates.
        slid: Whether to learn from the instant.
        instant: f_t, f_n, |tau|, v_t, |omega| of it [N, N, N m, m/s, rad/s], variances of v_t and omega.
        seen: f_t, f_n, |tau|, v_t, |omega| and squared scaled speed of the sample itself.
    """
    f_t, f_n, tau = norm(wrench[0], wrench[1]), wrench[2], abs(wrench[3])
    speed_2 = _squared_speed(p, twist[0], twist[1], twist[2])
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
    slid, instant = _boundary(state, p, f_t, f_n, tau, twist, speed_2 > p.eps_v * p.eps_v, elapsed)
    return True, halted, slid and not halted, instant, seen


@njit
def close_sample(state, p, t, seen, halted, saw_mu_c, saw_r, estimate):
    """Advances the stick-slip state machine and publishes the estimate; `seen` is that of `open_sample`."""
    f_t, f_n, tau, v_t, omega, speed_2 = seen
    gamma_t, gamma_tau = 0.0, 0.0
    if f_n >= p.eps_fn:
        moves = speed_2 > p.eps_v * p.eps_v
        _stick_slip(state, p, f_t, f_n, tau, speed_2 <= p.stick_band * p.stick_band, moves, halted)
        if moves:
            gamma_t, gamma_tau = direction_cosines(v_t, state.r * omega)
        else:
            gamma_t, gamma_tau = direction_cosines(f_t, tau / state.r)
    state.elapsed = t - state.t
    publish(state, t, f_n, gamma_t, gamma_tau, halted, saw_mu_c, saw_r, estimate)
