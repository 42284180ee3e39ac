"""Learns errors of the sensors that no slip need show: their zero errors without load, and the delay.

A sensor that has read a small and steady normal force since the start is unloaded, whatever its zero error;
once there was contact, one that reads that force again. Their means are the prior of the zero errors.

The delay between the velocity and the wrench is found from their changes, by Newton's second law.
An object that moves under friction and a slowly changing load obeys m dv/dt = load - friction: every change
of friction is -m times a change of the acceleration at the same instant, while it sticks, breaks away, slides
and stops. Where the motion is prescribed, friction changes with it instead. For each candidate delay a fading
sum of the products of both changes is kept; the true delay has the largest correlation, of either sign.
"""

import math

from estimator._numba.caching import njit
from estimator.window.layout import TORQUE, ZERO
from estimator.window.parameters import EARLIEST, LATEST

OPEN = 0.6
"""Normal force up to which a sensor may be unloaded at first [N]: six deviations of its zero error."""
BEGINS, AGAIN = 6.0, 3.0
"""Deviations of the noise of f_n beyond which contact begins, and within which it has ended."""
LONGEST = 200.0  # Readings after which the zeros are a fading mean
LEFT = 0.1
"""Deviation that the zero errors keep, over that of the prior: they drift, and readings may be repeated."""
MEMORY = 8.0  # Fading of the sums [s]: some slips, of which each has some ten changes
GATE, CLEARLY = 0.15, 1.1
"""Correlation from which a delay is believed, and by how much it must exceed that of the present one."""
QUIET = 300.0
"""Samples of noise alone that are added to the energies: few samples correlate by chance (1 / sqrt(300) = 6
%)."""


@njit(error_model="numpy")
def is_unloaded(state, p, f_n):
    """Whether a sensor carries no load, from the normal force that it reads [N]."""
    off = abs(f_n - state.zeros[2])
    if state.touched:
        return state.unloaded > 0.0 and off < AGAIN * p.sd_normal
    state.touched = abs(f_n) > OPEN or (state.unloaded > 0.0 and off > BEGINS * p.sd_normal)
    return not state.touched


@njit(error_model="numpy")
def learn_zeros(state, p, wrench):
    """Takes the reading (4,) of a sensor without load into the means of its zero errors."""
    state.unloaded = min(state.unloaded + 1.0, LONGEST)
    for j in range(4):
        state.zeros[j] += (wrench[j] - state.zeros[j]) / state.unloaded
    left = LEFT * LEFT + 6.0 / (state.unloaded + 5.0) * (p.sd_force / p.sd_zero) ** 2
    of_force, of_torque = left * p.sd_zero * p.sd_zero, left * p.sd_zero_torque * p.sd_zero_torque
    for at, zero, variance in ((ZERO, 0, of_force), (ZERO + 1, 1, of_force), (TORQUE, 3, 6.0 * of_torque)):
        state.mean[at] = state.x[at] = state.zeros[zero]
        state.variance[at] = variance
    state.variance_normal = 4.0 * of_force


@njit(error_model="numpy")
def correlate(state, p, elapsed):
    """Takes the newest sample into the correlations and chooses the delay.

    The change of the wrench is averaged with both neighbours, because a velocity is the mean over a window.

    Args:
        state: `products`, `energies`, `timing` and `delay` are changed.
        p: Parameters.
        elapsed: Time since the last sample [s].
    """
    k, n, scale = state.samples, len(state.twists), p.r_max
    if state.in_a_row < LATEST - EARLIEST + 6:
        return
    a, b, c = state.twists[(k - 1) % n], state.twists[(k - 2) % n], state.twists[(k - 3) % n]
    x, y = a[0] - 2.0 * b[0] + c[0], a[1] - 2.0 * b[1] + c[1]
    z = (a[2] - 2.0 * b[2] + c[2]) * scale
    if x == 0.0 and y == 0.0 and z == 0.0:
        return
    kept, of_force, largest = math.exp(-elapsed / MEMORY), 0.0, 0.0
    for i in range(LATEST - EARLIEST + 1):
        at = k - 1 - EARLIEST - i
        before, start = state.wrenches[(at - 2) % n], state.wrenches[(at - 3) % n]
        after, end = state.wrenches[(at - 1) % n], state.wrenches[at % n]
        u, v = end[0] + after[0] - before[0] - start[0], end[1] + after[1] - before[1] - start[1]
        w = (end[3] + after[3] - before[3] - start[3]) / scale
        of_force = max(of_force, u * u + v * v + w * w)
        state.products[i] = kept * state.products[i] + x * u + y * v + z * w
        largest = max(largest, abs(state.products[i]))
    energies = state.energies
    energies[0] = kept * energies[0] + of_force
    energies[1] = kept * energies[1] + x * x + y * y + z * z
    noise = QUIET * 12.0 * p.sd_force * p.sd_force, QUIET * 12.0 * state.noise * state.noise
    of_both = math.sqrt((energies[0] + noise[0]) * (energies[1] + noise[1]))
    state.timing = largest / of_both
    if largest > GATE * of_both and largest > CLEARLY * abs(state.products[state.delay - EARLIEST]):
        for i in range(LATEST - EARLIEST + 1):
            if abs(state.products[i]) == largest:
                state.delay = EARLIEST + i
