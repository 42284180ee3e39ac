"""Separates slips from springs of the pad: how far the object moved, how far a pad can spring."""

import math

from estimator._numba.caching import njit
from estimator.augmented.holding import SAFETY, least_radius, may_slide
from estimator.augmented.timing import LAST
from estimator.augmented.torsion import torsion_radius

MARGIN = 4
"""Velocities in a row that moved: two about an instant, one on either side; one more if repeated."""

RECENT = 3
"""Newest samples whose displacement must exceed what the pad springs: it swings on after a slip has ended."""

BEFORE = 8
"""Samples before a motion whose forces count: the velocity is late."""

RANGE = 3.0
"""Range of some samples of noise, over its standard deviation."""


@njit(error_model="numpy")
def _range(p, j, change, r):
    """Range of force j less that of noise, or of the torque over r: what can have sprung the pad [N]."""
    return max(change - RANGE * p.sd_force, 0.0) if j < 2 else change / r


@njit(error_model="numpy")
def _radius(state, p):
    """Radius by which torque and rotation are compared with force and displacement [m]."""
    return least_radius(state) if p.soft_torsion else torsion_radius(state, p)


@njit(error_model="numpy")
def shear(state, p, moves, elapsed):
    """Compares how far the object has moved with how far the pad can have sprung.

    The pad's spring moves the object by its compliance times the change of the force, and no further: less
    than that times the range of the forces since shortly before the motion. How soft it is, it shows when it
    springs back: friction never moves an object against itself.
    """
    k = state.samples
    state.moved = state.moved + 1 if moves else 0
    if not moves:
        state.beyond = 0
        return
    oldest = k
    if state.moved == 1:
        oldest = k - min(state.in_a_row - 1, BEFORE)
        for j in range(3):
            state.moved_by[j] = 0.0
            state.lowest[j], state.highest[j] = math.inf, -math.inf
            state.before[j] = state.wrenches[oldest & LAST, j if j < 2 else 3]
        state.repeated = 0
    twist, last = state.twists[k & LAST], state.twists[(k - 1) & LAST]
    if state.moved > 1 and twist[0] == last[0] and twist[1] == last[1] and twist[2] == last[2]:
        state.repeated = 1
    r, square, spring, power = _radius(state, p), 0.0, 0.0, 0.0
    for j in range(3):
        state.moved_by[j] += twist[j] * elapsed
        axis = j if j < 2 else 3
        for i in range(oldest, k + 1):
            value = state.wrenches[i & LAST, axis]
            state.lowest[j] = min(state.lowest[j], value)
            state.highest[j] = max(state.highest[j], value)
        scale = 1.0 if j < 2 else r
        square += (state.moved_by[j] * scale) ** 2
        power += state.moved_by[j] * (state.lowest[j] + state.highest[j])
        spring += _range(p, j, state.highest[j] - state.lowest[j], r) ** 2
    beyond = square > state.spring * state.spring * spring and state.in_a_row >= MARGIN
    if beyond and (power * state.sign < 0.0 or not state.signed):
        if square > p.compliance_max * p.compliance_max * spring:  # no pad springs so far
            _direct(state, p, power)
        else:
            if state.signed:  # against the force: it springs back
                state.spring = min(SAFETY * math.sqrt(square / max(spring, 1e-9)), p.compliance_max)
            beyond = False
    slips = beyond and _goes_on(state, p, r, elapsed, spring) and may_slide(state, p)
    state.beyond = state.beyond + 1 if slips else 0


@njit(error_model="numpy")
def _goes_on(state, p, r, elapsed, longest):
    """Whether the newest samples alone are further than the pad springs by the forces since shortly before.

    Otherwise the slip has ended and the object swings on the pad. Where it swings back against the force, it
    shows how soft the pad is.

    Args:
        state: Changed in place.
        p: Parameters.
        r: Radius that makes torque and rotation comparable with force and displacement [m].
        elapsed: Time of a sample [s].
        longest: What `_spring` is for all forces since shortly before the motion, which is no less [N^2].
    """
    k, square, power = state.samples, 0.0, 0.0
    count = min(state.moved, RECENT)
    for j in range(3):
        scale, axis = (1.0, j) if j < 2 else (r, 3)
        moved, force = 0.0, 0.0
        for i in range(k - count + 1, k + 1):
            moved += state.twists[i & LAST, j] * elapsed
            force += state.wrenches[i & LAST, axis]
        square += (moved * scale) ** 2
        power += moved * force
    along = power * state.sign >= 0.0
    if along and square > state.spring * state.spring * longest:
        return True
    spring = _spring(state, p, r, min(count + BEFORE, state.in_a_row))
    if square <= state.spring * state.spring * spring:
        return False
    if not along and square <= p.compliance_max * p.compliance_max * spring:
        state.spring = min(SAFETY * math.sqrt(square / max(spring, 1e-9)), p.compliance_max)
    return along


@njit(error_model="numpy")
def _spring(state, p, r, count):
    """Squared range of the newest forces, less that of noise: what can have sprung the pad [N^2]."""
    k, spring = state.samples, 0.0
    for j in range(3):
        axis = j if j < 2 else 3
        lowest, highest = math.inf, -math.inf
        for i in range(k - count + 1, k + 1):
            value = state.wrenches[i & LAST, axis]
            lowest, highest = min(lowest, value), max(highest, value)
        spring += _range(p, j, highest - lowest, r) ** 2
    return spring


@njit(error_model="numpy")
def _direct(state, p, power):
    """Takes the sign of the power of a slip as that of the wrench."""
    sign = 1.0 if power > 0.0 else -1.0
    if sign != state.sign:
        state.products[:] = 0.0
    state.sign, state.signed = sign, True


@njit(error_model="numpy")
def settle(state, p):
    """After a motion: what it has left, and the change of the load does not explain, was a slip."""
    k, r, power, square, spring = state.samples, _radius(state, p), 0.0, 0.0, 0.0
    for j in range(3):
        scale, axis = (1.0, j) if j < 2 else (r, 3)
        now = 0.5 * (state.wrenches[k & LAST, axis] + state.wrenches[(k - 1) & LAST, axis])
        square += (state.moved_by[j] * scale) ** 2
        power += state.moved_by[j] * (now + state.before[j])
        spring += _range(p, j, abs(now - state.before[j]), r) ** 2
    least = p.compliance_max * math.sqrt(spring) + RANGE * p.sd_speed * p.sample_time
    if square > least * least and state.in_a_row > LAST:
        _direct(state, p, power)
