"""Compiled functions that open and close a sample; every estimator calls them.

`state` is a record whose dtype holds `STICK_SLIP_STATE`, `p` a record of `StickSlipParameters` or a subclass.
"""

import math

from estimator._numba.caching import njit

LARGEST = 1e12
"""Readings from which on a sample is skipped like NaN [N, N m, m/s, rad/s]: their powers would overflow."""


@njit
def norm(x, y):
    """Length of (x, y); faster than hypot, whose protection against overflow is not needed here."""
    return math.sqrt(x * x + y * y)


@njit(error_model="numpy")
def direction_cosines(translation, rotation):
    """Direction cosines of the vector (translation, rotation); zeros if it is zero or not finite."""
    scale = 1.0 / norm(translation, rotation)
    if 0.0 < scale < math.inf:
        return min(translation * scale, 1.0), min(rotation * scale, 1.0)
    return 0.0, 0.0


@njit
def clamped(value, low, high):
    """The value, limited to [low, high]."""
    return min(max(value, low), high)


@njit
def readable(state, t, f_t, f_n, tau, speed):
    """Whether a sample is one of a sensor, neither NaN nor beyond `LARGEST`, and later than the last one."""
    sound = f_t < LARGEST and abs(f_n) < LARGEST and abs(tau) < LARGEST and speed < LARGEST
    return sound and math.isfinite(t) and (state.samples == 0 or t - state.t > 0.0)


@njit
def count_mu_c(state, p):
    """Counts an update of mu_c; its confidence becomes 1 - forgetting**updates."""
    state.updates_mu_c += 1
    state.confidence_mu_c += (1.0 - p.forgetting) * (1.0 - state.confidence_mu_c)


@njit
def count_r(state, p):
    """Counts an update of r, like `count_mu_c`."""
    state.updates_r += 1
    state.confidence_r += (1.0 - p.forgetting) * (1.0 - state.confidence_r)


@njit
def publish(state, t, f_n, gamma_t, gamma_tau, halted, saw_mu_c, saw_r, estimate):
    """Closes a sample: stores t [s] and f_n [N], writes the ESTIMATE record.

    Static friction is never below Coulomb friction, but each is estimated from other samples. Where they
    contradict each other, the start value of mu_c yields to a measured mu_s, and else mu_s is raised to mu_c.
    The state keeps its own values.
    """
    state.t = t
    state.f_n = f_n
    state.samples += 1
    unknown_mu_c = state.updates_mu_c == 0 and state.events_mu_s > 0
    estimate.mu_c = min(state.mu_c, state.mu_s) if unknown_mu_c else state.mu_c
    estimate.mu_s = max(state.mu_s, estimate.mu_c)
    estimate.r = state.r
    estimate.gamma_t = gamma_t
    estimate.gamma_tau = gamma_tau
    estimate.confidence_mu_s = state.confidence_mu_s
    estimate.confidence_mu_c = state.confidence_mu_c
    estimate.confidence_r = state.confidence_r
    estimate.events_mu_s = state.events_mu_s
    estimate.updates_mu_c = state.updates_mu_c
    estimate.updates_r = state.updates_r
    estimate.slipping = state.slipping
    estimate.halted = halted
    estimate.sd_mu_s = state.sd_mu_s
    estimate.sd_mu_c = state.sd_mu_c
    estimate.sd_r = state.sd_r
    estimate.sd_lever = norm(state.mu_c * state.sd_r, state.r * state.sd_mu_c)
    estimate.observable_mu_c = saw_mu_c
    estimate.observable_r = saw_r


@njit(error_model="numpy")
def copy(source, target):
    """Copies an array (n,) into another one. Numba's `target[:] = source` compiles its error message, too."""
    for i in range(len(target)):
        target[i] = source[i]
