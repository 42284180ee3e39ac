"""Tests whether mu_c has changed at once, by the innovations in its direction.

Two cumulative sums (Page, Biometrika 41, 1954), one for each direction, find the samples that speak for a
change. Innovations of a rough support or of rubber scatter more than the noise of the sensors explains, and
some large ones in a row are no change. So their mean must also exceed what the scatter of all innovations
explains, as in a t test.
"""

from estimator._numba.caching import njit
from estimator.augmented.slip_law import MU

CLIPPED = 3.0
"""Size to which an innovation is clipped in the sums: one sample is no change."""
MEMORY = 0.05
"""Weight of an innovation in the scatter."""
LARGEST = 10.0
"""Size to which it is clipped there and in the mean."""


@njit(error_model="numpy")
def test_for_jump(state, p, score):
    """Takes the normalised innovation of a sample; a change widens the variance of mu_c."""
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
        state.covariance[MU, MU] += p.sd_jump * p.sd_jump
