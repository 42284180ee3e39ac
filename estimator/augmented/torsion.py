"""Finds how soft a pad is in torsion: the angle of a spring is proportional to its moment.

In torsion a pad springs by its compliance over r^2, and r is not known at first. A pad counts as stiff until
it has shown otherwise: the torque has grown along a turn, in proportion to the angle, with no residual beyond
its noise. Friction does not do that: a slip keeps its torque, or changes it with the normal force, and so the
torque that friction at the start would have is subtracted. A stick without a turn, followed by a slip, leaves
a residual. A slide in which the share of the turn grows has a displacement, too. What was learned from slides
before that is forgotten, as turns of the spring were among them, unless one of them was a slip for certain:
longer than twice what a pad springs by the whole load, with the smallest r that is plausible.
"""

import math

from estimator._numba.caching import njit
from estimator.augmented.holding import LOWEST
from estimator.augmented.model_error import forget_slips
from estimator.augmented.slip_law import MU, STATES, R
from estimator.augmented.timing import LAST
from estimator.sample import norm

EVIDENT = 8.0
"""Deviations of the noise by which the torque must have grown with the angle."""
STRAIGHT, BENT = 0.3, 0.1
"""Variance that a line leaves beyond the noise, over that which it explains: less shows a spring, more shows
that there was a slip, each beyond what the noise makes by chance."""
CHANCE = 3.0
"""Deviations of such a residual."""
ENOUGH = 24
"""Samples from which the residual says something."""
EVERY = 8
"""Samples between two looks at the regression."""
SAFETY = 1.5
"""Compliance that is assumed, over that which a turn shows."""
GROWTH = 0.5
"""Growth of the torque over that which friction at the start explains."""
LEVER = 0.25
"""Largest displacement during a turn, over the angle and the pad's radius."""
START = 4
"""Samples whose mean is the load at the start."""
HUGE = 1e100
"""Sums of squares beyond it are forgotten."""
RATIO, COUNT, ANGLE, X, Y, FAR, GROWN, STEPS, SUMS = 0, 1, 2, 3, 4, 5, 6, 7, 8
"""Index in `state.turn` of: torque over normal force at the start [m]; samples since then, angle [rad],
displacement (2) and its largest size [m]; growth of the torque [N m] and the sum of its squared steps; sums
of angle and growth and of their products (5)."""
TURN = SUMS + 5
"""Length of `state.turn`."""


@njit(error_model="numpy")
def _begin(state):
    """Starts the regression at the newest sample."""
    turn, tau, f_n = state.turn, 0.0, 0.0
    turn[:] = 0.0
    for i in range(state.samples - min(START, state.in_a_row) + 1, state.samples + 1):
        w = state.wrenches[i & LAST]
        tau, f_n = tau + w[3], f_n + w[2]
    turn[RATIO] = tau / f_n


@njit(error_model="numpy")
def learn_torsion(state, p, twist, elapsed):
    """Takes angle and torque of the newest sample into their regression, and looks at it now and then.

    Args:
        state: Changed in place: `turn` and, where the pad has shown its spring, `torsion`.
        p: Parameters.
        twist: v_x, v_y, omega [m/s, m/s, rad/s].
        elapsed: Time of a sample [s].
    """
    turn, w = state.turn, state.wrenches[state.samples & LAST]
    sums = turn[SUMS:]
    if state.in_a_row == 1 or not sums[2] + sums[4] < HUGE:
        _begin(state)
    turn[ANGLE] += twist[2] * elapsed
    turn[X] += twist[0] * elapsed
    turn[Y] += twist[1] * elapsed
    turn[FAR] = max(turn[FAR], norm(turn[X], turn[Y]))
    by_friction = turn[RATIO] * w[2]
    angle, growth = turn[ANGLE], w[3] - by_friction
    if turn[COUNT] > 0.0:
        turn[STEPS] += (growth - turn[GROWN]) ** 2
    turn[GROWN] = growth
    turn[COUNT] += 1.0
    sums[0] += angle
    sums[1] += growth
    sums[2] += angle * angle
    sums[3] += angle * growth
    sums[4] += growth * growth
    if state.samples % EVERY == 0 and turn[COUNT] >= ENOUGH:
        _look(state, p, abs(growth) > GROWTH * abs(by_friction))


@njit(error_model="numpy")
def _look(state, p, grown):
    """Whether the torque is proportional to the angle: then the pad springs so far. If not, starts anew.

    Args:
        state: Changed in place.
        p: Parameters.
        grown: Whether the torque has grown by more than friction explains.
    """
    turn = state.turn
    n, sums = turn[COUNT], turn[SUMS:]
    square = max(sums[2] - sums[0] * sums[0] / n, 1e-12)
    product = sums[3] - sums[0] * sums[1] / n
    explained = product * product / square
    noise = max(0.5 * turn[STEPS] / (n - 1.0), p.sd_torque * p.sd_torque)
    beyond = max(sums[4] - sums[1] * sums[1] / n - explained, 0.0) / (n - 2.0) - noise
    chance = CHANCE * noise * math.sqrt(2.0 / n)
    if beyond - chance > BENT * explained / n:
        _begin(state)
        return
    along = state.sign * product > 0.0 and explained > EVIDENT * EVIDENT * noise
    straight = beyond + chance < STRAIGHT * explained / n
    turned = turn[FAR] < LEVER * p.r_max * abs(turn[ANGLE])
    shown, least = square / max(abs(product), 1e-12), p.r0 * math.exp(-LOWEST * p.sd_log_r0)
    possible = shown < SAFETY * p.compliance_max / (least * least)
    if not (along and straight and turned and grown and possible):
        return
    if state.torsion == 0.0 and state.slides > 0 and not state.certain:
        _forget(state, p)
    state.torsion = SAFETY * shown


@njit(error_model="numpy")
def _forget(state, p):
    """Forgets mu_c, r and mu_s, which were learned from turns of the spring.

    Args:
        state: Changed in place.
        p: Parameters.
    """
    x, covariance = state.x, state.covariance
    x[MU], x[R] = math.log(p.mu_c0), math.log(p.r0)
    for j in range(STATES):
        covariance[MU, j], covariance[R, j] = 0.0, 0.0
        covariance[j, MU], covariance[j, R] = 0.0, 0.0
    covariance[MU, MU], covariance[R, R] = p.sd_log_mu_c0**2, p.sd_log_r0**2
    state.mu_c, state.r, state.mu_s = p.mu_c0, p.r0, p.mu_s0
    state.sd_mu_c, state.sd_r, state.sd_mu_s = p.mu_c0, p.r0, p.mu_s0
    state.sd_lever = math.sqrt(2.0) * p.mu_c0 * p.r0
    state.misfit, state.shared = 1.0, 0.0
    forget_slips(state)
    state.confidence_mu_c, state.confidence_r, state.confidence_mu_s = 0.0, 0.0, 0.0
    state.updates_mu_c, state.updates_r, state.events_mu_s, state.slides = 0, 0, 0, 0


@njit(error_model="numpy")
def torsion_radius(state, p):
    """Radius [m] by which the compliance in shear, `state.spring`, is that in torsion."""
    r = max(state.r, 0.5 * p.r_max)
    return min(r, math.sqrt(state.spring / state.torsion)) if state.torsion > 0.0 else r
