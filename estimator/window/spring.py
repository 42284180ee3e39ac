"""Separates slips from springs of the pad: how far the object moved, how far a pad can spring.

A pad springs by its compliance times the change of the load. The compliance is bounded by what is seen: where
the load has changed, the object has moved no less than the pad sprang.
"""

import math

from estimator._numba.caching import njit
from estimator.sample import norm
from estimator.window.layout import INTERVALS, LATE, SIGMAS, R

SAFETY = 1.5  # Compliance that is assumed, over that which a motion shows: the pad creeps by a half


@njit(error_model="numpy")
def length(p, motion):
    """Length of a motion (3,), with the angle times half the pad's radius [m]."""
    return norm(norm(motion[0], motion[1]), 0.5 * p.r_max * motion[2])


@njit(error_model="numpy")
def is_no_spring(state, p, path):
    """Probability that a stretch of a path [m] is a slip, by the range of the load about it.

    A turn springs a pad by tau / (k r^2), with r a deviation below its estimate. The odds of a slip are the
    fourth power of the path over that of a spring: 5 to 1 at one and a half times.
    """
    count = min(int(state.stretch.instants) + 2 * LATE, min(INTERVALS, state.interval))
    square, rim = 0.0, 0.5 * p.r_max
    r = min(math.exp(state.x[R] - math.sqrt(max(state.covariance[R, R], 0.0))), rim)
    for j in (0, 1, 3):
        low, high = math.inf, -math.inf
        for i in range(state.interval - count, state.interval):
            value = state.intervals[i % INTERVALS].wrench[j]
            low, high = min(low, value), max(high, value)
        noise, scale = (p.sd_torque, r * r / rim) if j == 3 else (p.sd_force, 1.0)
        square += (max(high - low - SIGMAS * noise, 0.0) / scale) ** 2
    return path**4 / (path**4 + (SAFETY * state.spring) ** 4 * square * square)


@njit(error_model="numpy")
def _path(state, p, first, last):
    """Path of the intervals from `first` to `last` - 1, and what the noise may hide of it [m]."""
    path, hidden = 0.0, 0.0
    for i in range(max(first, 0), last):
        c = state.intervals[i % INTERVALS]
        path += length(p, c.motion)
        hidden += 0.9 * state.noise * c.time
    return path, hidden


@njit(error_model="numpy")
def stiffen(state, p):
    """Lowers the compliance that is possible: a pad springs no further than the object moves."""
    n, rim = state.interval, 0.5 * p.r_max
    for late in (LATE, 3 * LATE):
        first = n - late - LATE
        if first <= 0 or state.in_a_row < 12:
            return
        a, b = state.intervals[(n - late) % INTERVALS].wrench, state.intervals[first % INTERVALS].wrench
        force = max(norm(a[0] - b[0], a[1] - b[1]) - SIGMAS * p.sd_force, 0.0)
        change = norm(force, max(abs(a[3] - b[3]) - SIGMAS * p.sd_torque, 0.0) / rim)
        if change < 20.0 * p.sd_force:  # ten deviations of its noise, a few micrometres of a pad
            continue
        before, hidden = _path(state, p, n - INTERVALS, first)
        if late > LATE or before > hidden + SIGMAS * p.resolution:
            path, hidden = _path(state, p, first - 1, n)
            compliance = SAFETY * (path + hidden) / change
            state.spring = max(min(state.spring, compliance), 0.5 * p.compliance)
