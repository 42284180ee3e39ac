"""Learns from the load at rest: the largest one before a slip, and the fall of a short slip."""

import math

from estimator._numba.caching import njit
from estimator._numba.memory import matrix
from estimator.sample import copy, norm
from estimator.window import layout as at
from estimator.window.change import fit
from estimator.window.layout import AT_LEAST, EVENT, FALL, INTERVALS, LATE, SAMPLES, SIGMAS, TORQUE, ZERO, R
from estimator.window.spring import SAFETY, length
from estimator.window.window import DOUBT, new_entry, store_break


@njit(error_model="numpy")
def _size(state, w):
    """Size of the load of a wrench (4,) without the zero errors [N]."""
    x = state.x
    return norm(norm(w[0] - x[ZERO], w[1] - x[ZERO + 1]), (w[3] - x[TORQUE]) * math.exp(-x[R]))


@njit(error_model="numpy")
def find_peak(state):
    """Stores the wrench of the largest load over f_n shortly before the velocity begins to show a slip."""
    k, largest = state.samples - state.delay, 0.0
    count = min(
        int(2 * LATE * at.SHORTEST / state.elapsed) + 3, min(state.in_a_row, SAMPLES) - state.delay - 2
    )
    for i in range(k - count, min(k + 2, state.samples + 1)):
        w = state.wrenches[i % SAMPLES]
        ratio = _size(state, w) / w[2]
        if ratio > largest:
            largest = ratio
            copy(w, state.peak)


@njit(error_model="numpy")
def learn_tilt(state, p, wrench):
    """Takes a change of the tangential force that comes with one of f_n in a stick as the tilt of the sensor.

    An object at rest carries its load, whatever the normal force, but for a tenth that may pass to the other
    finger. A change of the load itself is an outlier.
    """
    rest, step = state.rest, wrench[2] - state.rest[2]
    if abs(step) < 40.0 * p.sd_force:
        return
    for axis in range(2):
        k = at.TILT + axis
        off = wrench[axis] - rest[axis] - state.mean[k] * step
        noise = 2.0 * p.sd_force * p.sd_force + 0.01 * norm(wrench[0], wrench[1]) ** 2
        total = step * step * state.variance[k] + noise
        if rest[2] > 0.0 and off * off < SIGMAS * SIGMAS * total:
            state.mean[k] += state.variance[k] * step * off / total
            state.variance[k] *= noise / total
    copy(wrench, rest)


@njit(error_model="numpy")
def _fall(state, p, first, last):
    """Number of the interval at whose end the load has fallen most, and still is one of a slip; -1: none."""
    found, largest, most = -1, 0.0, 0.0
    for i in range(first - 2, last - 1):
        a, b = state.intervals[(i - 1) % INTERVALS], state.intervals[i % INTERVALS]
        before, after = _size(state, a.wrench), _size(state, b.wrench)
        most = max(most, before / a.wrench[2])
        drop = before - after
        if drop > max(EVENT * before, 5.0 * p.sd_force, largest) and after > AT_LEAST * most * b.wrench[2]:
            found, largest = i, drop
    return found


@njit(error_model="numpy")
def _store_fall(state, p, wrench, slow, time):
    """Stores the load before a slip and the one (4,) after its fall, and fits."""
    store_break(state)
    new_entry(state, FALL, 1.0 - DOUBT, slow, wrench)
    state.slip_time += time
    fit(state, p)
    state.updates_mu_c += 1


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
    for i in range(first, last + 1):
        fastest = max(fastest, length(p, ring[i % INTERVALS].motion) / ring[i % INTERVALS].time)
    for j in range(3):
        axis, moved[j] = j if j < 2 else 3, 0.0
        for i in range(first, last + 1):
            moved[j] += ring[i % INTERVALS].motion[j]
        change[j] = (after.wrench[axis] - before.wrench[axis]) / (1.0 if j < 2 else rim * rim)
        work += moved[j] * (w.wrench[axis] - state.x[ZERO + j])
    least = SAFETY * state.spring * length(p, change) + 6.0 * state.noise * w.time
    if state.power == 0.0:  # the first motion says which way the wrench is taken
        state.sign = 1.0 if work > 0.0 else -1.0
    if work * state.sign > 0.0 and length(p, moved) > least:
        state.power += 0.1 * state.sign
        slow = math.exp(-((fastest / (3.0 * p.stribeck_velocity)) ** 2))
        _store_fall(state, p, w.wrench, slow, 2.0 * w.time)


@njit(error_model="numpy")
def learn_drop(state, p):
    """Takes a sudden fall of the load at the newest sample as a slip that begins, without a slip velocity.

    A push that ends looks the same, and so does a sudden stop of the wrist. So a fall counts only if the load
    over the normal force was about as large as any that held before, if it is no larger than mu_s over mu_c
    can be, and if the samples that are kept hold no other one. The torque, which is noisy, is left out.
    """
    state.quiet -= 1
    if state.in_a_row < 6 or state.quiet > 0:
        return
    w = matrix(3, 4)
    for i, back in enumerate((4, 1, 0)):  # before, while it falls, and when it has fallen
        for j in range(3):
            newer = state.wrenches[(state.samples - back) % SAMPLES, j]
            w[i, j] = 0.5 * (newer + state.wrenches[(state.samples - back - 1) % SAMPLES, j])
        w[i, 3] = state.x[TORQUE]
    before, after, noise = _size(state, w[0]), _size(state, w[2]), 5.0 * p.sd_force
    fell = before - max(_size(state, w[1]), after) > max(EVENT * before, noise)
    if fell and before > 0.85 * state.held * w[0, 2] and after > max(AT_LEAST * before, noise):
        state.quiet = SAMPLES
        copy(w[0], state.peak)
        _store_fall(state, p, w[2], 0.0, SAMPLES * state.elapsed)
    if w[0, 2] > 5.0 * p.eps_fn:
        state.held = max(state.held, before / w[0, 2])
