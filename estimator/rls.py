"""The "rls" estimator: recursive least squares for mu_c and r, stick-slip events for mu_s.

Source: Waltersson & Karayiannidis, Friction Estimation for In-Hand Planar Motion (ISER 2025):
eqs. (1) f_t = gamma_t f_n mu_c and (2) tau = gamma_tau mu_c f_n r, Algorithm 1 for mu_s, and the heuristic
that halts all updates. docs/estimator.md lists where this differs from the paper as published, and which
parameter restores the published form.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from estimator._numba.caching import njit
from estimator._numba.entry_point import entry_point
from estimator.parameters import RADIUS, parameter
from estimator.registry import FilterMatrices, Specification
from estimator.sample import clamped, count_mu_c, count_r, direction_cosines, norm, publish, readable
from estimator.stick_slip import (
    EVENT_STATE,
    STICK_SLIP_STATE,
    StickSlipParameters,
    append,
    clear_buffer,
    halts,
    learn_mu_s,
    lose_contact,
    start,
    take_event,
    transition,
)


@dataclass(frozen=True)
class RlsParameters(StickSlipParameters):
    """Defaults: Table 1 of Waltersson & Karayiannidis (ISER 2025), our choice where the paper gives no value.

    Each field's metadata holds its documentation, unit and valid interval.

    Raises:
        ValueError: A value has the wrong type, is NaN, lies outside its interval or contradicts another one.
    """

    heuristic: bool = parameter(
        True, "Whether a fast rise of f_n halts all updates; False is the plain estimator."
    )
    r0: float = parameter(0.02, "Start value of r.", RADIUS, "m")
    r_max: float = parameter(0.1, "r is kept at or below this, for example the pad's radius.", RADIUS, "m")
    eps_tau: float = parameter(0.3, "Gate: gamma_tau above which r learns.", "(0, 1)")
    p0: float = parameter(1.0, "Start value P0 of both RLS covariances.", "(0, inf)", "1/N^2")
    covariance_limit: float = parameter(
        1.0,
        "Upper bound of the covariances as a multiple of p0, against wind-up; inf is as published.",
        "[1, inf]",
    )
    low_speed_gamma_from_force: bool = parameter(
        True,
        "Whether gamma_t comes from the force up to eps_v; False, as published: only up to stick_band.",
    )
    machine_gated: bool = parameter(
        False,
        "True, as published: gamma_t <= eps_t stops the stick-slip machine, which watches v_t, not v.",
    )


STATE = np.dtype(
    [
        *STICK_SLIP_STATE,
        ("covariance_mu_c", np.float64),
        ("covariance_r", np.float64),
        ("mean_square_mu_c", np.float64),
        ("mean_square_r", np.float64),
        ("innovation_mu_c", np.float64),
        ("innovation_r", np.float64),
        ("rls_gain_mu_c", np.float64),
        ("rls_gain_r", np.float64),
        *EVENT_STATE,
    ],
    align=True,
)
"""`covariance_*`: P [1/N^2]; `mean_square_*`: of the innovations of f_t [N^2], tau [N^2 m^2];
`innovation_*`, `rls_gain_*`: y [N, N m] and K [1/N] of the last update."""


def initial_states(parameters: NDArray[np.void]) -> NDArray[np.void]:
    """States (m,) before the first sample, by parameters (m,)."""
    states = start(parameters, STATE)
    states["covariance_mu_c"] = parameters["p0"]
    states["covariance_r"] = parameters["p0"]
    return states


def filter_matrices(states: NDArray[np.void]) -> FilterMatrices:
    """Matrices of both regressions; they are independent, so gain and covariance are diagonal.

    The covariance is P [1/N^2], without the variance of the noise; `sd_mu_c` and `sd_r` include it.
    """
    pairs = {
        name: np.stack([states[f"{name}_mu_c"], states[f"{name}_r"]], axis=1)
        for name in ("innovation", "rls_gain", "covariance")
    }
    return FilterMatrices(
        residual=pairs["innovation"],
        gain=pairs["rls_gain"][:, :, None] * np.eye(2),
        covariance=pairs["covariance"][:, :, None] * np.eye(2),
    )


@njit
def _rls(theta, covariance, y, phi, p, low, high):
    """One scalar RLS step with forgetting for y = phi theta.

    Returns:
        theta within [low, high], its covariance P within covariance_limit p0, the innovation and the gain K.
        On overflow theta and P as they were, and zeros.
    """
    denominator = p.forgetting + phi * phi * covariance
    innovation = y - phi * theta
    if not (math.isfinite(denominator) and math.isfinite(innovation)):
        return theta, covariance, 0.0, 0.0
    gain = covariance * phi / denominator
    theta = theta + gain * innovation
    # P / (lambda + phi^2 P) is (1 - K phi) P / lambda without its cancellation: it cannot turn negative.
    covariance = min(covariance / denominator, p.covariance_limit * p.p0)
    return clamped(theta, low, high), covariance, innovation, gain


@njit
def _mean_square(mean_square, theta, covariance, y, phi, p, updates):
    """Mean square of the innovations, each normalised by its own spread, with the memory of the estimate."""
    innovation = y - phi * theta
    square = innovation * innovation * p.forgetting / (p.forgetting + phi * phi * covariance)
    weight = max(1.0 / (updates + 1.0), 1.0 - p.forgetting)
    updated = (1.0 - weight) * mean_square + weight * square
    return updated if math.isfinite(updated) else mean_square


@njit
def _stick_slip(state, p, f_t, f_n, gamma_t, speed, halted):
    """Algorithm 1: at each start and stop of slip, mu_s is the mean of the largest f_t / (gamma_t f_n).

    The state machine runs on every sample in contact; the gate on gamma_t and a halt only keep samples out of
    the buffer. An event with fewer than n_a buffered samples, or during a halt, does not change mu_s.
    """
    gate = gamma_t > p.eps_t
    if gate and not halted:
        append(state, p, f_t / (gamma_t * f_n))
    if p.machine_gated and not gate:
        return
    starts, stops = transition(state, p, speed <= p.stick_band, speed > p.eps_v)
    if starts or stops:
        if not halted and state.buffer_size >= p.n_a:
            learn_mu_s(state, take_event(state, p), 1.0, False)
        clear_buffer(state)


@njit
def _motion(state, p, f_t, f_n, tau, gamma_t, gamma_tau):
    """Motion regime: mu_c from (1), then r from (2) with the new mu_c; both gammas use the previous r.

    The standard deviation of each is the square root of its mean square of innovations times P.
    """
    if gamma_t > p.eps_t:
        phi = gamma_t * f_n
        state.mean_square_mu_c = _mean_square(
            state.mean_square_mu_c, state.mu_c, state.covariance_mu_c, f_t, phi, p, state.updates_mu_c
        )
        state.mu_c, state.covariance_mu_c, state.innovation_mu_c, state.rls_gain_mu_c = _rls(
            state.mu_c, state.covariance_mu_c, f_t, phi, p, p.mu_min, p.mu_max
        )
        state.sd_mu_c = math.sqrt(state.mean_square_mu_c * state.covariance_mu_c)
        count_mu_c(state, p)
    if gamma_tau > p.eps_tau:
        phi = gamma_tau * state.mu_c * f_n
        state.mean_square_r = _mean_square(
            state.mean_square_r, state.r, state.covariance_r, tau, phi, p, state.updates_r
        )
        state.r, state.covariance_r, state.innovation_r, state.rls_gain_r = _rls(
            state.r, state.covariance_r, tau, phi, p, p.r_min, p.r_max
        )
        state.sd_r = math.sqrt(state.mean_square_r * state.covariance_r)
        count_r(state, p)


@njit
def _update(state, p, t, wrench, twist, estimate):
    """One finger, one sample."""
    f_t = norm(wrench[0], wrench[1])
    f_n = wrench[2]
    tau = abs(wrench[3])
    v_t = norm(twist[0], twist[1])
    v_r = state.r * abs(twist[2])
    v = norm(v_t, v_r)
    if not readable(state, t, f_t, f_n, tau, v):
        return

    halted = False
    gamma_t, gamma_tau = 0.0, 0.0
    updates_mu_c, updates_r = state.updates_mu_c, state.updates_r
    if f_n >= p.eps_fn:
        halted = halts(state, p, f_n, t - state.t)
        if v > (p.eps_v if p.low_speed_gamma_from_force else p.stick_band):
            gamma_t, gamma_tau = direction_cosines(v_t, v_r)
        else:
            gamma_t, gamma_tau = direction_cosines(f_t, tau / state.r)
        _stick_slip(state, p, f_t, f_n, gamma_t, v_t if p.machine_gated else v, halted)
        if v > p.eps_v and not halted:
            _motion(state, p, f_t, f_n, tau, gamma_t, gamma_tau)
    else:
        lose_contact(state)
    saw_mu_c, saw_r = state.updates_mu_c > updates_mu_c, state.updates_r > updates_r
    publish(state, t, f_n, gamma_t, gamma_tau, halted, saw_mu_c, saw_r, estimate)


@entry_point(STATE, RlsParameters.dtype())
def update_batch(states, parameters, t, wrenches, twists, estimates):
    """Updates n fingers by one sample each; see `estimator.registry.Specification`."""
    for i in range(len(states)):
        p = parameters[min(i, len(parameters) - 1)]
        wrench = wrenches[i, 0], wrenches[i, 1], wrenches[i, 2], wrenches[i, 3]
        twist = twists[i, 0], twists[i, 1], twists[i, 2]
        _update(states[i], p, t, wrench, twist, estimates[i])


SPECIFICATION = Specification("rls", RlsParameters, initial_states, update_batch, filter_matrices)
