"""Learns errors of the sensors that no slip need show: their zero errors without load, and the delay.

A sensor that has read a small and steady normal force since the start is unloaded, whatever its zero error;
once there was contact, one that reads that force again. Their means are the prior of the zero errors.

The delay between the velocity and the wrench is found from their changes, by Newton's second law.
An object that moves under friction and a slowly changing load obeys m dv/dt = load - friction: every change
of friction is -m times a change of the acceleration at the same instant, while it sticks, breaks away, slides
and stops. Where the motion is prescribed, friction changes with it instead. For each candidate delay the sum
of the products of both changes is kept; the true delay has the largest correlation, of either sign.
"""

import math

from estimator._numba.caching import njit
from estimator.window.layout import SIGMAS, TORQUE, ZERO
from estimator.window.parameters import EARLIEST, LATEST

LEFT = 0.1
"""Deviation that the zero errors keep, over that of the prior: they drift, and readings may be repeated. So
their means fade after 2 / LEFT^2 readings."""
GATE = 0.15
"""Correlation from which a delay is believed: 2.6 deviations of what 7 / GATE^2 samples have by chance. By
this share it must also exceed that of the present one."""


@njit(error_model="numpy")
def is_unloaded(state, p, f_n):
    """Whether a sensor carries no load, from the normal force that it reads [N]."""
    off = abs(f_n - state.zeros[2])
    if state.touched:
        return state.unloaded > 0.0 and off < SIGMAS * p.sd_normal
    loaded = state.unloaded > 0.0 and off > 2.0 * SIGMAS * p.sd_normal
    state.touched = loaded or abs(f_n) > 2.0 * SIGMAS * p.sd_zero
    return not state.touched


@njit(error_model="numpy")
def learn_zeros(state, p, wrench):
    """Takes the reading (4,) of a sensor without load into the means of its zero errors."""
    state.unloaded = min(state.unloaded + 1.0, 2.0 / (LEFT * LEFT))
    for j in range(4):
        state.zeros[j] += (wrench[j] - state.zeros[j]) / state.unloaded
    left = LEFT * LEFT + 6.0 / (state.unloaded + 5.0) * (p.sd_force / p.sd_zero) ** 2
    of_force, of_torque = left * p.sd_zero * p.sd_zero, left * p.sd_zero_torque * p.sd_zero_torque
    for at, zero, variance in ((ZERO, 0, of_force), (ZERO + 1, 1, of_force), (TORQUE, 3, 6.0 * of_torque)):
        state.mean[at] = state.x[at] = state.zeros[zero]
        state.variance[at] = variance
    state.variance_normal = 4.0 * of_force


@njit(error_model="numpy")
def find_delay(state, p):
    """Takes the newest sample into the correlations and chooses the delay.

    The change of the wrench is averaged with both neighbours, because a velocity is the mean over a window.
    The energies of noise alone are added to those of the changes: few samples correlate by chance.
    """
    k, n, scale, count = state.samples, len(state.twists), p.r_max, LATEST - EARLIEST + 1
    if state.in_a_row < count + 5:
        return
    a, b, c = state.twists[(k - 1) % n], state.twists[(k - 2) % n], state.twists[(k - 3) % n]
    x, y = a[0] - 2.0 * b[0] + c[0], a[1] - 2.0 * b[1] + c[1]
    z = (a[2] - 2.0 * b[2] + c[2]) * scale
    if x == 0.0 and y == 0.0 and z == 0.0:
        return
    of_force, best = 0.0, 0
    for i in range(count):
        at = k - 1 - EARLIEST - i
        before, start = state.wrenches[(at - 2) % n], state.wrenches[(at - 3) % n]
        after, end = state.wrenches[(at - 1) % n], state.wrenches[at % n]
        u, v = end[0] + after[0] - before[0] - start[0], end[1] + after[1] - before[1] - start[1]
        w = (end[3] + after[3] - before[3] - start[3]) / scale
        of_force = max(of_force, u * u + v * v + w * w)
        state.products[i] += x * u + y * v + z * w
        if abs(state.products[i]) > abs(state.products[best]):
            best = i
    state.energies[0] += of_force
    state.energies[1] += x * x + y * y + z * z
    noise = 7.0 / (GATE * GATE) * 12.0
    of_both = state.energies[0] + noise * p.sd_force * p.sd_force
    of_both *= state.energies[1] + noise * state.noise * state.noise
    largest, present = abs(state.products[best]), abs(state.products[state.delay - EARLIEST])
    state.timing = largest / math.sqrt(of_both)
    if state.timing > GATE and largest > (1.0 + GATE) * present:
        state.delay = EARLIEST + best
