"""Keeps the window: the stretch of slip that grows, and the ring of entries that the fit looks at.

Instants of about the same motion and normal force are one stretch, whose mean wrench belongs to its mean
velocity. So a count of the velocity sensor or a late sample says as little as it should, and any sampling
rate gives the same entries. The oldest entry makes room for a new one.
"""

import math

from estimator._numba.caching import njit
from estimator._numba.memory import matrix
from estimator.sample import copy, norm
from estimator.window.change import fit
from estimator.window.layout import BREAK, ENTRIES, SLIDE, ZERO, R
from estimator.window.spring import is_no_spring, length

LONGEST = 0.2  # Duration of a stretch [s], so that 24 are some seconds of slip
DOUBT = 0.1  # Probability that what looks like a slip in one instant is none: a velocity that came late
ALIKE = 0.12  # Relative difference of forces in one stretch; 1 minus the cosine between its motions (28 deg)


@njit(error_model="numpy")
def new_entry(state, kind, slides, slow, wrench):
    """Writes a wrench (4,) into the next entry; the first one's normal force is the reference."""
    if state.entry == 0 and state.fits == 0:
        state.reference = math.log(wrench[2])
    s = state.entries[state.entry % ENTRIES]
    state.entry += 1
    s.kind, s.end, s.slides, s.load = kind, state.slip_time, slides, math.log(wrench[2]) - state.reference
    copy(wrench, s.wrench)
    s.slow, s.noise = slow, 1.0
    return s


@njit(error_model="numpy")
def store_break(state):
    """Stores the largest load before the present slip, once."""
    if state.peak[2] > 0.0:
        new_entry(state, BREAK, 1.0, 1.0, state.peak)
        state.peak[2] = 0.0
        state.events_mu_s += 1


@njit(error_model="numpy")
def _store(state, p):
    """Stores the stretch that grows, in place of what it was before, and fits; unless it may be a spring."""
    c, wrench = state.stretch, matrix(1, 4)[0]
    for j in range(4):
        wrench[j] = c.wrench[j] / c.time
    slides = min(is_no_spring(state, p, length(p, c.motion)), 1.0 - DOUBT / (c.instants * c.instants))
    if not (wrench[2] > p.eps_fn and c.work * state.sign > 0.0 and slides > 0.1):
        return
    if state.stored > 0.0:
        state.entry -= 1
    else:
        store_break(state)
    s = new_entry(state, SLIDE, slides, c.slow / c.time, wrench)
    s.time = c.time
    for j in range(3):
        s.motion[j] = c.motion[j] / c.time
    count = p.resolution / c.time
    s.var_speed = 0.25 * count * count + 0.6 * state.noise * state.noise * state.elapsed / c.time
    s.noise = 1.5 / c.count
    state.stored, state.learned = c.instants, True
    fit(state, p)
    state.updates_mu_c += 1
    spin = p.r_max * abs(s.motion[2])
    if spin > 2.5 * math.sqrt(s.var_speed) and norm(s.motion[0], s.motion[1]) < 5.0 * spin:
        state.updates_r += 1


@njit(error_model="numpy")
def end_stretch(state, p):
    """Stores the stretch that grows, and begins another one."""
    c = state.stretch
    if c.time > 0.0:
        if c.instants > state.stored:
            _store(state, p)
        c.motion[:] = 0.0
        c.wrench[:] = 0.0
        c.time, c.count, c.instants, c.work = 0.0, 0.0, 0.0, 0.0
        c.slow, state.stored = 0.0, 0.0


@njit(error_model="numpy")
def _goes_on(p, c, time, motion, wrench):
    """Whether a motion (3,) in a time [s] under a wrench (4,) belongs to the stretch c."""
    rim = 0.5 * p.r_max
    dot = c.motion[0] * motion[0] + c.motion[1] * motion[1] + rim * rim * c.motion[2] * motion[2]
    straight = dot > (1.0 - ALIKE) * length(p, c.motion) * length(p, motion)
    size = norm(wrench[0], wrench[1])
    alike = abs(c.wrench[2] / c.time - wrench[2]) < ALIKE * wrench[2] + 0.1
    alike &= abs(norm(c.wrench[0], c.wrench[1]) / c.time - size) < ALIKE * size + 0.1
    return straight and alike and c.time + time < 1.01 * LONGEST


@njit(error_model="numpy")
def add_instant(state, p, before, after):
    """Takes the instant between two intervals of a slip: the wrench there, the mean of both velocities."""
    c, time, x, motion = state.stretch, before.time, state.x, matrix(1, 3)[0]
    for j in range(3):
        motion[j] = time / (time + after.time) * (before.motion[j] + after.motion[j])
    if c.time > 0.0 and not _goes_on(p, c, time, motion, before.wrench):
        end_stretch(state, p)
    c.time += time
    c.count += before.count
    c.instants += 1.0
    state.slip_time += time
    work = 0.0
    for j in range(3):
        c.motion[j] += motion[j]
        work += motion[j] * (before.wrench[j if j < 2 else 3] - x[ZERO + j])
    for j in range(4):
        c.wrench[j] += time * before.wrench[j]
    c.work += work
    rim = math.exp(x[R]) * motion[2]
    slow = (motion[0] * motion[0] + motion[1] * motion[1] + rim * rim) / (time * p.stribeck_velocity) ** 2
    c.slow += time * math.exp(-slow)
    state.power = 0.98 * state.power + work / (before.wrench[2] * length(p, motion))
    state.sign = 1.0 if state.power > 0.0 else -1.0
    if c.instants >= max(3.0, 4.0 * state.stored):
        _store(state, p)
