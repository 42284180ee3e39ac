"""Learns mu_c from slips that are too short for `estimator.augmented.sliding`, by the force alone.

An object that sticks carries its load. When it breaks away, friction falls to mu_c f_n at once, and the load
that is left over accelerates the object: as long as the force is off the load, it slides, and force over
normal force is mu_c. The fall is seen in the force itself, so the delay of the velocity does not matter: the
velocity only has to show, within the largest delay, that the object moved along the force, and, some samples
later, that it did not come back as far as the pad can spring.
"""

import math

from estimator._numba.caching import njit
from estimator._numba.memory import matrix
from estimator.augmented.change import follow
from estimator.augmented.filtering import MOST
from estimator.augmented.holding import least_friction
from estimator.augmented.likelihood_ratio import decide, respond_to_ratio, suspect
from estimator.augmented.load import beside, limit, move
from estimator.augmented.model_error import count_slip
from estimator.augmented.pad_spring import settle
from estimator.augmented.scalar_update import correct
from estimator.augmented.slip_law import COP, MILLIMETRE, MU, SIGMA, STATES, TILT, ZERO, R
from estimator.augmented.timing import EARLIEST, LAST, LATEST
from estimator.limit_surface.inverse import load_size
from estimator.sample import direction_cosines, norm

FALL = 0.08
"""Fall of the load between two samples, over the load, that is a break-away ..."""
NOISES = 4.0
"""... if it exceeds the noise of a force by as much, too."""
AT_LEAST = 0.5
"""Smallest ratio of forces after the fall, over the largest in the stick before it."""
WAIT = 4
"""Samples without motion until a slip has ended and the pad has come to rest."""
SHARP = 0.03
"""Relative deviation of mu_c from one sample."""
EXCESS = 0.35
"""What a slow slip still has of static friction, over mu_c: of 0.35 exp(-(v / SLOW)^2) nothing is known."""
SLOW = 3e-3
"""Speed [m/s]; twice the usual Stribeck velocity."""
MEAN_SPEED = 0.5
"""Speed after the fall over the largest of the slip: friction contains sigma_2 times the speed."""
TURNS = 0.1
"""Share of the torque in the squared load from which r is seen, too."""
BEYOND = 9.0
"""Squared normalised innovation from which noise is added."""


@njit(error_model="numpy")
def load_of(state, i):
    """Load (f_x, f_y, tau) at sample i without the errors that are known, its size [N] and that over f_n."""
    x, w = state.x, state.wrenches[i & LAST]
    f_n = w[2]
    f_x, f_y = w[0] - x[ZERO] - f_n * x[TILT], w[1] - x[ZERO + 1] - f_n * x[TILT + 1]
    tau = w[3] - MILLIMETRE * (x[COP] * f_y - x[COP + 1] * f_x)
    size = load_size(True, norm(f_x, f_y), abs(tau) / state.r)
    return f_x, f_y, tau, size, size / f_n


@njit(error_model="numpy")
def _break_away(state, p):
    """Number of the sample after the break-away that the velocity first shows at `state.first`; -1: none."""
    first = state.first
    found, largest, most = -1, 0.0, 0.0
    oldest = max(first - LATEST - 1, state.samples - LAST + 2, state.fallen + 2)
    for i in range(oldest, min(first - EARLIEST, state.samples) + 1):
        _, _, _, before, ratio_before = load_of(state, i - 1)
        most = max(most, ratio_before)
        _, _, _, after, ratio = load_of(state, i)
        fall = before - after
        if state.wrenches[i & LAST, 2] < p.eps_fn or not fall > max(FALL * before, NOISES * p.sd_force):
            continue
        least = max(AT_LEAST * most, least_friction(state, p, state.wrenches[i & LAST, 2]))
        if fall > largest and ratio > least:
            found, largest = i, fall
    return found


@njit(error_model="numpy")
def _take(state, p, i, speed):
    """Takes the ratio of forces at sample i as a measurement of mu_c, and of r where there is a torque.

    Args:
        state: Changed in place.
        p: Parameters.
        i: Number of the sample.
        speed: Largest scaled speed of the slip [m/s].

    Returns:
        The normalised innovation; NaN if nothing was learned.
    """
    f_x, f_y, tau, size, ratio = load_of(state, i)
    f_n, x, covariance = state.wrenches[i & LAST, 2], state.x, state.covariance
    move(state, beside(state, p, i))
    f_t = norm(f_x, f_y)
    share = direction_cosines(f_t, abs(tau) / state.r)[1] ** 2
    h, crossed = matrix(1, STATES)[0], matrix(1, STATES)[0]
    for j in range(STATES):
        h[j] = 0.0
    h[MU], h[R], h[SIGMA] = 1.0, share, MEAN_SPEED * speed / math.exp(x[MU])
    noise = (p.sd_normal / f_n) ** 2 + SHARP * SHARP + (share * p.sd_torque / (state.r * size)) ** 2
    noise += (p.sd_force / size) ** 2 + (EXCESS * math.exp(-((speed / SLOW) ** 2))) ** 2
    if f_t > 0.0:
        for axis, part in enumerate((f_x, f_y)):
            h[ZERO + axis] = (1.0 - share) * part / (f_t * f_t)
            h[TILT + axis] = f_n * h[ZERO + axis]
    variance = 0.0
    for j in range(STATES):
        crossed[j] = 0.0
        for k in range(STATES):
            crossed[j] += covariance[j, k] * h[k]
        variance += h[j] * crossed[j]
    innovation = math.log(ratio) - x[MU] - h[SIGMA] * x[SIGMA]
    square = innovation * innovation / (variance + noise)
    noise *= max(square / BEYOND, 1.0)
    gain = 1.0 / (variance + noise)
    for j in range(STATES):
        if not crossed[j] * crossed[j] * gain < MOST * covariance[j, j]:
            return math.nan
    suspect(state, p)
    respond_to_ratio(state, h, crossed, gain, innovation)
    value, before = x[MU], covariance[MU, MU]
    correct(x, covariance, crossed, gain, innovation)
    limit(state, p)
    follow(state, p, value, before)
    if decide(state, p):
        limit(state, p)
    score = innovation / math.sqrt(variance + noise)
    count_slip(state, True, score, variance + noise, share, 1.0)
    if state.updates_mu_c == 0:
        state.smooth[3] = f_n
    if share > TURNS:
        state.updates_r += 1
    return score


@njit(error_model="numpy")
def _stays(state, p, i):
    """Whether the object moved along the force of sample i, and further than the pad can spring."""
    f_x, f_y, tau, _, _ = load_of(state, i)
    k, r, power, square, spring = state.samples, state.r, 0.0, 0.0, 0.0
    for axis, force in enumerate((f_x, f_y, tau)):
        scale, at = (1.0, axis) if axis < 2 else (r, 3)
        motion = 0.0
        for n in range(state.first, k + 1):
            motion += state.twists[n & LAST, axis] * state.elapsed
        w = state.wrenches
        change = w[k & LAST, at] + w[(k - 1) & LAST, at] - w[(i - 1) & LAST, at] - w[(i - 2) & LAST, at]
        power += force * motion
        square += (scale * motion) ** 2
        spring += (0.5 * change / scale) ** 2
    least = NOISES * p.sd_speed * p.sample_time * math.sqrt(k + 1.0 - state.first)
    least += state.spring * math.sqrt(spring)
    return power * state.sign > 0.0 and square > least * least


@njit(error_model="numpy")
def learn_short_slip(state, p, moves):
    """Learns mu_c from a slip that ended some samples ago.

    Args:
        state: Changed in place; the newest sample is in its rings.
        p: Parameters.
        moves: Whether the newest velocity moved.

    Returns:
        The normalised innovation; NaN if nothing was learned.
    """
    if moves:
        state.quiet = 0
        if state.first < 0:
            state.first = state.samples
        return math.nan
    state.quiet += 1
    if state.quiet == WAIT:
        settle(state, p)
    if state.first < 0 or state.quiet < WAIT or not p.short_slips:
        return math.nan
    i = _break_away(state, p) if state.in_a_row > LAST else -1
    if i < 0 or not _stays(state, p, i):
        state.first = -1
        return math.nan
    speed = 0.0
    for k in range(state.first, state.samples):
        twist = state.twists[k & LAST]
        speed = max(speed, norm(norm(twist[0], twist[1]), state.r * twist[2]))
    state.first, state.fallen = -1, i
    return _take(state, p, i, speed)
