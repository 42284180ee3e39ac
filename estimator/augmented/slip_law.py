"""Wrench of a slip as a vector, with its derivatives by every unknown: the measurement model of "adaptive".

With the slip velocity v_c at the true centre of pressure c, the scaled speed w = sqrt(v_c^2 + r^2 omega^2)
and s = (v_c / w)^2, friction at the normal force f_n is

    f = f_n (mu_c Phi(s) / w + sigma_2) v_c,    tau = f_n (mu_c Psi(s) / w + 9/8 sigma_2) r^2 omega.

mu_c stands for friction at the speed w, see `estimator.augmented.stribeck`. Phi = Psi = 1 is the ellipsoid of
Waltersson & Karayiannidis (arXiv 2507.06824, eqs. 1-2); a uniform disc has the functions tabulated here from
its exact limit surface. 9/8 r^2 is its mean squared radius. The form is linear in v_c close to pure spin,
where the norm f_t and the direction of v_c would be dominated by noise.
"""

import math

import numpy as np

from estimator._numba.caching import fused
from estimator._numba.uncompiled import uncompiled
from estimator.augmented.stribeck import level
from estimator.limit_surface.disc import DISC_RADIUS, disc_friction

MU, R, SIGMA, ZERO, TILT, COP, SHAPE, FALLS, GROWS = 0, 1, 2, 3, 5, 7, 9, 10, 11
"""Index of ln mu_c, ln r, sigma_2 [s/m], zero error (2) [N], tilt (2) [rad], centre of pressure (2) [mm],
shape of the limit surface (0: uniform disc, 1: ellipsoid) and the exponents of the normal force with which
mu_c falls and r grows in the state vector."""

STATES = 12
MILLIMETRE = 1e-3
MEAN_SQUARE_RADIUS = 1.125
"""Mean squared radius of a uniform disc in units of r^2, r = 2/3 of its radius."""

_INTERVALS = 512


def _table() -> np.ndarray:
    """Phi, its derivative, Psi, its derivative by s, at evenly spaced s in [0, 1]; (knots, 4)."""
    knots = np.linspace(0.0, 1.0, _INTERVALS + 1)
    inner = knots[1:-1]
    ratio = DISC_RADIUS * np.sqrt(inner / (1.0 - inner))
    force, torque = np.array([*map(uncompiled(disc_friction), ratio.tolist())]).T
    phi = np.concatenate([[DISC_RADIUS], force / np.sqrt(inner), [1.0]])
    psi = np.concatenate([[1.0], torque / (DISC_RADIUS * np.sqrt(1.0 - inner)), [0.25 / DISC_RADIUS**2]])
    return np.column_stack([phi, np.gradient(phi, knots), psi, np.gradient(psi, knots)])


_TABLE = _table()


@fused
def surface(s, shape):
    """Phi, its derivative by s, Psi, its derivative, and the derivatives of Phi and Psi by the shape.

    Args:
        s: (v_c / w)^2 in [0, 1].
        shape: 0 for a uniform disc, 1 for the ellipsoid.
    """
    at = min(int(s * _INTERVALS), _INTERVALS - 1)
    x = s * _INTERVALS - at
    low, high = _TABLE[at], _TABLE[at + 1]
    phi, d_phi = low[0] + x * (high[0] - low[0]), low[1] + x * (high[1] - low[1])
    psi, d_psi = low[2] + x * (high[2] - low[2]), low[3] + x * (high[3] - low[3])
    rest = 1.0 - shape
    return shape + rest * phi, rest * d_phi, shape + rest * psi, rest * d_psi, 1.0 - phi, 1.0 - psi


@fused
def predict(p, x, static, seen, sign, f_n, v_x, v_y, omega, by_state, by_twist):
    """Measured (f_x, f_y, tau) [N, N, N m] that the states explain.

    Args:
        p: Parameters.
        x: (12,) states.
        static: First of `stribeck.static_friction`: slow slips have a part of mu_s.
        seen: Second of it.
        sign: 1 if the wrench is that on the finger, -1 if on the object.
        f_n: Normal force [N].
        v_x: Slip velocity at the assumed centre of pressure [m/s].
        v_y: As v_x.
        omega: Slip rate [rad/s].
        by_state: Output (3, 12), derivatives by x. Those by the exponents are 0 and not written.
        by_twist: Output (3, 3), derivatives by v_x, v_y, omega.

    Returns:
        f_x, f_y, tau, and the derivatives of the logarithm of dry friction by ln mu_s and ln v_s.
    """
    mu, r = math.exp(x[MU]), math.exp(x[R])
    c_x, c_y = MILLIMETRE * x[COP], MILLIMETRE * x[COP + 1]
    u_x, u_y = v_x - omega * c_y, v_y + omega * c_x
    rim = r * omega
    square = u_x * u_x + u_y * u_y + rim * rim
    w = math.sqrt(square)
    s = (u_x * u_x + u_y * u_y) / square
    phi, d_phi, psi, d_psi, phi_shape, psi_shape = surface(s, x[SHAPE])
    friction, of_mu, of_static, of_v_s = level(p, static, seen, x[MU], square)
    dry, viscous = sign * mu * friction * f_n / w, sign * x[SIGMA] * f_n
    r_2 = r * r
    g, k = dry * phi, dry * psi * r_2  # f = (g + viscous) u, tau = (k + viscous 9/8 r^2) omega
    force, turn = g + viscous, k + viscous * MEAN_SQUARE_RADIUS * r_2
    f_x, f_y, tau = force * u_x, force * u_y, turn * omega
    # relative changes of g and k with the slip velocity (times u), with omega and with ln r
    a, b = 2.0 * (1.0 - s) * d_phi / phi, 2.0 * (1.0 - s) * d_psi / psi
    g_u, k_u = g * (a - 1.0 - of_v_s) / square, k * (b - 1.0 - of_v_s) / square
    a, b = 2.0 * s * d_phi / phi + 1.0 + of_v_s, 2.0 * s * d_psi / psi + 1.0 + of_v_s
    turned = (1.0 - s) if omega != 0.0 else 0.0
    g_r, k_r = -g * a * turned, k * (2.0 - b * turned) + 2.0 * (turn - k)
    spin = r_2 * omega / square
    by_twist[0, 0], by_twist[0, 1] = force + g_u * u_x * u_x, g_u * u_x * u_y
    by_twist[1, 0], by_twist[1, 1] = by_twist[0, 1], force + g_u * u_y * u_y
    by_twist[2, 0], by_twist[2, 1] = k_u * u_x * omega, k_u * u_y * omega
    by_twist[0, 2], by_twist[1, 2] = -g * a * spin * u_x, -g * a * spin * u_y
    by_twist[2, 2] = turn - k * b * spin * omega
    for i in range(3):
        by_twist[i, 2] += c_x * by_twist[i, 1] - c_y * by_twist[i, 0]
    by_state[0, MU], by_state[1, MU] = of_mu * g * u_x, of_mu * g * u_y
    by_state[2, MU] = of_mu * k * omega + c_x * by_state[1, MU] - c_y * by_state[0, MU]
    load = sign * f_n
    by_state[0, R], by_state[1, R], by_state[2, R] = g_r * u_x, g_r * u_y, k_r * omega
    by_state[0, SIGMA], by_state[1, SIGMA] = load * u_x, load * u_y
    by_state[2, SIGMA] = load * MEAN_SQUARE_RADIUS * r_2 * omega
    for i in range(3):
        by_state[i, COP] = MILLIMETRE * omega * by_twist[i, 1]
        by_state[i, COP + 1] = -MILLIMETRE * omega * by_twist[i, 0]
    by_state[0, SHAPE], by_state[1, SHAPE] = dry * phi_shape * u_x, dry * phi_shape * u_y
    by_state[2, SHAPE] = dry * psi_shape * r_2 * omega
    # the torque is measured about the assumed centre of pressure
    for j in range(R, SIGMA + 1):
        by_state[2, j] += c_x * by_state[1, j] - c_y * by_state[0, j]
    for j in range(COP, SHAPE + 1):
        by_state[2, j] += c_x * by_state[1, j] - c_y * by_state[0, j]
    by_state[2, COP] += MILLIMETRE * f_y
    by_state[2, COP + 1] -= MILLIMETRE * f_x
    by_state[0, ZERO], by_state[1, ZERO + 1] = 1.0, 1.0
    by_state[0, TILT], by_state[1, TILT + 1] = f_n, f_n
    for j in range(3):
        by_twist[2, j] += c_x * by_twist[1, j] - c_y * by_twist[0, j]
    zero_x, zero_y = x[ZERO] + f_n * x[TILT], x[ZERO + 1] + f_n * x[TILT + 1]
    return f_x + zero_x, f_y + zero_y, tau + c_x * f_y - c_y * f_x, of_static, of_v_s


@fused
def without(y_1, y_2, y_3, by_state, f_n, states):
    """Three measurements less what changes of the states add to them by the linear model.

    Args:
        y_1: Of f_x [N].
        y_2: Of f_y [N].
        y_3: Of tau [N m].
        by_state: (3, 12), from `predict`. Those by zero error and tilt, 1 and f_n, are not read.
        f_n: Normal force [N].
        states: (12,) changes.
    """
    for j in range(SIGMA + 1):
        v = states[j]
        y_1, y_2, y_3 = y_1 - by_state[0, j] * v, y_2 - by_state[1, j] * v, y_3 - by_state[2, j] * v
    y_1, y_2 = y_1 - states[ZERO], y_2 - states[ZERO + 1]
    y_1 -= f_n * states[TILT]
    y_2 -= f_n * states[TILT + 1]
    for j in range(COP, SHAPE + 1):
        v = states[j]
        y_1, y_2, y_3 = y_1 - by_state[0, j] * v, y_2 - by_state[1, j] * v, y_3 - by_state[2, j] * v
    return y_1, y_2, y_3
