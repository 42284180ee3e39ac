"""Which force belongs to which velocity, and whether the contact slid at that instant.

A velocity is the mean over a window that closed `velocity_delay` samples ago; a force is an instant. The
force at the boundary of two windows is that of sliding if both windows moved: a slip that began or ended in
one of them leaves it slower than eps_v or is over before the other. The mean of both is the velocity there,
to second order in time; the less smoothly it changes, the less it is known, by up to half the change.
"""

from numba import njit

from estimator.limit_surface import DISC_RADIUS
from estimator.sliding.state import FORCES
from estimator.stick_slip.kernel import norm

UNEVEN = 1.0 / 12.0
"""Variance of the velocity at a boundary, in squared changes between its windows: even within half of one."""


@njit
def squared_speed(p, v_x, v_y, omega):
    """Of the scaled speed at a uniform pad's radius: whether it moves is not a matter of the estimate."""
    rim_speed = DISC_RADIUS * p.r_max * omega
    return v_x * v_x + v_y * v_y + rim_speed * rim_speed


@njit
def boundary(state, p, f_t, f_n, tau, twist, moves, elapsed):
    """Takes the newest sample and looks back to the newest boundary of two windows.

    Returns:
        Whether the contact slid there; f_t, f_n, |tau|, v_t, |omega| of that instant; and the variances of
        that v_t and omega.
    """
    if state.samples >= 2 and elapsed > 1.5 * state.elapsed:  # one was lost: the windows are not neighbours
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
