"""Learns the tilt of the force sensor from a stick in which the normal force changes.

An object at rest carries its load, whatever the normal force. So a tangential force that changes with the
normal force, in proportion to it, is the tilt of the sensor (or its cross-talk, which is the same). A
straight slip does not show the tilt, but the changes of the grip before and between slips do. A load that
changes by itself is noise: its mean square is followed. A controller that grips in proportion to the load
makes a ratio of both changes that no tilt explains.
"""

from estimator._numba.caching import njit
from estimator._numba.memory import matrix
from estimator.augmented.load import limit
from estimator.augmented.scalar_update import correct
from estimator.augmented.slip_law import STATES, TILT
from estimator.augmented.timing import LAST

SETTLED = 6
"""Samples without motion until the object has come to rest and a late velocity has shown it."""
EARLY = SETTLED - 2
"""Samples before the settled one, and the delay, of the first at rest."""
FIRM = 0.7
"""Largest ratio of forces, over that which the contact has held: near the limit rubber creeps."""
CHANGE = 0.8
"""Change of the normal force [N] that is a measurement."""
LONGEST = 24
"""Samples between both loads, at most."""
SHARE = 0.03
"""Part of the load that passes from one finger to the other as unequal pads relax, ..."""
ALIKE = 10.0
"""... and rests that share this error, which is taken for noise."""
UNLIKELY = 3.0
"""Deviations beyond which the load has changed by itself."""
MEMORY = 0.2
"""Weight of a measurement in the mean square of what the tilt does not explain."""


@njit(error_model="numpy")
def learn_tilt(state, p, wrench, moves, f_t):
    """Compares the force at rest with that at another normal force, shortly before.

    Args:
        state: Changed in place.
        p: Parameters.
        wrench: f_x, f_y, f_n, tau, without the zero error of f_n [N, N, N, N m].
        moves: Whether the newest velocity moved.
        f_t: Tangential force without the errors that are known [N].
    """
    most = state.mu_c if state.updates_mu_c > 0 else state.held
    if moves or f_t > FIRM * most * wrench[2] or state.in_a_row <= state.delay + EARLY:
        state.resting = 0
        return
    state.resting += 1
    if state.resting < SETTLED:
        return
    rest = state.rest
    if state.resting == SETTLED:
        state.rest_sample = state.samples - state.delay - EARLY
        stopped = state.wrenches[state.rest_sample & LAST]
        rest[0], rest[1], rest[2] = stopped[0], stopped[1], stopped[2]
    step = wrench[2] - rest[2]
    if abs(step) < CHANGE and state.samples - state.rest_sample < LONGEST:
        return
    for axis in range(2):
        _compare(state, p, axis, wrench[axis] - rest[axis], step, SHARE * f_t)
    rest[0], rest[1], rest[2] = wrench[0], wrench[1], wrench[2]
    state.rest_sample = state.samples


@njit(error_model="numpy")
def _compare(state, p, axis, change, step, passed):
    """Takes the change of the force along an axis [N] with a change of the normal force [N].

    Args:
        state: Changed in place.
        p: Parameters.
        axis: 0 for x, 1 for y.
        change: Of the force along it [N].
        step: Of the normal force [N].
        passed: Force that may have passed to the other finger [N].
    """
    x, covariance, at = state.x, state.covariance, TILT + axis
    innovation = change - step * x[at]
    square = innovation * innovation
    noise = max(2.0 * p.sd_force * p.sd_force, state.restless) + ALIKE * passed * passed
    state.restless += MEMORY * (min(square, 1.0) - state.restless)
    if abs(step) < CHANGE:
        return
    cautious = p.caution * p.caution
    variance = step * step * covariance[at, at] + cautious * noise
    if not square * cautious < UNLIKELY * UNLIKELY * variance:
        return
    crossed = matrix(1, STATES)[0]
    for j in range(STATES):
        crossed[j] = step * covariance[at, j]
    correct(x, covariance, crossed, 1.0 / variance, innovation)
    limit(state, p)
