"""Separates slips from springs of the pad: how far the object moved, how far a pad can spring.

A pad springs by its compliance times the change of the load. The compliance is bounded by what is seen: where
the load has changed, the object has moved no less than the pad sprang.
"""

import math

from estimator._numba.caching import njit
from estimator.sample import norm
from estimator.window.layout import INTERVALS, R

SAFETY = 1.5  # Compliance that is assumed, over that which a motion shows: the pad creeps by a half
AROUND = 6
"""Intervals beside those of the stretch in which the load may have sprung the pad: the velocity is late."""
CHANGE, SPAN = 0.4, 3
"""Change of the load that shows a compliance [N]: ten deviations of its noise, and a few micrometres of a
pad; intervals in which it changes."""
NOISE = 3.0  # Deviations of the noise by which forces differ at most
LATE, ASLEEP = 3, 9
"""Intervals by which the velocity is late at most: of an object that has moved; after rest, when a chip that
sleeps takes up to 40 ms to wake up."""
AWAKE = 3.0  # Path that shows that the object moved [counts]


@njit(error_model="numpy")
def is_no_spring(state, p, path):
    """Probability that a stretch of a path [m] is a slip, by the range of the load about it.

    A turn springs a pad by tau / (k r^2), with r a deviation below its estimate. The odds of a slip are the
    fourth power of the path over that of a spring: 5 to 1 at one and a half times.
    """
    count = min(int(state.stretch.instants) + AROUND, min(INTERVALS, state.interval))
    square, rim = 0.0, 0.5 * p.r_max
    r = min(math.exp(state.x[R] - math.sqrt(max(state.covariance[R, R], 0.0))), rim)
    for j in (0, 1, 3):
        low, high = math.inf, -math.inf
        for i in range(state.interval - count, state.interval):
            value = state.intervals[i % INTERVALS].wrench[j]
            low, high = min(low, value), max(high, value)
        noise, scale = (p.sd_torque, r * r / rim) if j == 3 else (p.sd_force, 1.0)
        square += (max(high - low - NOISE * noise, 0.0) / scale) ** 2
    return path**4 / (path**4 + (SAFETY * state.spring) ** 4 * square * square)


@njit(error_model="numpy")
def _path(state, p, first, last):
    """Path of the intervals from `first` to `last` - 1, and what the noise may hide of it [m]."""
    path, hidden, rim = 0.0, 0.0, 0.5 * p.r_max
    for i in range(max(first, 0), last):
        c = state.intervals[i % INTERVALS]
        path += norm(norm(c.motion[0], c.motion[1]), rim * c.motion[2])
        hidden += 0.9 * state.noise * c.time
    return path, hidden


@njit(error_model="numpy")
def stiffen(state, p):
    """Lowers the compliance that is possible: a pad springs no further than the object moves."""
    n, rim = state.interval, 0.5 * p.r_max
    for late in (LATE, ASLEEP):
        first = n - late - SPAN
        if first <= 0 or state.in_a_row < 12:
            return
        a, b = state.intervals[(n - late) % INTERVALS].wrench, state.intervals[first % INTERVALS].wrench
        force = max(norm(a[0] - b[0], a[1] - b[1]) - NOISE * p.sd_force, 0.0)
        change = norm(force, max(abs(a[3] - b[3]) - NOISE * p.sd_torque, 0.0) / rim)
        if change < CHANGE:
            continue
        before, hidden = _path(state, p, n - INTERVALS, first)
        if late == ASLEEP or before > hidden + AWAKE * p.resolution:
            path, hidden = _path(state, p, first - 1, n)
            compliance = SAFETY * (path + hidden) / change
            state.spring = max(min(state.spring, compliance), 0.5 * p.compliance)
