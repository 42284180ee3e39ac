"""One step of the iterated extended Kalman filter of "adaptive": three measurements, twelve states.

Source: Bell & Cathey, The iterated Kalman filter update as a Gauss-Newton method, IEEE Transactions on
Automatic Control 38(2), 1993. Noise of the twist, the normal force and the law enters the covariance of the
measurement by its effect on it. Close to the pivot of a slip the twist's noise turns its direction: there the
twist is an unknown, too, and the next linearisation is at the most probable one.
"""

import math

from estimator._numba.caching import fused
from estimator._numba.memory import matrix
from estimator.augmented.law_error import found_square, surprise
from estimator.augmented.likelihood_ratio import respond
from estimator.augmented.load import confine, limit
from estimator.augmented.slip_law import COP, MU, SHAPE, SIGMA, STATES, TILT, ZERO, R, predict, without
from estimator.augmented.stribeck import law_variance, static_friction
from estimator.augmented.whitening import weighted, whitened, whitening

ITERATIONS = 4
"""Linearisations while mu_c or r is hardly known."""

BARELY = 0.05
"""Part of the way to the corrected twist below which another linearisation there is not worth its time."""

ENOUGH = 1e-4
"""Error of a linearisation, over the standard deviation of the state, after which no further one is made."""

ABSURD = 1e6
"""Size of a state, in its unit, from which a step is refused."""

MOST = 1.0 - 1e-5
"""Fraction of a variance that one step may remove: more would leave only rounding errors."""

KNOWN = 0.01
"""Variance of ln mu_c and ln r from which one linearisation is enough."""


@fused
def measurement_noise(p, by_twist, f_x, f_y, tau, f_n, of_speed, of_spin, of_law, law_square):
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
        of_law: Variance of the logarithm of all three by the law.
        law_square: Variance of the logarithm of each by the law, on its own.
    """
    normal = (p.sd_normal / f_n) ** 2 + of_law
    force = p.sd_force * p.sd_force + law_square * (f_x * f_x + f_y * f_y)
    torque = p.sd_torque * p.sd_torque + law_square * tau * tau
    a, b, c = by_twist[0], by_twist[1], by_twist[2]
    return (
        force + normal * f_x * f_x + of_speed * (a[0] * a[0] + a[1] * a[1]) + of_spin * a[2] * a[2],
        normal * f_x * f_y + of_speed * (a[0] * b[0] + a[1] * b[1]) + of_spin * a[2] * b[2],
        normal * f_x * tau + of_speed * (a[0] * c[0] + a[1] * c[1]) + of_spin * a[2] * c[2],
        force + normal * f_y * f_y + of_speed * (b[0] * b[0] + b[1] * b[1]) + of_spin * b[2] * b[2],
        normal * f_y * tau + of_speed * (b[0] * c[0] + b[1] * c[1]) + of_spin * b[2] * c[2],
        torque + normal * tau * tau + of_speed * (c[0] * c[0] + c[1] * c[1]) + of_spin * c[2] * c[2],
    )


@fused
def _cross(covariance, h, f_n, crossed):
    """Covariances of the states with the measurements.

    The loop over the states has no sum in it and reads rows, so that it computes several states at once.

    Args:
        covariance: (12, 12), symmetric.
        h: (3, 12), derivatives of the measurements. Those by zero error and tilt, 1 and f_n, are not read.
        f_n: Normal force [N].
        crossed: Output (3, 12).
    """
    for j in range(STATES):
        a = covariance[ZERO, j] + f_n * covariance[TILT, j]
        b, c = covariance[ZERO + 1, j] + f_n * covariance[TILT + 1, j], 0.0
        for k in range(SIGMA + 1):
            a += covariance[k, j] * h[0, k]
            b += covariance[k, j] * h[1, k]
            c += covariance[k, j] * h[2, k]
        for k in range(COP, SHAPE + 1):
            a += covariance[k, j] * h[0, k]
            b += covariance[k, j] * h[1, k]
            c += covariance[k, j] * h[2, k]
        crossed[0, j], crossed[1, j], crossed[2, j] = a, b, c


@fused
def _spread(h, crossed, f_n):
    """Covariance (11, 12, 13, 22, 23, 33) of the measurements by that of the states; see `_cross`."""
    s_11, s_12, s_13, s_22, s_23, s_33 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for j in range(SIGMA + 1):
        a, b, c = crossed[0, j], crossed[1, j], crossed[2, j]
        s_11, s_12, s_13 = s_11 + h[0, j] * a, s_12 + h[0, j] * b, s_13 + h[0, j] * c
        s_22, s_23, s_33 = s_22 + h[1, j] * b, s_23 + h[1, j] * c, s_33 + h[2, j] * c
    s_11, s_12, s_13 = s_11 + crossed[0, ZERO], s_12 + crossed[1, ZERO], s_13 + crossed[2, ZERO]
    s_22, s_23 = s_22 + crossed[1, ZERO + 1], s_23 + crossed[2, ZERO + 1]
    s_11 += f_n * crossed[0, TILT]
    s_12, s_13 = s_12 + f_n * crossed[1, TILT], s_13 + f_n * crossed[2, TILT]
    s_22, s_23 = s_22 + f_n * crossed[1, TILT + 1], s_23 + f_n * crossed[2, TILT + 1]
    for j in range(COP, SHAPE + 1):
        a, b, c = crossed[0, j], crossed[1, j], crossed[2, j]
        s_11, s_12, s_13 = s_11 + h[0, j] * a, s_12 + h[0, j] * b, s_13 + h[0, j] * c
        s_22, s_23, s_33 = s_22 + h[1, j] * b, s_23 + h[1, j] * c, s_33 + h[2, j] * c
    return s_11, s_12, s_13, s_22, s_23, s_33


@fused
def _settled(step, variance):
    """Whether another linearisation would move ln mu_c or ln r by less than `ENOUGH` of its deviation.

    Args:
        step: Step of ln mu_c or ln r by the last one; the law is off by half its square there.
        variance: Of ln mu_c or ln r before the measurement.
    """
    change = 0.5 * step * step
    return change * change <= ENOUGH * ENOUGH * variance


@fused
def _reduce(x, covariance, w, crossed, proposed):
    """Takes the proposed states and their covariance, unless a number is absurd; whether it did.

    Args:
        x: (12,) states, changed in place.
        covariance: (12, 12), changed in place; it stays symmetric bit for bit.
        w: `whitening` of the innovations' covariance.
        crossed: (3, 12), covariances of states and innovations.
        proposed: (12,) new states.
    """
    white, sound = matrix(3, STATES), True
    for j in range(STATES):
        a, b, c = whitened(w, crossed[0, j], crossed[1, j], crossed[2, j])
        removed = a * a + b * b + c * c
        sound &= (abs(proposed[j]) < ABSURD) & (removed < MOST * covariance[j, j])
        white[0, j], white[1, j], white[2, j] = a, b, c
    if not sound:
        return False
    for k in range(STATES):
        a, b, c = white[0, k], white[1, k], white[2, k]
        for j in range(STATES):  # along a row, so that several columns are computed at once
            covariance[k, j] -= a * white[0, j] + b * white[1, j] + c * white[2, j]
    for j in range(STATES):
        x[j] = proposed[j]
    return True


@fused
def _corrected(by_twist, twist, of_speed, of_spin, z_1, z_2, z_3):
    """Twist that the measured one and the wrench together make most probable.

    Args:
        by_twist: (3, 3), derivatives of f_x, f_y, tau by the twist.
        twist: Measured v_x, v_y, omega [m/s, m/s, rad/s].
        of_speed: Variance of v_x and of v_y.
        of_spin: Variance of omega.
        z_1: First innovation, weighted by the inverse of the innovations' covariance.
        z_2: As z_1.
        z_3: As z_1.
    """
    return (
        twist[0] + of_speed * (by_twist[0, 0] * z_1 + by_twist[1, 0] * z_2 + by_twist[2, 0] * z_3),
        twist[1] + of_speed * (by_twist[0, 1] * z_1 + by_twist[1, 1] * z_2 + by_twist[2, 1] * z_3),
        twist[2] + of_spin * (by_twist[0, 2] * z_1 + by_twist[1, 2] * z_2 + by_twist[2, 2] * z_3),
    )


@fused
def learn(state, p, sign, wrench, twist, of_speed, of_spin, scatter, fresh):
    """Moves the states by one measurement of a slip; a step that is not finite is refused.

    The law is linear about the mean of recent twists, or, as far as `fresh`, about the twist that the wrench
    has corrected. A measurement whose squared normalised innovation exceeds `p.outlier` gets as much more
    noise.

    Args:
        state: Record with `x`, `covariance`, `limits`, `smooth`, `law_square` and the hypothesis of a change;
            changed in place.
        p: Parameters.
        sign: As in `predict`.
        wrench: f_x, f_y, f_n, tau [N, N, N, N m].
        twist: v_x, v_y, omega [m/s, m/s, rad/s].
        of_speed: Variance of v_x and of v_y.
        of_spin: Variance of omega.
        scatter: From `twist_scatter`; both variances contain it.
        fresh: Part of the way from the mean of recent twists to the corrected one, in [0, 1].

    Returns:
        Whether the states moved, the squared normalised innovation [-], the normalised innovation in the
        direction of mu_c, positive if mu_c seems too small [-], and the variance of ln mu_c there.
    """
    x, covariance = state.x, state.covariance
    h, crossed, by_twist = matrix(3, STATES), matrix(3, STATES), matrix(3, 3)
    proposed, back = matrix(1, STATES)[0], matrix(1, STATES)[0]
    f_n = wrench[2]
    unsure = covariance[0, 0] > KNOWN or covariance[1, 1] > KNOWN
    for j in range(STATES):
        proposed[j] = x[j]
    squared, score, variance, unexplained = 0.0, 0.0, 0.0, 0.0
    v_x, v_y, omega, n = state.smooth[0], state.smooth[1], state.smooth[2], state.smooth[3]
    more, again = f_n / n, unsure or fresh > BARELY
    static, seen, of_mu_s = static_friction(state, p)
    for iteration in range(ITERATIONS if again else 1):
        f_x, f_y, tau, of_static, of_v_s = predict(
            p, proposed, static, seen, sign, n, v_x, v_y, omega, h, by_twist
        )
        of_law = law_variance(p, of_mu_s, of_static, of_v_s)
        dry = 1.0 / (1.0 - seen * of_static)  # friction over its derivative by ln mu_c
        n_11, n_12, n_13, n_22, n_23, n_33 = measurement_noise(
            p,
            by_twist,
            dry * h[0, MU],
            dry * h[1, MU],
            dry * h[2, MU],
            n,
            of_speed,
            of_spin,
            of_law,
            state.law_square,
        )
        y_1 = wrench[0] - proposed[ZERO] - more * (f_x - proposed[ZERO])
        y_2 = wrench[1] - proposed[ZERO + 1] - more * (f_y - proposed[ZERO + 1])
        y_3 = wrench[3] - more * tau
        for j, off in enumerate((twist[0] - v_x, twist[1] - v_y, twist[2] - omega)):
            a, b, c = by_twist[0, j] * off, by_twist[1, j] * off, by_twist[2, j] * off
            y_1, y_2, y_3 = y_1 - a, y_2 - b, y_3 - c
        for j in range(STATES):
            back[j] = x[j] - proposed[j]
        y_1, y_2, y_3 = without(y_1, y_2, y_3, h, n, back)  # of the linear model at the states before
        _cross(covariance, h, n, crossed)
        s_11, s_12, s_13, s_22, s_23, s_33 = _spread(h, crossed, n)
        w = whitening(s_11 + n_11, s_12 + n_12, s_13 + n_13, s_22 + n_22, s_23 + n_23, s_33 + n_33)
        a, b, c = whitened(w, y_1, y_2, y_3)
        current = a * a + b * b + c * c
        if iteration == 0:
            squared = current
            u, v, z = whitened(w, h[0, MU], h[1, MU], h[2, MU])
            variance = 1.0 / (u * u + v * v + z * z)
            score = (u * a + v * b + z * c) * math.sqrt(variance)
        if current > p.outlier:
            excess = current / p.outlier
            w = whitening(
                s_11 + excess * n_11,
                s_12 + excess * n_12,
                s_13 + excess * n_13,
                s_22 + excess * n_22,
                s_23 + excess * n_23,
                s_33 + excess * n_33,
            )
            a, b, c = whitened(w, y_1, y_2, y_3)
        z_1, z_2, z_3 = weighted(w, a, b, c)
        if iteration == 0:
            unexplained = surprise(h, dry, by_twist, scatter[0], scatter[1], w, z_1, z_2, z_3)
        if again:
            at_x, at_y, spin = _corrected(by_twist, twist, of_speed, of_spin, z_1, z_2, z_3)
            v_x, v_y = v_x + fresh * (at_x - v_x), v_y + fresh * (at_y - v_y)
            omega += fresh * (spin - omega)
        before_mu, before_r = proposed[MU], proposed[R]
        for j in range(STATES):
            proposed[j] = x[j] + crossed[0, j] * z_1 + crossed[1, j] * z_2 + crossed[2, j] * z_3
        confine(proposed, state.limits)
        settled = _settled(proposed[MU] - before_mu, covariance[MU, MU])
        settled &= _settled(proposed[R] - before_r, covariance[R, R])
        if settled and (iteration > 0 or fresh <= BARELY):
            break
    finite = math.isfinite(squared) and math.isfinite(score)
    if not (finite and _reduce(x, covariance, w, crossed, proposed)):
        return False, 0.0, 0.0, 0.0
    respond(state, h, n, crossed, w, a, b, c)
    limit(state, p)
    state.law_square = found_square(p, state.law_square, unexplained)
    return True, squared, score, variance
