"""Zeroes the sensors while they carry no load: before the grasp and after a release.

A sensor that has read a small and steady normal force since the start is unloaded, whatever its zero error;
once there was contact, one that reads that force again. Their means are the prior of the zero errors.
"""

from estimator._numba.caching import njit
from estimator.window.layout import TORQUE, ZERO

OPEN = 0.6
"""Normal force up to which a sensor may be unloaded at first [N]: six deviations of its zero error."""
BEGINS, AGAIN = 6.0, 3.0
"""Deviations of the noise of f_n beyond which contact begins, and within which it has ended."""
LONGEST = 200.0  # Readings after which the zeros are a fading mean
LEFT = 0.1
"""Deviation that the zero errors keep, over that of the prior: they drift, and readings may be repeated."""


@njit(error_model="numpy")
def is_unloaded(state, p, f_n):
    """Whether a sensor carries no load, from the normal force that it reads [N]."""
    off = abs(f_n - state.zeros[2])
    if state.touched:
        return state.unloaded > 0.0 and off < AGAIN * p.sd_normal
    state.touched = abs(f_n) > OPEN or (state.unloaded > 0.0 and off > BEGINS * p.sd_normal)
    return not state.touched


@njit(error_model="numpy")
def learn_zeros(state, p, wrench):
    """Takes the reading (4,) of a sensor without load into the means of its zero errors."""
    state.unloaded = min(state.unloaded + 1.0, LONGEST)
    for j in range(4):
        state.zeros[j] += (wrench[j] - state.zeros[j]) / state.unloaded
    left = LEFT * LEFT + 6.0 / (state.unloaded + 5.0) * (p.sd_force / p.sd_zero) ** 2
    of_force, of_torque = left * p.sd_zero * p.sd_zero, left * p.sd_zero_torque * p.sd_zero_torque
    for at, zero, variance in ((ZERO, 0, of_force), (ZERO + 1, 1, of_force), (TORQUE, 3, 6.0 * of_torque)):
        state.mean[at] = state.x[at] = state.zeros[zero]
        state.variance[at] = variance
    state.variance_normal = 4.0 * of_force
