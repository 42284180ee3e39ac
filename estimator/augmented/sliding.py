"""Learns from a slide for "adaptive": keeps the samples, finds the instants, tests for jumps."""

import math

import numpy as np

from estimator._numba.caching import njit
from estimator.augmented.change import follow, test_for_jump, widen
from estimator.augmented.filtering import learn
from estimator.augmented.holding import least_friction, least_radius
from estimator.augmented.law_error import twist_scatter
from estimator.augmented.likelihood_ratio import decide, suspect
from estimator.augmented.load import BAND, beside, limit, move
from estimator.augmented.model_error import count_slip
from estimator.augmented.pad_spring import MARGIN, shear
from estimator.augmented.slip_law import COP, MILLIMETRE, MU, SHAPE, TILT, ZERO, R
from estimator.augmented.state import restart
from estimator.augmented.stribeck import ALIKE
from estimator.augmented.timing import LAST, correlate
from estimator.augmented.torsion import learn_torsion
from estimator.limit_surface.inverse import load_size
from estimator.sample import norm

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

TURNED = 30.0
"""The same, over its variance by the error of the law: larger, as no mean of twists lessens that."""

EVEN = 1.0 / 12.0
"""Variance of an even distribution, over its squared width."""

BACK = 3
"""Samples before an instant among which ..."""
GRIPPED = 1.5
"""... the normal force may have grown by this factor: the object brakes faster than the velocity is read."""
FADES = 0.02
"""Weight of a sample in the memory that r was at a bound."""
KEPT = 0.5
"""Smallest ratio of forces after that, over the one before, of an object that slides on."""


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
    shear(state, p, moves, elapsed)
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
def _before_grip(state, p, i):
    """Number of the sample before the grip was closed within the samples about i; -1 if it was not."""
    before = max(i - BACK, state.samples - state.in_a_row + 1)
    closed = max(state.wrenches[i & LAST, 2], state.wrenches[(i + 1) & LAST, 2])
    return before if closed > GRIPPED * state.wrenches[before & LAST, 2] + BAND * p.sd_normal else -1


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
    part, last = EVEN, _before_grip(state, p, i) if p.grip_noise else -1
    if last >= 0:  # it brakes within a sample, and the instant may be one before or after
        w, newest, part = state.wrenches[last & LAST], state.twists[k & LAST], 1.0
        d_x, d_y, d_omega = newest[0] - before[0], newest[1] - before[1], newest[2] - before[2]
        f_before = norm(w[0] - x[ZERO] - w[2] * x[TILT], w[1] - x[ZERO + 1] - w[2] * x[TILT + 1])
        load_before = load_size(True, f_before, abs(w[3]) / least_radius(state))
        if not load * w[2] > KEPT * load_before * f_n:  # it has stopped already
            return False
    of_speed = 0.5 * p.sd_speed * p.sd_speed + part * (d_x * d_x + d_y * d_y)
    of_spin = 0.5 * p.sd_spin * p.sd_spin + part * d_omega * d_omega
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
    scatter = twist_scatter(state, p, square, twist[2])
    scattered = state.law_square * scatter[0]
    noisy = NEAR * of_speed + TURNED * scattered
    of_speed += scattered
    of_spin += state.law_square * scatter[1]
    fresh *= noisy / (noisy + square)
    walk = p.drift * p.drift
    widen(state, walk, p.sd_log_mu_c0**2)
    state.covariance[R, R] += max(min(walk, p.sd_log_r0**2 - state.covariance[R, R]), 0.0)
    for j in range(ZERO, SHAPE):
        state.covariance[j, j] += (p.error_drift * state.x[j]) ** 2
    move(state, beside(state, p, i))
    if begins:
        suspect(state, p)
    value, variance = state.x[MU], state.covariance[MU, MU]
    learned, squared, score, variance_mu = learn(
        state, p, state.sign, wrench, twist, of_speed, of_spin, scatter, fresh
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
    bounded = state.limits[2] < state.x[R] < state.limits[3]
    state.at_bound = (1.0 - FADES) * state.at_bound if bounded else 1.0
    state.misfit += 0.05 * (min(squared, p.outlier) / 3.0 - state.misfit)
    if state.updates_mu_c > 10:
        test_for_jump(state, p, score)
        if decide(state, p):
            limit(state, p)
    return True
