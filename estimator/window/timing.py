"""Finds the delay between the velocity and the wrench from their changes, by Newton's second law.

An object that moves under friction and a slowly changing load obeys m dv/dt = load - friction: every change
of friction is -m times a change of the acceleration at the same instant, while it sticks, breaks away, slides
and stops. Where the motion is prescribed, friction changes with it instead. For each candidate delay a fading
sum of the products of both changes is kept; the true delay has the largest correlation, of either sign.
"""

import math

from estimator._numba.caching import njit

EARLIEST, CANDIDATES = -1, 7  # Smallest delay [samples]: the force itself may be late; number of delays
LATEST = EARLIEST + CANDIDATES - 1
MEMORY = 8.0  # Fading of the sums [s]: some slips, of which each has some ten changes
GATE, CLEARLY = 0.15, 1.1
"""Correlation from which a delay is believed, and by how much it must exceed that of the present one."""
QUIET = 300.0
"""Samples of noise alone that are added to the energies: few samples correlate by chance (1 / sqrt(300) = 6
%)."""


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
    if state.in_a_row < CANDIDATES + 5:
        return
    a, b, c = state.twists[(k - 1) % n], state.twists[(k - 2) % n], state.twists[(k - 3) % n]
    x, y = a[0] - 2.0 * b[0] + c[0], a[1] - 2.0 * b[1] + c[1]
    z = (a[2] - 2.0 * b[2] + c[2]) * scale
    if x == 0.0 and y == 0.0 and z == 0.0:
        return
    kept, of_force, largest = math.exp(-elapsed / MEMORY), 0.0, 0.0
    for i in range(CANDIDATES):
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
        for i in range(CANDIDATES):
            if abs(state.products[i]) == largest:
                state.delay = EARLIEST + i
