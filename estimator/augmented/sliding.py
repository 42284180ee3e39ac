"""What "adaptive" learns from a slide: keeps the samples, finds the instants, tests for jumps."""

import math

import numpy as np

from estimator._numba.caching import njit
from estimator.augmented.change import follow, test_for_jump, widen
from estimator.augmented.filtering import learn
from estimator.augmented.holding import SAFETY, least_friction, least_radius, may_slide
from estimator.augmented.load import beside, move
from estimator.augmented.model_error import count_slip
from estimator.augmented.slip_law import COP, MILLIMETRE, MU, SHAPE, TILT, ZERO, R
from estimator.augmented.state import restart
from estimator.augmented.timing import LAST, correlate
from estimator.augmented.torsion import learn_torsion, torsion_radius
from estimator.limit_surface.inverse import load_size
from estimator.sample import norm

MARGIN = 4
"""Velocities in a row that moved: two about an instant, one on either side; one more if repeated."""
SURE = 0.6
"""Correlation of a known delay, without jitter, from which the one before them may have been still, ..."""
WHOLE = 0.15
"""... if the delay is a whole number of samples but for this."""

SMOOTHING = 0.03
"""Weight of a sample in the mean twist and normal force at which the derivatives are taken."""
CHANGED = 8.0
"""Deviations from it beyond which a sample is rather a change, which the mean follows."""

LOAD_MAX, TWIST_MAX = 1e4, 1e3
"""No gripper sees so large a wrench [N, N m] or twist [m/s, rad/s]: nothing is learned from it."""

NEAR = 9.0
"""Squared speed, over the variance of a velocity, below which noise decides the direction of a slip."""

RECENT = 3
"""Newest samples whose displacement must exceed what the pad springs: it swings on after a slip has ended."""

BEFORE = 8
"""Samples before a motion whose forces count: the velocity is late."""

RANGE = 3.0
"""Range of some samples of noise, over its standard deviation."""

ALIKE = 10.0
"""Samples that share an error which is taken for noise."""


@njit(error_model="numpy")
def _range(p, j, change, r):
    """Range of force j less that of noise, or of the torque over r: what can have sprung the pad [N]."""
    return max(change - RANGE * p.sd_force, 0.0) if j < 2 else change / r


@njit(error_model="numpy")
def _radius(state, p):
    """Radius by which torque and rotation are compared with force and displacement [m]."""
    return least_radius(state) if p.soft_torsion else torsion_radius(state, p)


@njit(error_model="numpy")
def _shear(state, p, moves, elapsed):
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


@njit(error_model="numpy")
def store(state, p, wrench, twist, moves, elapsed):
    """Keeps the newest sample; finds the direction in which power flows, and the delay."""
    if state.samples >= 2 and elapsed > 1.5 * state.elapsed:  # a sample was lost
        state.in_a_row, state.moved, state.first = 0, 0, -1
        elapsed = state.elapsed
    k = state.samples
    for j in range(4):
        state.wrenches[k & LAST, j] = wrench[j]
    for j in range(3):
        state.twists[k & LAST, j] = twist[j]
    state.in_a_row += 1
    if p.torsion_from_turns:
        learn_torsion(state, p, twist, elapsed)
    _shear(state, p, moves, elapsed)
    delay = state.delay
    correlate(state, p)
    if abs(state.delay - delay) > 1 and state.slides > 0:
        restart(state, p)


@njit(error_model="numpy")
def margin(state):
    """Velocities in a row that must have moved."""
    certain = state.timing > SURE and abs(state.offset) < WHOLE
    return MARGIN + state.repeated - (1 if certain else 0)


@njit(error_model="numpy")
def _follow(state, p, twist, f_n, begins):
    """Moves the mean twist and normal force to the newest at the start of a slide and at a change.

    The derivatives are taken there: with those at the noisy sample itself, whose noise is also in the
    innovation, each sample would pull along the combinations of states that the motion does not show.

    Returns:
        How little the mean twist is a mean, in [0, 1]: 1 at the start of a slide or after a change.
    """
    noise = p.sd_speed, p.sd_speed, p.sd_spin, p.sd_normal
    newest = twist[0], twist[1], twist[2], f_n
    fresh = 1.0 if begins else 1.0 / (1.0 + state.slip_samples)
    for j in range(4):
        change = newest[j] - state.smooth[j]
        square = change * change
        beyond = square / (square + (CHANGED * noise[j]) ** 2)
        if begins:
            state.smooth[j] = newest[j]
        elif math.isfinite(square):
            state.smooth[j] += beyond * beyond * change
            if j < 3:
                fresh = max(fresh, beyond * beyond)
    return fresh


@njit(error_model="numpy")
def slide(state, p):
    """Learns from the newest instant around which the contact slid; whether it did."""
    k = state.samples
    i = k - 2 - state.delay
    needed = margin(state)
    if state.moved < needed or state.beyond < 2 or state.in_a_row < state.delay + 4:
        return False
    row, before, after = state.wrenches[i & LAST], state.twists[(k - 2) & LAST], state.twists[(k - 1) & LAST]
    wrench = np.float64(row[0]), np.float64(row[1]), np.float64(row[2]), np.float64(row[3])
    twist = 0.5 * (before[0] + after[0]), 0.5 * (before[1] + after[1]), 0.5 * (before[2] + after[2])
    d_x, d_y, d_omega = after[0] - before[0], after[1] - before[1], after[2] - before[2]
    largest = max(abs(wrench[0]), abs(wrench[1]), abs(wrench[2]), abs(wrench[3]))
    if not (largest < LOAD_MAX and abs(twist[0]) + abs(twist[1]) + abs(twist[2]) < TWIST_MAX):
        return False
    x, f_n = state.x, wrench[2]
    f_t = norm(wrench[0] - x[ZERO] - f_n * x[TILT], wrench[1] - x[ZERO + 1] - f_n * x[TILT + 1])
    load = load_size(True, f_t, abs(wrench[3]) / least_radius(state))
    if not load > f_n * least_friction(state, p, f_n):  # it sticks: the velocity is one of another instant
        return False
    of_speed = 0.5 * p.sd_speed * p.sd_speed + (d_x * d_x + d_y * d_y) / 12.0
    of_spin = 0.5 * p.sd_spin * p.sd_spin + d_omega * d_omega / 12.0
    begins = state.slid != k - 1
    fresh = _follow(state, p, twist, wrench[2], begins)
    state.slid = k
    # close to the pivot an error of the CoP turns the direction of the slip: not linear, so taken for noise
    lever = (MILLIMETRE * p.sd_cop * twist[2]) ** 2 + p.sd_speed * p.sd_speed
    square = twist[0] * twist[0] + twist[1] * twist[1]
    if math.isfinite(lever + square):
        state.leverage += 0.05 * (lever / (lever + square) - state.leverage)
    unknown = 0.5 * (state.covariance[COP, COP] + state.covariance[COP + 1, COP + 1])
    unknown *= (MILLIMETRE * twist[2] / p.caution) ** 2
    of_speed += ALIKE * unknown * min(unknown / (square + p.sd_speed * p.sd_speed), 1.0) ** 2
    noisy = NEAR * of_speed
    fresh *= noisy / (noisy + square)
    walk = p.drift * p.drift
    widen(state, walk, p.sd_log_mu_c0**2)
    state.covariance[R, R] += max(min(walk, p.sd_log_r0**2 - state.covariance[R, R]), 0.0)
    for j in range(ZERO, SHAPE):
        state.covariance[j, j] += (p.error_drift * state.x[j]) ** 2
    move(state, beside(state, p, i))
    value, variance = state.x[MU], state.covariance[MU, MU]
    learned, squared, score, variance_mu = learn(
        state, p, state.sign, wrench, twist, of_speed, of_spin, fresh
    )
    for j in range(3):
        state.smooth[j] += SMOOTHING * (twist[j] - state.smooth[j])
    state.smooth[3] += SMOOTHING * (wrench[2] - state.smooth[3])
    if not learned:
        return False
    follow(state, p, value, variance)
    rim = (state.r * twist[2]) ** 2
    count_slip(state, begins, score, variance_mu, rim, max(rim + square, 1e-150))
    state.slides += 1
    state.first = -1
    state.misfit += 0.05 * (min(squared, p.outlier) / 3.0 - state.misfit)
    if state.updates_mu_c > 10:
        test_for_jump(state, p, score)
    return True
