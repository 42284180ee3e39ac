"""Zeroes the sensors while they carry no load: before the grasp and after a release.

A sensor that has read a small and steady normal force since the start is unloaded, whatever its zero error;
once there was contact, one that reads that force again. The tangential zero errors are states of the filter.
Those of normal force and torque are averaged here, and subtracted from every sample.
"""

from estimator._numba.caching import njit
from estimator._numba.memory import matrix
from estimator.augmented.load import limit
from estimator.augmented.scalar_update import correct
from estimator.augmented.slip_law import STATES, ZERO

HEDGE = 2.0
"""How much larger than its noise a reading's error is taken: readings may be repeated, zero errors drift."""
STEADY = 3.0
"""Deviations of the noise within which the normal force of a sensor without load stays."""


@njit(error_model="numpy")
def without_load(state, p, f_n):
    """Whether a sensor carries no load, from the normal force that it reads [N]."""
    off = abs(f_n - state.zero_normal)
    if state.touched:
        return off < p.noise_gate * p.sd_normal
    state.touched = abs(f_n) > p.eps_open or (state.unloaded and off > STEADY * p.sd_normal)
    return not state.touched


@njit(error_model="numpy")
def learn_zero(state, p, wrench):
    """Takes the reading of a sensor without load as a measurement of its zero errors.

    Args:
        state: Record with `x`, `covariance`, `unloaded`, and the zero errors of f_n and tau with their
            variances; changed in place.
        p: Parameters.
        wrench: f_x, f_y, f_n, tau as read [N, N, N, N m].
    """
    gain = state.variance_normal / (state.variance_normal + (HEDGE * p.sd_normal) ** 2)
    state.zero_normal += gain * (wrench[2] - state.zero_normal)
    state.variance_normal *= 1.0 - gain
    if wrench[2] < p.eps_fn:  # otherwise the torque is that about a centre of pressure that there is not
        gain = state.variance_torque / (state.variance_torque + (HEDGE * p.sd_torque) ** 2)
        change = wrench[3] - state.zero_torque
        if abs(change) < 10.0 * p.sd_zero_torque:
            state.zero_torque += gain * change
            state.variance_torque *= 1.0 - gain
    x, covariance, crossed = state.x, state.covariance, matrix(1, STATES)[0]
    for axis in range(2):
        at = ZERO + axis
        innovation = wrench[axis] - x[at]
        if not abs(innovation) < 10.0 * p.sd_zero:
            continue
        state.unloaded = True
        for j in range(STATES):
            crossed[j] = covariance[j, at]
        noise = HEDGE * p.caution * p.sd_force
        correct(x, covariance, crossed, 1.0 / (crossed[at] + noise * noise), innovation)
        limit(state, p)


@njit(error_model="numpy")
def drift_zero(state, p, elapsed):
    """Widens the variances of the zero errors by their random walk in a time [s], up to what they were."""
    step = p.walk_force * p.walk_force * elapsed
    state.variance_normal = min(state.variance_normal + step, p.sd_zero * p.sd_zero)
    torque = p.walk_torque * p.walk_torque * elapsed
    state.variance_torque = min(state.variance_torque + torque, p.sd_zero_torque * p.sd_zero_torque)
    assumed = p.caution * p.caution
    most = assumed * p.sd_zero * p.sd_zero
    for at in (ZERO, ZERO + 1):
        variance = state.covariance[at, at]
        state.covariance[at, at] = max(variance, min(variance + assumed * step, most))
