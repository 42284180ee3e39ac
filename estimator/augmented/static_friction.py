"""Static friction from break-aways and from stick, with its deviation; the rule mu_s >= mu_c.

The largest load over f_n in a stick that ends in a slip is a measurement of mu_s whose variance is known:
noise of the forces, the uncertain radius under torque and the ramp between two samples. A scalar filter
averages such events; an event that contradicts the average beyond its deviation, and a stick that carries
clearly more than mu_s f_n, start it afresh. Errors that are common to all events (zero, tilt), their
disagreement and the doubt whether they were slips are added to the stated deviation.
"""

import math

import numpy as np

from estimator._numba.caching import njit
from estimator.augmented.holding import longer_than_springs
from estimator.augmented.load import static_at_load
from estimator.augmented.model_error import doubt_of
from estimator.augmented.short_slips import load_of
from estimator.augmented.slip_law import TILT, ZERO, R
from estimator.augmented.timing import LAST
from estimator.limit_surface.inverse import load_size
from estimator.sample import direction_cosines
from estimator.stick_slip import SCATTER_GAIN, append, clear_buffer, take_event, transition

SAMPLING = 0.03
"""Relative deviation of an event: the load rises between samples, and the largest of noisy values counts."""
HELD = 5
"""Samples in a row that must carry more than the static limit to refute it."""
SURE = 2.0
"""Deviations of what the sensors may be off between two loads, which must not explain it."""
LEFT = 0.2
"""Fraction of a variance that is left above a bound of one deviation: truncated normal distribution."""


@njit(error_model="numpy")
def _of_radius(state, torque_share):
    """Variance of the logarithm of a load by the uncertain radius.

    The share of the torque grows as r falls. So it is the change of the load for an r that is one deviation
    smaller: the derivative by ln r, at an r that is too large, is that of a load without a torque.

    Args:
        state: Record with `covariance`.
        torque_share: Fraction of the squared load that is torque.
    """
    change = 0.5 * math.log1p(torque_share * math.expm1(2.0 * math.sqrt(state.covariance[R, R])))
    return change * change


@njit(error_model="numpy")
def _disagree(state, excess):
    """Takes what noise does not explain of a squared change of ln mu_s into the scatter of the events.

    The variance that is expected before any, `sd_slip` squared, counts as one event.
    """
    weight = max(1.0 / (state.events_mu_s + 1.0), SCATTER_GAIN)
    state.scatter_mu_s += weight * (excess - state.scatter_mu_s)


@njit(error_model="numpy")
def _event(state, p, value, f_n, torque_share):
    """Takes one measured mu_s into the average.

    Args:
        state: Changed in place.
        p: Parameters.
        value: Largest load over f_n of a stick.
        f_n: Normal force there [N].
        torque_share: Fraction of the squared load that is torque.
    """
    noise = (p.sd_normal / f_n) ** 2 + (p.sd_force / (value * f_n)) ** 2 + SAMPLING * SAMPLING
    noise += _of_radius(state, torque_share)
    present, of_exponent = static_at_load(state, f_n) if state.events_mu_s > 0 else (state.mu_s, 0.0)
    change = math.log(value / present)
    prior = state.variance_mu_s + p.drift_mu_s * p.drift_mu_s + of_exponent
    if state.events_mu_s > 0:
        _disagree(state, min(change * change, 1.0) - prior - noise)
    if state.events_mu_s == 0 or abs(change) > max(p.jump_mu_s, 3.0 * math.sqrt(prior + noise)):
        gain = 1.0
        state.variance_mu_s = noise
    else:
        gain = prior / (prior + noise)
        state.variance_mu_s = (1.0 - gain) * prior
    state.event = min(max(present * math.exp(gain * change), p.mu_min), p.mu_max)
    state.event_load = f_n
    doubt = 0.0 if longer_than_springs(state, p, state.spring) else doubt_of(p, value, p.mu_s0)
    state.doubt += gain * (doubt - state.doubt)
    state.shared *= 1.0 - gain
    _common(state, p, f_n)
    state.events_mu_s += 1


@njit(error_model="numpy")
def _held(state, p, value, f_n, torque_share):
    """Raises mu_s to a load that a stick carries, if errors of the sensors do not explain it.

    Args:
        state: Changed in place.
        p: Parameters.
        value: Smallest of `HELD` loads over f_n in a row.
        f_n: Normal force there [N].
        torque_share: Fraction of the squared load that is torque.
    """
    present, of_exponent = static_at_load(state, f_n)
    noise = (p.sd_normal / f_n) ** 2 + (p.sd_force / (value * f_n)) ** 2
    noise += _of_radius(state, torque_share)
    further = 1.0 / f_n - 1.0 / state.event_load
    noise += state.covariance[ZERO, ZERO] * (further / (p.caution * value)) ** 2
    if not value > present * (1.0 + SURE * math.sqrt(noise)):
        return
    prior, change = state.variance_mu_s + of_exponent, math.log(value / present)
    _disagree(state, min(change * change, 1.0) - prior - noise)
    state.event, state.event_load, state.shared = value, f_n, 0.0
    state.doubt = min(state.doubt, doubt_of(p, value, p.mu_s0))
    state.variance_mu_s = min(prior, max(noise + SAMPLING * SAMPLING, LEFT * prior))
    _common(state, p, f_n)
    state.events_mu_s += 1


@njit(error_model="numpy")
def _common(state, p, f_n):
    """Variance of ln mu_s by the errors that all events share, at a normal force [N]."""
    zero, tilt = state.covariance[ZERO, ZERO], state.covariance[TILT, TILT]
    known = 1.0 / (p.caution * state.event) ** 2
    state.common_mu_s = known * (zero / (f_n * f_n) + tilt) + state.variance_normal / (f_n * f_n)
    state.common_mu_s += p.sd_gain * p.sd_gain


@njit(error_model="numpy")
def _heaviest(state, p, f_n):
    """Normal force [N] of that of the newest samples with the largest load over it; f_n if there is none."""
    largest = 0.0
    for i in range(state.samples - min(LAST, state.in_a_row - 1), state.samples + 1):
        _, _, _, _, ratio = load_of(state, i)
        normal = state.wrenches[i & LAST, 2]
        if ratio > largest and normal >= p.eps_fn:
            largest, f_n = ratio, np.float64(normal)
    return f_n


@njit(error_model="numpy")
def learn_static_friction(state, p, f_t, f_n, tau, still, moves, halted):
    """Advances the stick-slip state machine by one sample and learns mu_s at a break-away.

    Args:
        state: Changed in place.
        p: Parameters.
        f_t: Tangential force without the errors that are known [N].
        f_n: Normal force [N].
        tau: As f_t, size of the torque [N m].
        still: Whether the velocity is zero.
        moves: Whether it is that of a slip.
        halted: Whether nothing is learned.
    """
    rim = tau / state.r
    if not state.slipping and not halted:
        ratio = load_size(True, f_t, rim) / f_n
        torque_share = direction_cosines(f_t, rim)[1] ** 2
        if 1.0 - torque_share > p.eps_t * p.eps_t:
            append(state, p, ratio)
        else:
            clear_buffer(state)
        state.least = min(state.least, ratio) if state.above > 0 else ratio
        above = still and state.events_mu_s > 0 and ratio > state.mu_s
        state.above = state.above + 1 if above else 0
        if state.above >= HELD and p.mu_s_from_sticks:
            _held(state, p, min(state.least, p.mu_max), f_n, torque_share)
            state.above = 0
    if moves and (state.doubt > 0.0 or not state.certain) and longer_than_springs(state, p, state.spring):
        state.doubt, state.certain = 0.0, True
    starts, stops = transition(state, p, still, moves)
    if starts and not halted and state.buffer_size >= p.n_a:
        _event(state, p, take_event(state, p), _heaviest(state, p, f_n), direction_cosines(f_t, rim)[1] ** 2)
    if starts or stops:
        clear_buffer(state)


@njit(error_model="numpy")
def order(state, shared_mu_c, shared_mu_s):
    """Moves mu_s and mu_c, if both are measured and in the wrong order, to their weighted mean.

    Args:
        state: Changed in place.
        shared_mu_c: Part of the variance of mu_c that the same slips make for mu_s, too: it has no weight.
        shared_mu_s: As shared_mu_c, of mu_s.
    """
    if state.events_mu_s == 0 or state.updates_mu_c == 0 or state.mu_c <= state.mu_s:
        return
    of_mu_c, of_mu_s = state.sd_mu_c * state.sd_mu_c, state.sd_mu_s * state.sd_mu_s
    gap = state.mu_c - state.mu_s
    if gap * gap > 4.0 * (of_mu_c + of_mu_s):  # a contradiction: neither is as sure as it says
        state.confidence_mu_c *= 0.5
        state.confidence_mu_s *= 0.5
    of_mu_c, of_mu_s = max(of_mu_c - shared_mu_c, 0.0), max(of_mu_s - shared_mu_s, 0.0)
    weight = of_mu_s / max(of_mu_c + of_mu_s, 1e-300)
    mean = weight * state.mu_c + (1.0 - weight) * state.mu_s
    state.mu_c, state.mu_s = mean, mean
    state.event, state.event_load = mean, state.load
