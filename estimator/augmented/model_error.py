"""Errors of the model that all samples of a slip share; separate slips show how large they are.

A slip of a rubber pad is off by more than the noise of its samples: the pad springs and creeps meanwhile, the
fingers share the load unevenly, friction depends on the direction, on the place and on the time in stick. All
samples of a slip have much of that error in common, so that the noise of the filter does not contain it. Its
variance is that of the prior, `sd_slip`, and the sum of the squared differences between a slip and those
before it, as far as noise does not explain them; over the number of slips, for the mean of the variance, and
over it again, for the mean of the slips. Slips that agree lower the deviation by their number, others by its
square root. A slip counts in proportion to its length, as its beginning and end are off most, and a long one
as several. A slip with a torque counts as little as r is known. What is common to all slips of a contact,
such as anisotropy while they have one direction, is `sd_surface`, and lasts.

A motion that is no longer than a pad may spring may be no slip at all. Then its load is only a bound, which
`doubt_of` takes into account until a longer motion is seen.
"""

import math

from estimator._numba.caching import njit
from estimator.augmented.holding import LOWEST

WHOLE = 12
"""Samples that count as a whole slip."""
HALF = 0.2
"""Relative deviation of r with which a slip under torque counts as half of one."""
START = 1.0
"""Whole slips that the prior is worth."""
FIRST = 4
"""Samples of a slip whose mean is compared with the slips before."""
MEMORY = 0.95
"""Fading of the slips, per whole slip."""
SPRINGS = 0.25
"""Share of springs of the pad among the motions that pass for slips and are short enough to be one."""
LARGEST = 1.0
"""Size to which the difference of ln mu_c is clipped."""


@njit(error_model="numpy")
def _compare(state, innovation, variance):
    """Takes one of the first samples of a slip into its squared difference from the slips before, once."""
    n = state.slip_samples
    state.innovation += (innovation - state.innovation) / n
    state.expected += (variance - state.expected) / n
    if state.separate > 0.0 and state.updates_mu_c >= n:
        size = min(abs(state.innovation), LARGEST)
        before, state.difference = state.difference, max(size * size - state.expected, 0.0)
        state.contrast += state.difference - before


@njit(error_model="numpy")
def count_slip(state, begins, score, variance, rim, square):
    """Takes a sample of a slip into the number of slips and their differences.

    Args:
        state: Changed in place.
        begins: Whether it is the first one of a slip.
        score: Normalised innovation of ln mu_c.
        variance: Of the innovation, as the filter expects it.
        rim: Squared load by the torque, or squared slip speed by the spin.
        square: Squared load, or squared scaled slip speed; `rim` is a part of it. > 0.
    """
    if begins:
        state.slip_samples, state.innovation, state.expected, state.difference = 0, 0.0, 0.0, 0.0
    state.slip_samples += 1
    if state.slip_samples <= FIRST:
        _compare(state, score * math.sqrt(variance), variance)
    known, unknown = state.r * HALF * square, state.sd_r * rim
    weight = known * known / (WHOLE * (known * known + unknown * unknown))
    kept = 1.0 - (1.0 - MEMORY) * weight
    state.separate = kept * state.separate + weight
    more = weight * state.difference if state.slip_samples > WHOLE else 0.0
    state.contrast = kept * state.contrast + more
    state.changes *= kept


@njit(error_model="numpy")
def doubt_of(p, value, expected):
    """Expected square of the error of ln mu by a slip that may have been the spring of the pad.

    If it was one, the load is no more than a bound, and friction is what was expected before. The logarithm
    is then as probable anywhere between the smallest that counts and the expected one; that of a true slip is
    normally distributed about the expected one.

    Args:
        p: Parameters.
        value: mu_s or mu_c that was measured.
        expected: Its start value.
    """
    below = max(math.log(expected / value), 0.0)
    z = below / p.sd_log_mu_c0
    spring = SPRINGS / LOWEST
    slip = (1.0 - SPRINGS) * math.exp(-0.5 * z * z) / math.sqrt(2.0 * math.pi)
    return below * below * spring / (spring + slip)


@njit(error_model="numpy")
def forget_slips(state):
    """Forgets how many slips there were, and their disagreement."""
    state.separate, state.contrast, state.difference, state.slip_samples = 0.0, 0.0, 0.0, 0
    state.changes = 0.0
    state.certain = False


@njit(error_model="numpy")
def of_slips(state, p):
    """Variance of ln mu_c, and of ln r, by the errors that the samples of a slip share."""
    n = START + state.separate
    return (p.sd_slip * p.sd_slip + state.contrast) / (n * n)
