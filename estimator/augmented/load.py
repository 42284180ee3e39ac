"""Friction and radius of a pad of rubber depend on the normal force: the states are those at one force.

mu_c and mu_s fall with the normal force to the power n, r grows with it to the power b (`slip_law.FALLS`,
`slip_law.GROWS`). For a soft sphere b is between 0 and 1/3 (Xydas & Kao, Modeling of contact mechanics and
friction limit surfaces for soft fingers, IJRR 18(9), 1999); friction in proportion to the area of contact
gives n of 1/3, silicone on PLA 0.31. ln mu_c and ln r of the filter are those at the normal force
`state.load`, which follows the measured one. The step from one force to another is linear in the states, so
the covariance with the exponents carries their uncertainty to the new force, and back without a loss.
"""

import math

import numpy as np

from estimator._numba.caching import njit
from estimator._numba.memory import matrix
from estimator.augmented.likelihood_ratio import size_of_change
from estimator.augmented.scalar_update import correct
from estimator.augmented.slip_law import FALLS, GROWS, MU, STATES, R
from estimator.augmented.timing import LAST

BAND = 3.0
"""Deviations of the noise that the normal force must change before the states follow it."""
OF_THREE = 1.5**0.5
"""Deviation of a sample less the mean of two others, over that of a sample."""
MOST_FALL, MOST_GROWTH = 0.5, 1.0 / 3.0
"""Largest exponents of mu_c and of r."""
HEAVIER = 0.25
"""Change of the logarithm of the normal force from which a held load says something about the exponent."""


@njit(error_model="numpy")
def limit(state, p):
    """Keeps ln mu_c, ln r and the exponents in their bounds.

    An exponent beyond its bound moves there with the states that its covariance ties to it, as a measurement
    without noise would move them (D. Simon, Kalman filtering with state constraints, IET Control Theory &
    Applications 4(8), 2010, projection).

    Args:
        state: Record with `x`, `covariance`, `limits` and the hypothesis of a change; changed in place.
        p: Parameters.
    """
    x, limits = state.x, state.limits
    _project(state, p, FALLS, min(max(x[FALLS], limits[4]), limits[5]))
    _project(state, p, GROWS, min(max(x[GROWS], limits[6]), limits[7]))
    x[FALLS] = min(max(x[FALLS], limits[4]), limits[5])
    confine(x, limits)


@njit(error_model="numpy")
def confine(x, limits):
    """Keeps ln mu_c and ln r in their bounds."""
    x[MU] = min(max(x[MU], limits[0]), limits[1])
    x[R] = min(max(x[R], limits[2]), limits[3])


@njit(error_model="numpy")
def _project(state, p, j, bounded):
    """Moves state j to a value, and the others with it.

    As far as a suspected change of mu_c has moved the state beyond its bound, the response to it moves back,
    too.
    """
    x, covariance, response = state.x, state.covariance, state.response
    if bounded != x[j]:
        share = (bounded - x[j]) / covariance[j, j]
        explained = (bounded - x[j]) / (size_of_change(state, p)[0] * response[j])
        back = min(max(explained, 0.0), 1.0) if math.isfinite(explained) else 0.0
        back *= response[j] / covariance[j, j]
        for k in range(STATES):
            x[k] += share * covariance[j, k]
            response[k] -= back * covariance[j, k]
        x[j] = bounded


@njit(error_model="numpy")
def move(state, f_n):
    """Moves ln mu_c and ln r, with their covariance, to a normal force [N]; a start value stays.

    Args:
        state: Record with `x`, `covariance`, `response` and `load`; changed in place.
        f_n: Normal force > 0 [N].
    """
    step = math.log(f_n / state.load)
    fall = step if state.updates_mu_c > 0 else 0.0
    grow = step if state.updates_r > 0 else 0.0
    x, covariance = state.x, state.covariance
    x[MU] -= fall * x[FALLS]
    x[R] += grow * x[GROWS]
    state.response[MU] -= fall * state.response[FALLS]
    state.response[R] += grow * state.response[GROWS]
    mu, r, falls, grows = covariance[MU], covariance[R], covariance[FALLS], covariance[GROWS]
    for j in range(STATES):
        mu[j] -= fall * falls[j]
        r[j] += grow * grows[j]
    mu[MU] -= fall * mu[FALLS]
    mu[R] += grow * mu[GROWS]
    r[R] += grow * r[GROWS]
    r[MU] = mu[R]
    for j in range(R + 1, STATES):
        covariance[j, MU], covariance[j, R] = mu[j], r[j]
    state.load = f_n


@njit(error_model="numpy")
def at_load(state, p, f_n):
    """Moves the states to the normal force [N] of a measurement, if it is another one; whether it is."""
    if state.load == 0.0:
        state.load = f_n
    if abs(f_n - state.load) <= BAND * p.sd_normal or f_n < p.eps_fn:
        return False
    move(state, f_n)
    return True


@njit(error_model="numpy")
def beside(state, p, i):
    """Normal force [N] at sample i, by the samples before and after it unless it is clearly another one.

    The noise of the normal force, over it, is an error of the measured ln mu_c. A step to the noisy normal
    force has the same error, so that every sample would show an exponent of 1 (an error in the variable). The
    noise of the samples on either side is another one. Where the force changes faster than a straight line,
    by more than noise, that of the sample itself is exact enough.
    """
    f_n = np.float64(state.wrenches[i & LAST, 2])
    before, after = state.wrenches[(i - 1) & LAST, 2], state.wrenches[(i + 1) & LAST, 2]
    mean = 0.5 * (np.float64(before) + np.float64(after))
    return mean if abs(f_n - mean) <= BAND * OF_THREE * p.sd_normal else f_n


@njit(error_model="numpy")
def static_at_load(state, f_n):
    """mu_s of the last events at a normal force [N], and the variance of its logarithm by the exponent."""
    step = math.log(f_n / state.event_load)
    return state.event * math.exp(-state.x[FALLS] * step), step * step * state.covariance[FALLS, FALLS]


@njit(error_model="numpy")
def bound_exponent(state, p, f_t, f_n):
    """Narrows the exponent by a load that the contact holds at a larger normal force than that of the events.

    Static friction is at least what the contact holds. So the exponent exceeds its estimate by no more than
    the margin that is left, over the change of ln f_n. Its variance is at most that of an even distribution
    up to there, to which the uncertainty of the events adds.

    Args:
        state: Changed in place.
        p: Parameters.
        f_t: Tangential force that the contact holds [N].
        f_n: Normal force [N].
    """
    held = f_t - BAND * p.sd_force
    if state.events_mu_s == 0 or not held > 0.0 or f_n < state.event_load:
        return
    step = math.log(f_n / state.event_load)
    if step < HEAVIER:
        return
    expected = state.event * math.exp(-state.x[FALLS] * step)
    margin = max(math.log(expected * (f_n + BAND * p.sd_normal) / held), 0.0)
    square = margin * margin + state.variance_mu_s + state.common_mu_s
    variance = square / (3.0 * step * step)
    state.fall_error = min(state.fall_error, variance)
    _narrow(state.x, state.covariance, FALLS, variance)


@njit(error_model="numpy")
def forget_exponent(state, p):
    """Forgets what slips said of the exponent of mu_c; ln mu_c stays at the present normal force."""
    state.x[FALLS], state.fall_error = p.load_exponent0, p.sd_fall * p.sd_fall
    for j in range(STATES):
        state.covariance[FALLS, j] = state.covariance[j, FALLS] = 0.0
    state.covariance[FALLS, FALLS] = p.sd_load_exponent * p.sd_load_exponent


@njit(error_model="numpy")
def _narrow(x, covariance, j, variance):
    """Lowers the variance of state j, and what the others share with it; a larger one changes nothing."""
    before = covariance[j, j]
    if not variance < before:
        return
    crossed = matrix(1, STATES)[0]
    for k in range(STATES):
        crossed[k] = covariance[j, k]
    correct(x, covariance, crossed, (before - variance) / (before * before), 0.0)
