"""Relative error of the friction law from sample to sample: found while the contact slips.

Rough or worn surfaces and uneven pressure make single slips differ from the law by more than the noise of the
sensors. With e the relative error (`law_error` at the start), a load is off by e in its size, and by
`turn_error` times e in its direction on the limit surface. The direction is that of the twist there, so the
second part is an error of the twist: with the scaled speed w, of v_x and of v_y by `turn_error` e w.

A fixed e would be wrong: too small, and r follows the newest slips; too large, and a change of friction is
seen late. So e is a maximum-likelihood estimate with fading memory. Source: the expectation-maximisation
algorithm for a variance of a state-space model (Shumway & Stoffer, An approach to time series smoothing and
forecasting using the EM algorithm, Journal of Time Series Analysis 3(4), 1982), of which every sample makes
one step with a fixed weight (Cappe & Moulines, On-line expectation-maximization algorithm for latent data
models, Journal of the Royal Statistical Society B 71(3), 2009).
"""

import math

from estimator._numba.caching import fused, njit
from estimator.augmented.slip_law import MU
from estimator.augmented.whitening import whitened


@njit(error_model="numpy")
def twist_scatter(state, p, square, omega):
    """Variances of v_x, v_y and of omega by the law's error, over its square.

    That of omega falls towards translation: otherwise every torque of a translation would be explained by
    it, and r, which only the torque shows, would wander.

    Args:
        state: Record with `r`.
        p: Parameters.
        square: Squared slip speed [m^2/s^2].
        omega: Slip rate [rad/s].
    """
    rim = abs(state.r * omega)
    total = square + rim * rim
    if not 0.0 < total < math.inf:
        return 0.0, 0.0
    of_speed = p.turn_error * p.turn_error * total
    return of_speed, of_speed * rim / (state.r * state.r * math.sqrt(total))


@fused
def surprise(h, dry, by_twist, of_speed, of_spin, w, z_1, z_2, z_3):
    """How much more of the innovation the law's error explains than is expected; 0 in the mean if e is right.

    It is the derivative of the log-likelihood by e^2, times 2.

    Args:
        h: (3, 12), derivatives of the measurements by the states.
        dry: Friction over its derivative by ln mu_c.
        by_twist: (3, 3), derivatives of the measurements by the twist.
        of_speed: First of `twist_scatter`.
        of_spin: Second of it.
        w: `whitening` of the innovation's covariance.
        z_1: First innovation, weighted by the inverse of that covariance.
        z_2: As z_1.
        z_3: As z_1.
    """
    f_x, f_y, tau = dry * h[0, MU], dry * h[1, MU], dry * h[2, MU]
    force, torque = f_x * f_x + f_y * f_y, tau * tau
    found = force * (z_1 * z_1 + z_2 * z_2) + torque * z_3 * z_3
    expected = force * (w[0] * w[0] + w[1] * w[1] + w[2] * w[2] + w[3] * w[3] + w[4] * w[4])
    expected += torque * w[5] * w[5]
    for j in range(3):
        variance = of_speed if j < 2 else of_spin
        a, b, c = by_twist[0, j], by_twist[1, j], by_twist[2, j]
        along = a * z_1 + b * z_2 + c * z_3
        a, b, c = whitened(w, a, b, c)
        found += variance * along * along
        expected += variance * (a * a + b * b + c * c)
    return found - expected


@fused
def found_square(p, before, unexplained):
    """e^2 after a sample.

    Args:
        p: Parameters.
        before: e^2 before it.
        unexplained: From `surprise`.
    """
    step = before * before * unexplained / 3.0
    least = p.law_error_min * p.law_error_min
    return max(before + p.law_gain * step, least) if math.isfinite(step) else before
