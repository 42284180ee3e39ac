"""Keeps the window: the stretch of slip that grows, and the ring of entries that the fit looks at.

Instants of about the same motion and normal force are one stretch, whose mean wrench belongs to its mean
velocity. So a count of the velocity sensor or a late sample says as little as it should, and any sampling
rate gives the same entries. The oldest entry makes room for a new one.
"""

import math

from estimator._numba.caching import njit
from estimator._numba.memory import matrix
from estimator.sample import norm
from estimator.window.change import fit
from estimator.window.layout import BREAK, EMPTY, ENTRIES, FALLS, GROWS, MU, SLIDE, STATES, ZERO, R
from estimator.window.spring import is_no_spring

LONGEST, EARLY, OFTEN = 0.2, 0.021, 0.096
"""Duration of a stretch [s], so that 24 are some seconds of slip; its first fit, and their interval."""
SINGLE = 0.1  # Probability that a single instant is none of a slip: a velocity that came late
EVEN = 1.0 / 12.0  # Variance of a velocity that changes anywhere in an interval, over its squared change
STRAIGHT, ALIKE = 0.93, 0.12
"""Cosine between motions of one stretch (22 deg), and relative difference of their forces."""


@njit(error_model="numpy")
def length(p, motion):
    """Length of a motion (3,), with the angle times half the pad's radius [m]."""
    return norm(norm(motion[0], motion[1]), 0.5 * p.r_max * motion[2])


@njit(error_model="numpy")
def refer(state, f_n):
    """Moves the reference of ln mu_c and ln r to a normal force [N], with their covariance."""
    step = math.log(f_n) - state.reference
    state.reference += step
    if state.entries[0].kind == EMPTY:
        return
    x, c = state.x, state.covariance
    x[MU] -= x[FALLS] * step
    x[R] += x[GROWS] * step
    for i in range(ENTRIES):
        state.entries[i].load -= step
    for j in range(STATES):
        c[MU, j] -= step * c[FALLS, j]
        c[R, j] += step * c[GROWS, j]
    c[MU, MU] -= step * c[MU, FALLS]
    c[R, R] += step * c[R, GROWS]
    c[MU, R] += step * c[MU, GROWS]
    c[R, MU] = c[MU, R]
    for j in range(STATES):
        c[j, MU], c[j, R] = c[MU, j], c[R, j]


@njit(error_model="numpy")
def new_entry(state, p, kind, slides, wrench):
    """Writes a wrench (4,) into the next entry, the reference being its normal force; returns the entry."""
    refer(state, wrench[2])
    s = state.entries[state.entry % ENTRIES]
    state.entry += 1
    s.kind, s.end, s.slides, s.load = kind, state.slip_time, slides, 0.0
    s.wrench[:] = wrench
    s.slow, s.unknown = 0.0, 0.0
    s.var_force, s.var_torque = p.sd_force * p.sd_force, p.sd_torque * p.sd_torque
    return s


@njit(error_model="numpy")
def store_break(state, p):
    """Stores the largest load before the present slip, once."""
    if state.peak[2] > 0.0:
        new_entry(state, p, BREAK, 1.0, state.peak)
        state.peak[2] = 0.0
        state.events_mu_s += 1


@njit(error_model="numpy")
def _store(state, p):
    """Stores the stretch that grows, in place of what it was before, and fits; unless it may be a spring."""
    c, wrench = state.stretch, matrix(1, 4)[0]
    for j in range(4):
        wrench[j] = c.wrench[j] / c.time
    slides = min(is_no_spring(state, p, length(p, c.motion)), 1.0 - SINGLE / (c.instants * c.instants))
    if not (wrench[2] > p.eps_fn and c.work * state.sign > 0.0 and slides > 0.1):
        return
    if state.stored > 0.0:
        state.entry -= 1
    else:
        store_break(state, p)
    s = new_entry(state, p, SLIDE, slides, wrench)
    s.time, s.slow, s.unknown = c.time, c.slow / c.time, c.unknown / c.time
    for j in range(3):
        s.motion[j] = c.motion[j] / c.time
    count = p.resolution / c.time
    s.var_speed = 0.25 * count * count + 0.6 * state.noise * state.noise * state.elapsed / c.time
    s.var_speed += EVEN * c.scatter / (c.instants * c.instants)
    s.var_spin = 1.5 * s.var_speed / (p.r_max * p.r_max)
    s.var_force *= 1.5 / c.count + 0.16
    s.var_torque *= 1.5 / c.count
    state.stored, state.learned = c.instants, True
    fit(state, p)
    state.updates_mu_c += 1
    spin = abs(s.motion[2])
    if spin > 2.0 * math.sqrt(s.var_spin) and norm(s.motion[0], s.motion[1]) < 5.0 * p.r_max * spin:
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
        c.slow, c.unknown, c.scatter = 0.0, 0.0, 0.0
        state.stored = 0.0


@njit(error_model="numpy")
def _goes_on(p, c, time, motion, wrench):
    """Whether a motion (3,) in a time [s] under a wrench (4,) belongs to the stretch c."""
    rim = 0.5 * p.r_max
    dot = c.motion[0] * motion[0] + c.motion[1] * motion[1] + rim * rim * c.motion[2] * motion[2]
    straight = dot > STRAIGHT * length(p, c.motion) * length(p, motion)
    size = norm(wrench[0], wrench[1])
    alike = abs(c.wrench[2] / c.time - wrench[2]) < ALIKE * wrench[2] + 0.1
    alike &= abs(norm(c.wrench[0], c.wrench[1]) / c.time - size) < ALIKE * size + 0.1
    return straight and alike and c.time + time < 1.01 * LONGEST


@njit(error_model="numpy")
def add_instant(state, p, before, after):
    """Takes the instant between two intervals of a slip: the wrench there, the mean of both velocities."""
    c, time, x, motion = state.stretch, before.time, state.x, matrix(1, 3)[0]
    change = matrix(1, 3)[0]
    for j in range(3):
        change[j] = after.motion[j] / after.time - before.motion[j] / time
        motion[j] = time / (time + after.time) * (before.motion[j] + after.motion[j])
    if c.time > 0.0 and not _goes_on(p, c, time, motion, before.wrench):
        end_stretch(state, p)
    was = c.time
    c.time += time
    c.count += before.count
    c.instants += 1.0
    c.scatter += length(p, change) ** 2
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
    c.unknown += time * 2.0 * slow * math.exp(-slow)
    state.power = 0.98 * state.power + work / (before.wrench[2] * length(p, motion))
    state.sign = 1.0 if state.power > 0.0 else -1.0
    if was < EARLY <= c.time or int(was / OFTEN) < int(c.time / OFTEN):
        _store(state, p)
