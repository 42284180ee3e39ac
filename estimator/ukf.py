"""The "ukf" estimator: an unscented Kalman filter on the logarithms of mu_c and r.

State: (ln mu_c, ln r), a random walk. Measurement: (f_t, tau) of a slip of known f_n and twist on the limit
surface. The unscented transform (Julier & Uhlmann, Unscented filtering and nonlinear estimation, Proc. IEEE
92, 2004; n = 2, kappa = 1: five points of weights 1/3 and 1/6) propagates the mean and covariance. Noise of
the twist and of f_n enters the covariance of the measurement by its effect on f_t and tau.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from estimator._numba.caching import njit
from estimator._numba.entry_point import entry_point
from estimator.limit_surface import slip_friction
from estimator.parameters import parameter
from estimator.registry import FilterMatrices, Specification
from estimator.sample import clamped, count_mu_c, count_r
from estimator.sliding import SLIDING_STATE, SlidingParameters, close_sample, open_sample, slides, spins
from estimator.stick_slip import EVENT_STATE, start

SPREAD = math.sqrt(3.0)
"""Spread of the points, sqrt(n + kappa)."""


@dataclass(frozen=True)
class UkfParameters(SlidingParameters):
    """Those of every estimator that learns from true sliding, and its own.

    Raises:
        ValueError: A value has the wrong type, is NaN, lies outside its interval or contradicts another one.
    """

    disc: bool = parameter(
        True, "Whether the limit surface is that of a uniform disc; otherwise it is the ellipsoid."
    )
    drift: float = parameter(
        1e-3, "Relative random walk of mu_c and of r per sample of sliding, standard deviation.", "(0, 1)"
    )
    sd_log_mu_c0: float = parameter(1.0, "Standard deviation of ln mu_c at the start.", "(0, 3]")
    sd_log_r0: float = parameter(1.0, "Standard deviation of ln r at the start.", "(0, 3]")


STATE = np.dtype(
    [
        *SLIDING_STATE,
        ("covariance", np.float64, (3,)),
        ("residual", np.float64, (2,)),
        ("gain", np.float64, (2, 2)),
        ("innovation_covariance", np.float64, (3,)),
        *EVENT_STATE,
    ],
    align=True,
)
"""`covariance`: P of (ln mu_c, ln r), elements 11, 12, 22. Of the last update: `residual` y of (f_t, tau)
[N, N m], `gain` K, `innovation_covariance` S, elements 11, 12, 22."""


def initial_states(parameters: NDArray[np.void]) -> NDArray[np.void]:
    """States (m,) before the first sample, by parameters (m,)."""
    states = start(parameters, STATE)
    states["covariance"][:, 0] = parameters["sd_log_mu_c0"] ** 2
    states["covariance"][:, 2] = parameters["sd_log_r0"] ** 2
    return states


def filter_matrices(states: NDArray[np.void]) -> FilterMatrices:
    """Matrices of the filter on (ln mu_c, ln r): the covariance has no unit, the gain is in [1/N, 1/(N m)].

    A measurement that is within its noise has a gain of 0.
    """
    symmetric = [[0, 1], [1, 2]]
    return FilterMatrices(
        residual=states["residual"].copy(),
        gain=states["gain"].copy(),
        covariance=states["covariance"][:, symmetric],
        innovation_covariance=states["innovation_covariance"][:, symmetric],
    )


@njit
def expected(p, log_mu_c, log_r, f_n, v_t, omega):
    """f_t and |tau| [N, N m] of a slip."""
    r = math.exp(log_r)
    force, torque = slip_friction(p.disc, v_t, r * omega)
    limit = math.exp(log_mu_c) * f_n
    return limit * force, limit * torque * r


@njit
def measurement_noise(p, f_t, tau, log_mu_c, log_r, f_n, v_t, omega):
    """Covariance (11, 12, 22) of the measured f_t and tau, given the measured twist and f_n."""
    by_speed = expected(p, log_mu_c, log_r, f_n, v_t + p.sd_speed, omega)
    by_spin = expected(p, log_mu_c, log_r, f_n, v_t, omega + p.sd_spin)
    a, b = by_speed[0] - f_t, by_speed[1] - tau
    c, d = by_spin[0] - f_t, by_spin[1] - tau
    normal, law = (p.sd_normal / f_n) ** 2, p.law_error**2
    return (
        p.sd_force**2 + (law + normal) * f_t * f_t + a * a + c * c,
        normal * f_t * tau + a * b + c * d,
        p.sd_torque**2 + (law + normal) * tau * tau + b * b + d * d,
    )


@njit
def _learn(state, p, f_t, f_n, tau, v_t, omega):
    """One step of the filter; a step that overflows is refused.

    Returns:
        Whether mu_c, and whether r, was updated: whether its standard deviation fell.
    """
    walk = p.drift * p.drift
    p_11 = min(state.covariance[0] + walk, p.sd_log_mu_c0**2)
    p_12 = state.covariance[1]
    p_22 = min(state.covariance[2] + walk, p.sd_log_r0**2)
    x_1, x_2 = math.log(state.mu_c), math.log(state.r)
    l_11 = math.sqrt(p_11)
    l_21 = p_12 / l_11
    l_22 = math.sqrt(max(p_22 - l_21 * l_21, 0.0))

    mean_f, mean_t = 0.0, 0.0
    s_11, s_12, s_22 = 0.0, 0.0, 0.0
    c_1f, c_1t, c_2f, c_2t = 0.0, 0.0, 0.0, 0.0
    middle_f, middle_t = expected(p, x_1, x_2, f_n, v_t, omega)
    for k in range(4):  # differences to the middle point, so that its weight drops out
        side = SPREAD if k % 2 == 0 else -SPREAD
        d_1 = side * l_11 if k < 2 else 0.0
        d_2 = side * (l_21 if k < 2 else l_22)
        z_f, z_t = expected(p, x_1 + d_1, x_2 + d_2, f_n, v_t, omega)
        z_f, z_t = z_f - middle_f, z_t - middle_t
        mean_f, mean_t = mean_f + z_f / 6.0, mean_t + z_t / 6.0
        s_11, s_12, s_22 = s_11 + z_f * z_f / 6.0, s_12 + z_f * z_t / 6.0, s_22 + z_t * z_t / 6.0
        c_1f, c_1t = c_1f + d_1 * z_f / 6.0, c_1t + d_1 * z_t / 6.0
        c_2f, c_2t = c_2f + d_2 * z_f / 6.0, c_2t + d_2 * z_t / 6.0
    r_11, r_12, r_22 = measurement_noise(p, middle_f, middle_t, x_1, x_2, f_n, v_t, omega)
    s_11 += r_11 - mean_f * mean_f
    s_12 += r_12 - mean_f * mean_t
    s_22 += r_22 - mean_t * mean_t
    if not slides(p, f_t, v_t):  # the magnitude of noise is not a measurement
        c_1f, c_2f, s_12 = 0.0, 0.0, 0.0
    if not spins(p, tau, omega):
        c_1t, c_2t, s_12 = 0.0, 0.0, 0.0

    determinant = s_11 * s_22 - s_12 * s_12
    g_1f, g_1t = (c_1f * s_22 - c_1t * s_12) / determinant, (c_1t * s_11 - c_1f * s_12) / determinant
    g_2f, g_2t = (c_2f * s_22 - c_2t * s_12) / determinant, (c_2t * s_11 - c_2f * s_12) / determinant
    error_f, error_t = f_t - middle_f - mean_f, tau - middle_t - mean_t
    x_1 += g_1f * error_f + g_1t * error_t
    x_2 += g_2f * error_f + g_2t * error_t
    n_11 = p_11 - g_1f * c_1f - g_1t * c_1t
    n_12 = p_12 - g_1f * c_2f - g_1t * c_2t
    n_22 = p_22 - g_2f * c_2f - g_2t * c_2t
    if not (math.isfinite(x_1) and math.isfinite(x_2) and n_11 > 0.0 and n_11 * n_22 > n_12 * n_12):
        return False, False
    state.mu_c = clamped(math.exp(x_1), p.mu_min, p.mu_max)
    state.r = clamped(math.exp(x_2), p.r_min, p.r_max)
    state.covariance[0], state.covariance[1], state.covariance[2] = n_11, n_12, n_22
    state.residual[0], state.residual[1] = error_f, error_t
    state.gain[0, 0], state.gain[0, 1], state.gain[1, 0], state.gain[1, 1] = g_1f, g_1t, g_2f, g_2t
    state.innovation_covariance[0] = s_11
    state.innovation_covariance[1] = s_12
    state.innovation_covariance[2] = s_22
    state.sd_mu_c, state.sd_r = state.mu_c * math.sqrt(n_11), state.r * math.sqrt(n_22)
    saw_mu_c, saw_r = n_11 < p_11 - walk, n_22 < p_22 - walk
    if saw_mu_c:
        count_mu_c(state, p)
    if saw_r:
        count_r(state, p)
    return saw_mu_c, saw_r


@njit
def _update(state, p, t, wrench, twist, estimate):
    """One finger, one sample."""
    taken, halted, slid, instant, seen = open_sample(state, p, t, wrench, twist)
    if taken:
        saw_mu_c, saw_r = _learn(state, p, *instant[:5]) if slid else (False, False)
        close_sample(state, p, t, seen, halted, saw_mu_c, saw_r, estimate)


@entry_point(STATE, UkfParameters.dtype())
def update_batch(states, parameters, t, wrenches, twists, estimates):
    """Updates n fingers by one sample each; see `estimator.registry.Specification`."""
    for i in range(len(states)):
        p = parameters[min(i, len(parameters) - 1)]
        wrench = wrenches[i, 0], wrenches[i, 1], wrenches[i, 2], wrenches[i, 3]
        twist = twists[i, 0], twists[i, 1], twists[i, 2]
        _update(states[i], p, t, wrench, twist, estimates[i])


SPECIFICATION = Specification("ukf", UkfParameters, initial_states, update_batch, filter_matrices)
