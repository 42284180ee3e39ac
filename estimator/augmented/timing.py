"""Finds the delay between the velocity and the wrench from their changes, by Newton's second law.

An object that moves under friction and a slowly changing load obeys m dv/dt = load - friction: every change
of the friction force is minus m times a change of the acceleration, at the same instant, while it sticks,
breaks away, slides and stops. For each candidate delay a fading sum of the products of both changes is
kept; the true delay has the most negative correlation. No friction parameter enters, so it works before
anything is known. With a velocity of which only prescribed motion is seen the correlation is weak, and the
nominal delay stays.
"""

import math

from estimator._numba.caching import njit

EARLIEST = -1
"""Smallest candidate: the force itself may be late."""
CANDIDATES = 7
"""Delays -1 ... 5 samples of the velocity against the force."""
LATEST = EARLIEST + CANDIDATES - 1
HUGE = 1e100
"""Squares beyond it are not taken in."""
CLEARLY = 1.1
"""How much larger the correlation of another delay must be before it is taken."""
QUIET = 300.0
"""Samples of noise alone that the changes are compared with: few samples correlate by chance."""
RING = 16
"""Samples that are kept, a power of two."""
LAST = RING - 1
NEWEST = 8
"""Changes of the wrench that are kept, for as many candidates and a power of two."""
_LAST = NEWEST - 1


@njit(error_model="numpy")
def _force_change(wrenches, forces, scale, k):
    """Stores the change of the wrench across the sample k - 1, averaged with both neighbours.

    Averaged, because a velocity is the mean over a window.

    Args:
        wrenches: (RING, 4) ring of f_x, f_y, f_n, tau.
        forces: (NEWEST, 3) ring of the changes of f_x, f_y, tau / scale [N].
        scale: Length by which torque and spin are made comparable with force and speed [m].
        k: Number of the newest wrench.
    """
    a, b = wrenches[k & LAST], wrenches[(k - 1) & LAST]
    c, d = wrenches[(k - 2) & LAST], wrenches[(k - 3) & LAST]
    change = forces[(k - 1) & _LAST]
    change[0] = 0.25 * (a[0] + b[0] - c[0] - d[0])
    change[1] = 0.25 * (a[1] + b[1] - c[1] - d[1])
    change[2] = 0.25 * (a[3] + b[3] - c[3] - d[3]) / scale


@njit(error_model="numpy")
def correlate(state, p):
    """Takes the newest sample into the correlations and chooses the delay.

    Args:
        state: Record with `samples`, `in_a_row`, the rings `wrenches`, `twists` and `forces`, the sums
            `products` and `energies`, `sign`; `delay`, `offset` and `timing` are the result.
        p: Parameters.
    """
    k, scale = state.samples, p.r_max
    _force_change(state.wrenches, state.forces, scale, k)
    if state.in_a_row < CANDIDATES + 3:
        return
    a, b, c = state.twists[(k - 1) & LAST], state.twists[(k - 2) & LAST], state.twists[(k - 3) & LAST]
    x, y = a[0] - 2.0 * b[0] + c[0], a[1] - 2.0 * b[1] + c[1]
    z = (a[2] - 2.0 * b[2] + c[2]) * scale
    newest = state.forces[(k - 1) & _LAST]
    force = newest[0] * newest[0] + newest[1] * newest[1] + newest[2] * newest[2]
    speed = x * x + y * y + z * z
    if not (force < HUGE and speed < HUGE):  # so that no sum of products overflows
        return
    products, energies, forces = state.products, state.energies, state.forces
    memory, sign = p.timing_memory, state.sign
    energies[0] = of_force = memory * energies[0] + force
    energies[1] = of_speed = memory * energies[1] + speed
    largest = -math.inf
    for n in range(CANDIDATES):
        change = forces[(k - 2 - EARLIEST - n) & _LAST]
        products[n] = memory * products[n] - sign * (x * change[0] + y * change[1] + z * change[2])
        largest = max(largest, products[n])
    of_force += QUIET * 0.75 * p.sd_force * p.sd_force
    of_speed += QUIET * 18.0 * p.sd_speed * p.sd_speed
    of_both = math.sqrt(of_force * of_speed)
    state.timing = largest / of_both
    if largest > p.timing_gate * of_both and largest > CLEARLY * products[state.delay - EARLIEST]:
        best = 0
        while products[best] < largest:
            best += 1
        state.delay = EARLIEST + best
    at = state.delay - EARLIEST
    state.offset = 0.5
    if 0 < at < CANDIDATES - 1:
        bend = products[at - 1] - 2.0 * products[at] + products[at + 1]
        if bend < 0.0:
            state.offset = 0.5 * (products[at - 1] - products[at + 1]) / bend
