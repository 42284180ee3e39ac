"""Exponents of the load that are published: a pad is hard, or it is one of rubber.

Many pads are hard: mu_c and r do not depend on the normal force, both exponents are 0. Noise would make those
of the filter small positive numbers, which are a large error of mu_c at a load far from that of the slips. So
there are two hypotheses, a hard pad and one of rubber with the filter's exponents, weighed by how probable
what the slips say of both exponents is on either. What is published is the median: 0 as long as a hard pad is
the more probable one.

What slips say of the exponents has the errors of the filter and those of the sensors in full. The filter
assumes only the fraction `caution` of the latter, and an error of the centre of pressure whose effect changes
with the load looks like an exponent.
"""

import math

from estimator._numba.caching import njit
from estimator.augmented.load import MOST_FALL, MOST_GROWTH
from estimator.augmented.slip_law import FALLS, GROWS, SHAPE, ZERO

CERTAIN = 100.0
"""Logarithm of odds beyond which they are not followed."""
LEAST = 1e-6
"""Information on an exponent, over that of its prior, that is taken for none."""


@njit(error_model="numpy")
def group_weights(p, weights):
    """Factors of squared covariances with zero error, tilt, CoP and shape: errors larger than the filter's.

    The error that a linear filter makes of one state for a unit error of the prior mean of another is the
    covariance of both over the prior variance. The filter assumes `caution` times the spread `sd_...`.

    Args:
        p: Parameters.
        weights: Output (4,).
    """
    assumed = p.caution * p.caution
    factor = (1.0 - assumed) / (assumed * assumed)
    weights[0] = factor / (p.sd_zero * p.sd_zero)
    weights[1] = factor / (p.sd_tilt * p.sd_tilt)
    weights[2] = factor / (p.sd_cop * p.sd_cop)
    weights[3] = factor / (p.sd_shape * p.sd_shape)


@njit(error_model="numpy")
def by_groups(weights, first, second):
    """Covariance of two states by errors larger than the filter's, from their rows of its covariance."""
    total = weights[3] * first[SHAPE] * second[SHAPE]
    for group in range(3):
        at = ZERO + 2 * group
        total += weights[group] * (first[at] * second[at] + first[at + 1] * second[at + 1])
    return total


@njit(error_model="numpy")
def _inverse(a, b, c):
    """Inverse (11, 12, 22) of a symmetric matrix (11, 12, 22)."""
    determinant = a * c - b * b
    return c / determinant, -b / determinant, a / determinant


@njit(error_model="numpy")
def _quadratic(a, b, c, x, y):
    """Quadratic form of a symmetric matrix (11, 12, 22) at the vector (x, y)."""
    return a * x * x + 2.0 * b * x * y + c * y * y


@njit(error_model="numpy")
def _median(rubber, mean, variance, most):
    """Median of an exponent that is normally distributed with the probability `rubber`, and else 0.

    The normal quantile is that of Polya (Remarks on computing the probability integral, Proc. Berkeley
    Symposium on Mathematical Statistics and Probability, 1949).
    """
    if not rubber > 0.5:
        return 0.0
    odds = (1.0 - rubber) / rubber
    below = math.sqrt(-0.5 * math.pi * math.log(1.0 - odds * odds) * variance)
    return min(max(mean - below, 0.0), most)


@njit(error_model="numpy")
def _rubber(p, z_n, z_b, v_nn, v_nb, v_bb):
    """Probability of rubber by what slips say of the exponents, in units of their spreads.

    Args:
        p: Parameters.
        z_n: What slips say of the exponent of mu_c.
        z_b: Of r.
        v_nn: Variance of z_n.
        v_nb: Covariance of both.
        v_bb: Variance of z_b.
    """
    s_nn, s_bb = v_nn + 1.0, v_bb + 1.0
    off_n, off_b = (
        z_n - p.load_exponent0 / p.sd_load_exponent,
        z_b - p.radius_exponent0 / p.sd_radius_exponent,
    )
    if_hard = _quadratic(*_inverse(v_nn, v_nb, v_bb), z_n, z_b)
    if_rubber = _quadratic(*_inverse(s_nn, v_nb, s_bb), off_n, off_b)
    sizes = (s_nn * s_bb - v_nb * v_nb) / (v_nn * v_bb - v_nb * v_nb)
    evidence = 0.5 * (math.log(sizes) + if_rubber - if_hard)
    return 1.0 / (1.0 + p.hard / (1.0 - p.hard) * math.exp(min(evidence, CERTAIN)))


@njit(error_model="numpy")
def exponents(state, p, weights):
    """Exponents with which mu_c falls and r grows that are published, and their covariance about them.

    Args:
        state: Record with `covariance`, `x`, `fall_error`, `misfit` and `scatter`.
        p: Parameters.
        weights: (4,), from `group_weights`.

    Returns:
        Exponent of mu_c, that of r, and the covariance (11, 12, 22) of both.
    """
    # all in units of the spreads
    of_n, of_b = p.sd_load_exponent, p.sd_radius_exponent
    x_n, x_b = state.x[FALLS] / of_n, state.x[GROWS] / of_b
    falls, grows, both = state.covariance[FALLS], state.covariance[GROWS], of_n * of_b
    p_nn, p_nb, p_bb = falls[FALLS] / (of_n * of_n), falls[GROWS] / both, grows[GROWS] / (of_b * of_b)
    # what slips say without the prior
    i, j, k = _inverse(p_nn, p_nb, p_bb)
    i, k = max(i - 1.0, LEAST), max(k - 1.0, LEAST)
    most = math.sqrt((1.0 - LEAST) * i * k)
    j = min(max(j, -most), most)
    a, b, c = _inverse(i, j, k)
    off_n, off_b = x_n - p.load_exponent0 / of_n, x_b - p.radius_exponent0 / of_b
    z_n, z_b = x_n + a * off_n + b * off_b, x_b + b * off_n + c * off_b
    # its covariance: of the filter, of larger errors of the sensors, and what no number of slips lowers
    noise = max(state.misfit, state.scatter, 1.0)
    f_n, f_b = state.fall_error / (of_n * of_n), state.fall_error / (of_b * of_b)
    g_nn, g_nb = by_groups(weights, falls, falls) / (of_n * of_n), by_groups(weights, falls, grows) / both
    g_bb = by_groups(weights, grows, grows) / (of_b * of_b)
    up, down = 1.0 + a, 1.0 + c
    v_nn = noise * a + up * up * g_nn + 2.0 * up * b * g_nb + b * b * g_bb + f_n
    v_nb = noise * b + up * b * g_nn + (up * down + b * b) * g_nb + b * down * g_bb
    v_bb = noise * c + b * b * g_nn + 2.0 * b * down * g_nb + down * down * g_bb + f_b
    rubber = _rubber(p, z_n, z_b, v_nn, v_nb, v_bb)
    # on rubber they are those of the filter
    q_nn = noise * p_nn + g_nn + (1.0 - p_nn) * (1.0 - p_nn) * f_n
    q_nb = noise * p_nb + g_nb
    q_bb = noise * p_bb + g_bb + (1.0 - p_bb) * (1.0 - p_bb) * f_b
    n, b = _median(rubber, x_n, q_nn, MOST_FALL / of_n), _median(rubber, x_b, q_bb, MOST_GROWTH / of_b)
    d_n, d_b, hard = x_n - n, x_b - b, 1.0 - rubber
    return (
        of_n * n,
        of_b * b,
        of_n * of_n * (rubber * (q_nn + d_n * d_n) + hard * n * n),
        both * (rubber * (q_nb + d_n * d_b) + hard * n * b),
        of_b * of_b * (rubber * (q_bb + d_b * d_b) + hard * b * b),
    )
