"""Tests whether mu_c has changed at once, by the innovations in its direction; mu_s follows its changes.

Two cumulative sums (Page, Biometrika 41, 1954), one for each direction, find the samples that speak for a
change. Innovations of a rough support or of rubber scatter more than the noise of the sensors explains, and
some large ones in a row are no change. So their mean must also exceed what the scatter of all innovations
explains, as in a t test.

A change of friction is one of both mu_c and mu_s: another place, dust or wear change the surface. So the
random walk of ln mu_c is one of ln mu_s, too. `state.shared` is the covariance of both by the changes since
the last events: a measurement of mu_c moves mu_s by this over the variance of ln mu_c.
"""

import math

from estimator._numba.caching import njit
from estimator.augmented.likelihood_ratio import forget_change
from estimator.augmented.load import forget_exponent
from estimator.augmented.slip_law import MU
from estimator.sample import clamped

CLIPPED = 3.0
"""Size to which an innovation is clipped in the sums: one sample is no change."""
MEMORY = 0.05
"""Weight of an innovation in the scatter."""
LARGEST = 10.0
"""Size to which it is clipped there and in the mean."""


@njit(error_model="numpy")
def test_for_jump(state, p, score):
    """Takes the normalised innovation of a sample; a change widens the variance of mu_c.

    What slips said of its exponent is forgotten: a change between slips at two loads looks like one.
    """
    size = min(max(score, -LARGEST), LARGEST)
    clipped = min(max(score, -CLIPPED), CLIPPED)
    found = False
    for k in range(2):
        direction = 1.0 - 2.0 * k
        run = state.runs[k]
        run[0] = max(run[0] + direction * clipped - p.jump_slack, 0.0)
        if run[0] == 0.0:
            run[1], run[2] = 0.0, 0.0
        else:
            run[1], run[2] = run[1] + 1.0, run[2] + direction * size
            clear = run[2] * run[2] > p.jump_evidence * run[1] * max(state.scatter, 1.0)
            found |= run[0] > p.jump_limit and clear
    state.scatter += MEMORY * (size * size - state.scatter)
    if found:
        state.runs[:] = 0.0
        forget_change(state)
        widen(state, p.sd_jump * p.sd_jump, math.inf)
        if p.jump_forgets_exponent:
            forget_exponent(state, p)


@njit(error_model="numpy")
def widen(state, variance, largest):
    """Adds the variance of a change of friction to that of ln mu_c, as far as it stays below the largest."""
    added = max(min(variance, largest - state.covariance[MU, MU]), 0.0)
    state.covariance[MU, MU] += added
    state.shared += added


@njit(error_model="numpy")
def follow(state, p, value, variance):
    """Moves mu_s of the last events after a measurement of mu_c.

    Args:
        state: Changed in place.
        p: Parameters.
        value: ln mu_c before the measurement.
        variance: Its variance then.
    """
    fraction = min(state.shared / variance, 1.0) if p.mu_s_follows else 0.0
    state.shared = fraction * state.covariance[MU, MU]
    if state.events_mu_s > 0:
        moved = state.event * math.exp(fraction * (state.x[MU] - value))
        state.event = clamped(moved, p.mu_min, p.mu_max)
