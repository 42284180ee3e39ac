"""Learns from the load at rest: the largest one before a slip, and the fall of a short slip."""

import math

from estimator._numba.caching import njit
from estimator._numba.memory import matrix
from estimator.sample import norm
from estimator.window.change import fit
from estimator.window.layout import FALL, INTERVALS, SAMPLES, TILT, TORQUE, ZERO, R
from estimator.window.spring import SAFETY
from estimator.window.window import length, new_entry, store_break

BEFORE = 0.04  # Time before a slip in which the largest load counts [s]
SETTLED = 3  # Intervals at rest until a slip has ended and the pad has come to rest
STEP, PASSED = 0.8, 0.1
"""Change of the normal force that shows a tilt [N]; share of the load that may pass to the other finger."""
DROP, DROPS = 0.08, 5.0
"""Fall of the load from one interval to the next that is a break-away: relative, and in deviations of the
noise."""
AT_LEAST = 0.5  # Smallest ratio of mu_c and mu_s
PASSES = 0.9  # Probability that such a fall is a slip


@njit(error_model="numpy")
def _size(state, w):
    """Size of the load of a wrench (4,) without the zero errors [N]."""
    x = state.x
    return norm(norm(w[0] - x[ZERO], w[1] - x[ZERO + 1]), (w[3] - x[TORQUE]) * math.exp(-x[R]))


@njit(error_model="numpy")
def find_peak(state):
    """Stores the wrench of the largest load over f_n shortly before the velocity begins to show a slip."""
    k, largest = state.samples - state.delay, 0.0
    count = min(int(BEFORE / state.elapsed) + 3, min(state.in_a_row, SAMPLES) - state.delay - 2)
    for i in range(k - count, min(k + 2, state.samples + 1)):
        w = state.wrenches[i % SAMPLES]
        ratio = _size(state, w) / w[2]
        if ratio > largest:
            largest = ratio
            state.peak[:] = w


@njit(error_model="numpy")
def learn_tilt(state, p, wrench):
    """Takes a change of the tangential force that comes with one of f_n in a stick as the tilt of the sensor.

    An object at rest carries its load, whatever the normal force. A change of the load itself is an outlier.
    """
    rest, step = state.rest, wrench[2] - state.rest[2]
    if abs(step) < STEP:
        return
    for axis in range(2):
        at = TILT + axis
        off = wrench[axis] - rest[axis] - state.mean[at] * step
        noise = 2.0 * p.sd_force * p.sd_force + (PASSED * norm(wrench[0], wrench[1])) ** 2
        total = step * step * state.variance[at] + noise
        if rest[2] > 0.0 and off * off < 9.0 * total:
            state.mean[at] += state.variance[at] * step * off / total
            state.variance[at] *= noise / total
    rest[:] = wrench


@njit(error_model="numpy")
def _fall(state, p, first, last):
    """Number of the interval at whose end the load has fallen most, and still is one of a slip; -1: none."""
    found, largest, most = -1, 0.0, 0.0
    for i in range(first - 2, last - 1):
        a, b = state.intervals[(i - 1) % INTERVALS], state.intervals[i % INTERVALS]
        before, after = _size(state, a.wrench), _size(state, b.wrench)
        most = max(most, before / a.wrench[2])
        drop = before - after
        if drop > max(DROP * before, DROPS * p.sd_force, largest) and after > AT_LEAST * most * b.wrench[2]:
            found, largest = i, drop
    return found


@njit(error_model="numpy")
def learn_short_slip(state, p):
    """Takes the load after the fall of a slip that ended some intervals ago and was too short for an instant.

    An object that breaks away slides while the force is off the load, so force over f_n is mu_c. The fall is
    seen in the force itself; the velocity only has to show that the object moved along it, further than a pad
    springs.
    """
    first, last, rim = state.first, state.interval - 1, 0.5 * p.r_max
    state.learned = True
    if last - first > INTERVALS - 5 or first < 4 or state.in_a_row < 12:
        return
    found = _fall(state, p, first, last)
    if found < 0:
        return
    ring = state.intervals
    w, before, after = ring[found % INTERVALS], ring[(first - 2) % INTERVALS], ring[last % INTERVALS]
    moved, change, work, fastest = matrix(1, 3)[0], matrix(1, 3)[0], 0.0, 0.0
    for j in range(3):
        at = j if j < 2 else 3
        change[j] = (after.wrench[at] - before.wrench[at]) / (1.0 if j < 2 else rim * rim)
        moved[j] = 0.0
        for i in range(first, last + 1):
            moved[j] += ring[i % INTERVALS].motion[j]
        work += moved[j] * (w.wrench[at] - state.x[ZERO + j])
    for i in range(first, last + 1):
        fastest = max(fastest, length(p, ring[i % INTERVALS].motion) / ring[i % INTERVALS].time)
    least = SAFETY * state.spring * length(p, change) + 6.0 * state.noise * w.time
    if state.power == 0.0:  # the first motion says which way the wrench is taken
        state.sign = 1.0 if work > 0.0 else -1.0
    if not (work * state.sign > 0.0 and length(p, moved) > least):
        return
    state.power += 0.1 * state.sign
    store_break(state, p)
    s = new_entry(state, p, FALL, PASSES, w.wrench)
    s.unknown = math.exp(-((fastest / (3.0 * p.stribeck_velocity)) ** 2))
    state.slip_time += 2.0 * w.time
    fit(state, p)
    state.updates_mu_c += 1
