"""One step of the iterated extended Kalman filter of "adaptive": three measurements, ten states.

Source: Bell & Cathey, The iterated Kalman filter update as a Gauss-Newton method, IEEE Transactions on
Automatic Control 38(2), 1993. The noise of the twist, of the normal force and of the law of friction enters
the covariance of the measurement by its effect on it.
"""

import math

import numpy as np

from estimator._numba.caching import njit
from estimator.augmented.slip_law import COP, MU, SHAPE, SIGMA, STATES, TILT, ZERO, R, predict_at

ITERATIONS = 4
"""Linearisations while mu_c or r is hardly known."""

ABSURD = 1e6
"""Size of a state, in its unit, from which a step is refused."""

MOST = 1.0 - 1e-5
"""Fraction of a variance that one step may remove: more would leave only rounding errors."""

KNOWN = 0.01
"""Variance of ln mu_c and ln r from which one linearisation is enough."""


@njit(error_model="numpy")
def working_arrays():
    """Arrays that one step needs: (3, 10) derivatives and covariances, (3, 3) derivatives, (10,) states."""
    return np.zeros((3, STATES)), np.zeros((3, STATES)), np.zeros((3, 3)), np.zeros(STATES)


@njit(error_model="numpy")
def measurement_noise(p, by_twist, f_x, f_y, tau, f_n, of_speed, of_spin):
    """Covariance (11, 12, 13, 22, 23, 33) of the measured f_x, f_y, tau about the law.

    Args:
        p: Parameters.
        by_twist: (3, 3), derivatives of f_x, f_y, tau by the twist.
        f_x: Force by the law [N].
        f_y: As f_x.
        tau: Torque by the law [N m].
        f_n: Normal force [N].
        of_speed: Variance of v_x and of v_y.
        of_spin: Variance of omega.
    """
    normal = (p.sd_normal / f_n) ** 2
    law = p.law_error * p.law_error
    force = p.sd_force * p.sd_force + law * (f_x * f_x + f_y * f_y)
    torque = p.sd_torque * p.sd_torque + law * tau * tau
    a, b, c = by_twist[0], by_twist[1], by_twist[2]
    return (
        force + normal * f_x * f_x + of_speed * (a[0] * a[0] + a[1] * a[1]) + of_spin * a[2] * a[2],
        normal * f_x * f_y + of_speed * (a[0] * b[0] + a[1] * b[1]) + of_spin * a[2] * b[2],
        normal * f_x * tau + of_speed * (a[0] * c[0] + a[1] * c[1]) + of_spin * a[2] * c[2],
        force + normal * f_y * f_y + of_speed * (b[0] * b[0] + b[1] * b[1]) + of_spin * b[2] * b[2],
        normal * f_y * tau + of_speed * (b[0] * c[0] + b[1] * c[1]) + of_spin * b[2] * c[2],
        torque + normal * tau * tau + of_speed * (c[0] * c[0] + c[1] * c[1]) + of_spin * c[2] * c[2],
    )


@njit
def _limit(x, limits):
    """Keeps ln mu_c and ln r in their bounds."""
    x[MU] = min(max(x[MU], limits[0]), limits[1])
    x[R] = min(max(x[R], limits[2]), limits[3])


@njit(error_model="numpy")
def _inverse(a, b, c, d, e, f):
    """Inverse (11, 12, 13, 22, 23, 33) of a symmetric matrix that is given in the same way."""
    i, j, k = d * f - e * e, c * e - b * f, b * e - c * d
    scale = 1.0 / (a * i + b * j + c * k)
    return (
        i * scale,
        j * scale,
        k * scale,
        (a * f - c * c) * scale,
        (b * c - a * e) * scale,
        (a * d - b * b) * scale,
    )


@njit(error_model="numpy")
def _quadratic(m, x, y, z):
    """The vector (x, y, z) in the quadratic form of m."""
    return x * (m[0] * x + 2.0 * (m[1] * y + m[2] * z)) + y * (m[3] * y + 2.0 * m[4] * z) + m[5] * z * z


@njit(error_model="numpy")
def learn(state, scratch, p, sign, wrench, twist, of_speed, of_spin):
    """Moves the states by one measurement of a slip; a step that is not finite is refused.

    A measurement whose squared normalised innovation exceeds `p.outlier` gets as much more noise.

    Args:
        state: Record with `x`, `covariance`, `limits` and `smooth`; changed in place.
        scratch: Working arrays, from `working_arrays`.
        p: Parameters.
        sign: As in `predict`.
        wrench: f_x, f_y, f_n, tau [N, N, N, N m].
        twist: v_x, v_y, omega [m/s, m/s, rad/s].
        of_speed: Variance of v_x and of v_y.
        of_spin: Variance of omega.

    Returns:
        Whether the states moved, the squared normalised innovation [-] and the normalised innovation in the
        direction of mu_c, positive if mu_c seems too small [-].
    """
    x, covariance = state.x, state.covariance
    h, crossed, by_twist, proposed = scratch
    f_n = wrench[2]
    uncertain = covariance[0, 0] > KNOWN or covariance[1, 1] > KNOWN
    for j in range(STATES):
        proposed[j] = x[j]
    squared, score = 0.0, 0.0
    smooth = state.smooth
    for iteration in range(ITERATIONS if uncertain else 1):
        mu, r = math.exp(proposed[MU]), math.exp(proposed[R])
        f_x, f_y, tau = predict_at(
            proposed, mu, r, sign, f_n, twist[0], twist[1], twist[2], False, h, by_twist
        )
        n_11, n_12, n_13, n_22, n_23, n_33 = measurement_noise(
            p, by_twist, h[0, MU], h[1, MU], h[2, MU], f_n, of_speed, of_spin
        )
        y_1, y_2, y_3 = wrench[0] - f_x, wrench[1] - f_y, wrench[3] - tau
        predict_at(proposed, mu, r, sign, smooth[3], smooth[0], smooth[1], smooth[2], True, h, by_twist)
        s_11, s_12, s_13, s_22, s_23, s_33 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for j in range(STATES):
            back = x[j] - proposed[j]
            y_1, y_2, y_3 = y_1 - h[0, j] * back, y_2 - h[1, j] * back, y_3 - h[2, j] * back
            row = covariance[j]
            a, b, c = row[ZERO] + smooth[3] * row[TILT], row[ZERO + 1] + smooth[3] * row[TILT + 1], 0.0
            for k in range(SIGMA + 1):
                a += row[k] * h[0, k]
                b += row[k] * h[1, k]
                c += row[k] * h[2, k]
            for k in range(COP, SHAPE + 1):
                a += row[k] * h[0, k]
                b += row[k] * h[1, k]
                c += row[k] * h[2, k]
            crossed[0, j], crossed[1, j], crossed[2, j] = a, b, c
            s_11, s_12, s_13 = s_11 + h[0, j] * a, s_12 + h[0, j] * b, s_13 + h[0, j] * c
            s_22, s_23, s_33 = s_22 + h[1, j] * b, s_23 + h[1, j] * c, s_33 + h[2, j] * c
        m = _inverse(s_11 + n_11, s_12 + n_12, s_13 + n_13, s_22 + n_22, s_23 + n_23, s_33 + n_33)
        current = _quadratic(m, y_1, y_2, y_3)
        if iteration == 0:
            squared = current
            z_1 = m[0] * y_1 + m[1] * y_2 + m[2] * y_3
            z_2 = m[1] * y_1 + m[3] * y_2 + m[4] * y_3
            z_3 = m[2] * y_1 + m[4] * y_2 + m[5] * y_3
            score = (h[0, MU] * z_1 + h[1, MU] * z_2 + h[2, MU] * z_3) / math.sqrt(
                _quadratic(m, h[0, MU], h[1, MU], h[2, MU])
            )
        if current > p.outlier:
            excess = current / p.outlier
            m = _inverse(
                s_11 + excess * n_11,
                s_12 + excess * n_12,
                s_13 + excess * n_13,
                s_22 + excess * n_22,
                s_23 + excess * n_23,
                s_33 + excess * n_33,
            )
        z_1 = m[0] * y_1 + m[1] * y_2 + m[2] * y_3
        z_2 = m[1] * y_1 + m[3] * y_2 + m[4] * y_3
        z_3 = m[2] * y_1 + m[4] * y_2 + m[5] * y_3
        for j in range(STATES):
            proposed[j] = x[j] + crossed[0, j] * z_1 + crossed[1, j] * z_2 + crossed[2, j] * z_3
        _limit(proposed, state.limits)
    if not (math.isfinite(squared) and math.isfinite(score)):
        return False, 0.0, 0.0
    for j in range(STATES):
        a, b, c = crossed[0, j], crossed[1, j], crossed[2, j]
        removed = _quadratic(m, a, b, c)
        if not (abs(proposed[j]) < ABSURD and 0.0 <= removed < MOST * covariance[j, j]):
            return False, 0.0, 0.0
    for j in range(STATES):
        a, b, c = crossed[0, j], crossed[1, j], crossed[2, j]
        z_1 = m[0] * a + m[1] * b + m[2] * c
        z_2 = m[1] * a + m[3] * b + m[4] * c
        z_3 = m[2] * a + m[4] * b + m[5] * c
        for k in range(j, STATES):
            value = covariance[j, k] - (z_1 * crossed[0, k] + z_2 * crossed[1, k] + z_3 * crossed[2, k])
            covariance[j, k] = value
            covariance[k, j] = value
        x[j] = proposed[j]
    return True, squared, score
