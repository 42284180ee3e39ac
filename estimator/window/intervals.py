"""Pairs velocities with wrenches, joins samples to intervals of at least 7 ms, and finds motion and rest.

A velocity is the mean over a window that closed `delay` samples ago. So the wrench at its end is that many
samples old. Intervals make every sampling rate the same and sum the counts of the sensor. An instant between
two intervals counts as one of a slip if two intervals before it and two after it moved: an error of the delay
of one sample, or a velocity that comes twice, does no harm.
"""

import math

from estimator._numba.caching import njit
from estimator._numba.memory import matrix
from estimator.sample import copy
from estimator.window.layout import INTERVALS, LATE, SAMPLES, SHORTEST
from estimator.window.spring import length, stiffen
from estimator.window.sticks import find_peak, learn_short_slip, learn_tilt
from estimator.window.window import add_instant, end_stretch

QUANTILE = 0.2  # Of the changes of the velocity, that is its noise, most being at rest
NOISES = 3.7
"""Speed over the noise that is motion; the quantile of 0.2 is two thirds of a deviation, so 2.5 of them."""


@njit(error_model="numpy")
def _learn_noise(state, p, interval, last):
    """Follows a quantile of the changes of the velocity, by the logarithm."""
    change = matrix(1, 3)[0]
    for j in range(3):
        change[j] = interval.motion[j] / interval.time - last.motion[j] / last.time
    up = length(p, change) > math.sqrt(2.0) * state.noise
    noise = state.noise * math.exp(0.05 * (QUANTILE if up else QUANTILE - 1.0))
    state.noise = min(max(noise, 1e-4), 5e-3)


@njit(error_model="numpy")
def _rest(state, p):
    """Takes an interval at rest."""
    end_stretch(state, p)
    state.quiet = 1 if state.run > 0 else state.quiet + 1
    state.run = 0
    if state.quiet == LATE and not state.learned:
        learn_short_slip(state, p)
    if state.quiet == 2 * LATE:
        state.rest[2] = 0.0
    if state.quiet >= 2 * LATE:
        learn_tilt(state, p, state.intervals[(state.interval - 1) % INTERVALS].wrench)


@njit(error_model="numpy")
def _move(state, p, again):
    """Takes an interval that moved; a velocity that comes again may be the last one."""
    n = state.interval
    if state.run == 0:
        if state.quiet >= LATE or state.learned:
            state.first = n - 1
            state.learned = False
        state.peak[2], state.repeated = 0.0, 0
        if state.quiet >= LATE:
            find_peak(state)
    elif again:
        state.repeated = 1
    state.run += 1
    if state.run > LATE + state.repeated:
        add_instant(state, p, state.intervals[(n - 3) % INTERVALS], state.intervals[(n - 2) % INTERVALS])


@njit(error_model="numpy")
def _empty(interval):
    """Makes an interval one without samples."""
    interval.time, interval.count = 0.0, 0.0
    interval.motion[:] = 0.0
    interval.wrench[:] = 0.0


@njit(error_model="numpy")
def _close(state, p):
    """Closes the interval that grows."""
    grown, n = state.growing, state.interval
    interval, last = state.intervals[n % INTERVALS], state.intervals[(n - 1) % INTERVALS]
    interval.time, interval.count = grown.time, grown.count
    copy(grown.motion, interval.motion)
    for j in range(4):
        interval.wrench[j] = grown.wrench[j] / grown.count
    _empty(grown)
    state.interval = n + 1
    stiffen(state, p)
    if n > 0 and state.run <= LATE:
        _learn_noise(state, p, interval, last)
    if length(p, interval.motion) / interval.time > max(p.eps_v, NOISES * state.noise):
        _move(state, p, (interval.motion == last.motion).all())
    else:
        _rest(state, p)


@njit(error_model="numpy")
def add_sample(state, p):
    """Adds the newest velocity, and the wrench at the end of its window, to the interval that grows."""
    delay = max(state.delay, 0)
    if state.in_a_row < delay + 3:
        return
    grown, k = state.growing, state.samples
    grown.time += state.elapsed
    grown.count += 1.0
    for j in range(3):
        grown.motion[j] += state.elapsed * state.twists[k % SAMPLES, j]
    for j in range(4):
        grown.wrench[j] += state.wrenches[(k - delay) % SAMPLES, j]
    if grown.time >= SHORTEST:
        _close(state, p)


@njit(error_model="numpy")
def lose_contact(state, p):
    """Ends a slip, and forgets the samples before."""
    end_stretch(state, p)
    state.in_a_row, state.run, state.quiet, state.learned = 0, 0, 0, True
    _empty(state.growing)
