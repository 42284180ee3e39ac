"""The "joint" estimator: mu_c and r solved together from each instant of sliding, then averaged.

The limit surface gives two equations, f_t and tau, for both unknowns. Their ratio with the twist,
q = tau omega / (f_t v_t), is the position of the slip on the surface and contains neither mu_c nor r. On the
ellipsoid of Waltersson & Karayiannidis (ISER 2025), eqs. (1) and (2), the solution is

    r = sqrt(q) v_t / omega = sqrt(tau v_t / (f_t omega)),    mu_c = sqrt(1 + q) f_t / f_n;

on a uniform disc tabulated factors are added (`estimator.limit_surface.inverse`). No estimate enters the
equations or their gates, so no parameter can be locked out.

The values are averaged by weighted least squares with a fading memory. A sample enters with weight
w = 1 / (s^2 + l^2), with s the standard deviation of its noise and l the error of the friction law; every
update multiplies the older weights by lambda. Noise gives the result the covariance A^-1 B A^-1, where A sums
the weights and B their squares times s^2, both with their fading.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from estimator._numba.caching import njit
from estimator._numba.entry_point import entry_point
from estimator.limit_surface.inverse import slip_factors, spin_radius
from estimator.parameters import RADIUS, parameter
from estimator.registry import FilterMatrices, Specification
from estimator.sample import clamped, count_mu_c, count_r, norm
from estimator.sliding import SLIDING_STATE, SlidingParameters, close_sample, open_sample, slides, spins
from estimator.stick_slip import EVENT_STATE, start


@dataclass(frozen=True)
class JointParameters(SlidingParameters):
    """Those of every estimator that learns from true sliding, and its own.

    Each field's metadata holds its documentation, unit and valid interval.

    Raises:
        ValueError: A value has the wrong type, is NaN, lies outside its interval or contradicts another one.
    """

    pivot_limit: float = parameter(
        3.0, "Largest distance v_t / omega of the centre of rotation for r, in pad radii.", "(0, inf)"
    )
    sd_viscosity: float = parameter(
        0.2, "Spread of the viscous friction, about zero, before it is seen.", "(0, inf)", "s/m"
    )
    sd_mu_c0: float = parameter(1.0, "Standard deviation of mu_c0.", "(0, inf)")
    sd_r0: float = parameter(0.01, "Standard deviation of r0.", RADIUS, "m")


STATE = np.dtype(
    [
        *SLIDING_STATE,
        ("viscosity", np.float64),
        ("information", np.float64, (3,)),
        ("noise", np.float64, (3,)),
        ("vector", np.float64, (2,)),
        ("information_r", np.float64),
        ("noise_r", np.float64),
        *EVENT_STATE,
    ],
    align=True,
)
"""Weighted sums over samples (1, v) for (mu_c, viscosity): `information` is A (11, 12, 22), `noise` is B,
`vector` the right-hand side; `information_r` and `noise_r` are A and B of r."""


def initial_states(parameters: NDArray[np.void]) -> NDArray[np.void]:
    """States (m,) before the first sample, by parameters (m,)."""
    states = start(parameters, STATE)
    weight = 1.0 / parameters["sd_mu_c0"] ** 2
    states["information"][:, 0] = states["noise"][:, 0] = weight
    states["vector"][:, 0] = weight * parameters["mu_c0"]
    states["information_r"] = states["noise_r"] = 1.0 / parameters["sd_r0"] ** 2
    return states


def filter_matrices(states: NDArray[np.void]) -> FilterMatrices:
    """Covariance of (mu_c, r) [1, m^2]; diagonal, because the two are averaged separately."""
    deviations = np.stack([states["sd_mu_c"], states["sd_r"]], axis=1)
    return FilterMatrices(covariance=deviations[:, :, None] ** 2 * np.eye(2))


@njit
def _priors(p):
    """Information of the start values.

    Returns:
        For mu_c and r, the amount that refills a memory in one update; for the viscosity, all of it.
    """
    fading = 1.0 - p.forgetting
    return fading / p.sd_mu_c0**2, fading / p.sd_r0**2, 1.0 / p.sd_viscosity**2


@njit
def _learn_mu_c(state, p, prior, y, noise, v):
    """Updates mu_c and the viscosity from one measured friction y = mu_c + viscosity v.

    The viscosity keeps a prior of zero mean that does not fade. The information that fades is replaced, up to
    that of the start, by information about the present mu_c: poor samples cannot wind the memory down.

    `noise` is the relative variance of y. Returns whether mu_c was updated: not by a sample that overflows.
    """
    a, b, keep = state.information, state.noise, p.forgetting
    refill, _, of_viscosity = prior
    y_squared = y * y
    w = 1.0 / (y_squared * (noise + p.law_error * p.law_error))
    wv = w * v
    a_11, a_12, a_22 = keep * a[0] + w + refill, keep * a[1] + wv, keep * a[2] + wv * v
    y_1, y_2 = keep * state.vector[0] + w * y + refill * state.mu_c, keep * state.vector[1] + wv * y
    whole = a_22 + of_viscosity
    determinant = a_11 * whole - a_12 * a_12
    inverse = 1.0 / determinant
    mu_c = (whole * y_1 - a_12 * y_2) * inverse
    fade, spread = keep * keep, w * w * y_squared * noise
    b_11, b_12 = fade * b[0] + spread + refill, fade * b[1] + spread * v
    b_22 = fade * b[2] + spread * v * v
    g, h = whole * inverse, a_12 * inverse
    variance = max(g * g * b_11 - 2.0 * g * h * b_12 + h * h * b_22, 0.0)
    if not (math.isfinite(mu_c + variance + b_22) and 0.0 < determinant < math.inf and w > 0.0):
        return False
    state.viscosity = (a_11 * y_2 - a_12 * y_1) * inverse
    state.mu_c = clamped(mu_c, p.mu_min, p.mu_max)
    b[0], b[1], b[2] = b_11, b_12, b_22
    a[0], a[1], a[2] = a_11, a_12, a_22
    state.vector[0], state.vector[1] = y_1, y_2
    state.sd_mu_c = math.sqrt(variance)
    count_mu_c(state, p)
    return True


@njit
def _learn_r(state, p, prior, y, noise):
    """Updates r from one measured radius y [m] with the relative variance `noise`; returns whether it did."""
    _, refill, _ = prior
    y_squared = y * y
    w = 1.0 / (y_squared * (noise + p.law_error * p.law_error))
    information = p.forgetting * state.information_r + w + refill
    spread = p.forgetting * p.forgetting * state.noise_r + w * w * y_squared * noise + refill
    if not (math.isfinite(information) and math.isfinite(spread) and w > 0.0 and math.isfinite(y)):
        return False
    inverse = 1.0 / information
    state.r = clamped(state.r + w * inverse * (y - state.r), p.r_min, p.r_max)
    state.information_r = information
    state.noise_r = spread
    state.sd_r = math.sqrt(state.noise_r) * inverse
    count_r(state, p)
    return True


@njit
def _square(x):
    return x * x


@njit
def _slide(state, p, prior, instant, near):
    """Learns mu_c from a slide, and r if the object also spins about a centre that is `near`.

    With c = d ln mu_c / d ln(1 + q) and a = c q / (1 + q), the derivatives of ln mu_c are 1 - a by ln f_t,
    a by ln tau and ln omega, -a by ln v_t, -1 by ln f_n. With b = d ln r / d ln q, those of ln r are b by
    ln tau, -b by ln f_t, 1 - b by ln v_t, b - 1 by ln omega.

    Returns:
        Whether mu_c, and whether r, was updated.
    """
    f_t, f_n, tau, v_t, omega, of_speed, of_spin = instant
    per_f, per_v, per_n = 1.0 / f_t, 1.0 / v_t, 1.0 / f_n
    per_power = per_f * per_v
    q = tau * omega * per_power
    if not q < math.inf:
        return False, False
    s = 1.0 / (1.0 + q)
    friction, c, radius, b = slip_factors(p.disc, s)
    a, size = c * (1.0 - s), friction * math.sqrt(1.0 + q)
    of_force, of_speed = _square(p.sd_force * per_f), of_speed * _square(per_v)
    noise = (
        _square(1.0 - a) * of_force
        + _square(a) * of_speed
        + _square(p.sd_normal * per_n)
        + _square(c * s * per_power) * (_square(omega * p.sd_torque) + _square(tau) * of_spin)
    )
    saw_mu_c = _learn_mu_c(state, p, prior, f_t * per_n * size, noise, v_t * size)
    if not near:
        return saw_mu_c, False
    per_omega = 1.0 / omega
    noise = _square(b) * (of_force + _square(p.sd_torque / tau)) + _square(1.0 - b) * (
        of_speed + of_spin * _square(per_omega)
    )
    return saw_mu_c, _learn_r(state, p, prior, radius * math.sqrt(q) * v_t * per_omega, noise)


@njit
def _spin(state, p, prior, instant):
    """Learns r from tau and the present mu_c, if only a spin is seen; returns whether r was updated."""
    _, f_n, tau, v_t, omega, _, _ = instant
    friction = max(state.mu_c + state.viscosity * norm(v_t, state.r * omega), p.mu_min)
    y = spin_radius(p.disc, tau / (friction * f_n), v_t / omega)
    noise = _square(p.sd_torque / tau) + _square(p.sd_normal / f_n) + _square(state.sd_mu_c / friction)
    return _learn_r(state, p, prior, y, noise)


@njit
def _motion(state, p, prior, instant):
    """Learns from one instant of sliding, as far as its signals are above their noise.

    Returns:
        Whether mu_c, and whether r, was updated.
    """
    f_t, _, tau, v_t, omega, _, _ = instant
    spin = spins(p, tau, omega)
    if slides(p, f_t, v_t):
        return _slide(state, p, prior, instant, spin and v_t < p.pivot_limit * p.r_max * omega)
    return False, spin and state.updates_mu_c > 0 and _spin(state, p, prior, instant)


@njit
def _update(state, p, prior, t, wrench, twist, estimate):
    """One finger, one sample."""
    taken, halted, slid, instant, seen = open_sample(state, p, t, wrench, twist)
    if taken:
        saw_mu_c, saw_r = _motion(state, p, prior, instant) if slid else (False, False)
        close_sample(state, p, t, seen, halted, saw_mu_c, saw_r, estimate)


@entry_point(STATE, JointParameters.dtype())
def update_batch(states, parameters, t, wrenches, twists, estimates):
    """Updates n fingers by one sample each; see `estimator.registry.Specification`."""
    p = parameters[0]
    prior = _priors(p)
    for i in range(len(states)):
        if 0 < i < len(parameters):
            p = parameters[i]
            prior = _priors(p)
        wrench = wrenches[i, 0], wrenches[i, 1], wrenches[i, 2], wrenches[i, 3]
        twist = twists[i, 0], twists[i, 1], twists[i, 2]
        _update(states[i], p, prior, t, wrench, twist, estimates[i])


SPECIFICATION = Specification("joint", JointParameters, initial_states, update_batch, filter_matrices)
