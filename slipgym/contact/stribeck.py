"""The Stribeck curve: how the friction level falls from mu_s to mu_c with the slip speed.

    g(v) = mu_c + (mu_s - mu_c) exp(-(v / v_s)^gamma)

Friction of rubber moreover rises with the logarithm of the speed, and falls with it where aging prevails:
Schallamach, A theory of dynamic rubber friction, Wear 6, 1963; Xu & Persson, arXiv 2505.16943; Braun &
Peyrard, arXiv 1104.5652. Once the contact slides, mu_c is that at the speed v_0 = `REFERENCE`:

    mu_c(v) = mu_c (1 + a ln(v / v_0)),    v within `SLOWEST` and `FASTEST`
    g(v)    = mu_c(v) + (mu_s - mu_c(v)) exp(-(v / v_s)^gamma)

Both contact models read g here, and the shortcuts of their solvers read here what they need to know of its
shape. Another curve is another `decayed` and what follows from it: `steepest_slope`, `flat_speed` and
`vanishing_speed`. All take the scaled slip speed s = v / v_s and the exponent gamma.
"""

from __future__ import annotations

import math

from slipgym._numba.compiled import compiled
from slipgym.contact.decay import LARGEST, decay
from slipgym.contact.records import Pad

LEVEL_TOLERANCE = 1e-3
"""Difference of the friction level, over itself, between what was expected and what was found [-]."""
REFERENCE = 0.01
"""Slip speed at which mu_c holds [m/s]; silicones slid on PLA at this speed in the data set tolstoys19."""
SLOWEST, FASTEST = 1e-2 * REFERENCE, 1e2 * REFERENCE
"""Slip speeds beyond which friction no longer changes with the logarithm of the speed [m/s]."""
WIDEST = math.log(FASTEST / REFERENCE)
"""Largest |ln(v / v_0)| [-]."""
FLAT = 9.0
"""s^gamma from which the solver takes the curve for flat: exp(-9) of mu_s - mu_c is left."""


@compiled
def decayed(speed: float, exponent: float) -> float:
    """Fraction of mu_s - mu_c that is left at a scaled slip speed, exp(-s^gamma) [-].

    It falls from 1 at rest to 0. Loops over cells pass the exponent 2 as a literal: then the compiler drops
    the power and computes several cells at once.
    """
    return decay(speed * speed if exponent == 2.0 else speed**exponent)


@compiled
def steepest_slope(exponent: float) -> float:
    """Upper bound of |d decayed / ds| over all speeds [-], at least 1.

    The slope gamma s^(gamma - 1) exp(-s^gamma) is largest where s^gamma = (gamma - 1) / gamma = p,
    with the value gamma p^p exp(-p). Below an exponent of 1 it has no bound at rest.
    """
    if exponent < 1.0:
        return math.inf
    if exponent <= 2.0:
        return 1.0
    p = (exponent - 1.0) / exponent
    return max(1.0, exponent * p**p * math.exp(-p))


@compiled
def flat_speed(exponent: float) -> float:
    """Scaled slip speed from which at most exp(-9) of mu_s - mu_c is left [-]."""
    return 3.0 if exponent == 2.0 else FLAT ** (1.0 / exponent)


@compiled
def vanishing_speed(exponent: float) -> float:
    """Scaled slip speed from which g is mu_c to rounding [-]."""
    return LARGEST ** (1.0 / exponent)


@compiled
def friction_level(mu_c: float, mu_s: float, speed: float, exponent: float) -> float:
    """Friction level g at a scaled slip speed [-]."""
    return mu_c + (mu_s - mu_c) * decayed(speed, exponent)


@compiled
def levels(pad: Pad) -> tuple[float, float]:
    """Coulomb and static friction of a pad at its present normal force and dwell time [-]."""
    mu_c = pad.friction_scale * pad.mu_c
    return mu_c, mu_c + pad.friction_scale * pad.static_gain * (pad.mu_s - pad.mu_c)


@compiled
def level_at(pad: Pad, slip_speed: float) -> float:
    """Friction level g of a pad at a slip speed [m/s]."""
    mu_c, mu_s = levels(pad)
    if pad.speed_slope != 0.0:
        mu_c *= 1.0 + pad.speed_slope * math.log(min(max(slip_speed, SLOWEST), FASTEST) / REFERENCE)
    return friction_level(mu_c, mu_s, slip_speed / pad.stribeck_velocity, pad.stribeck_exponent)


@compiled
def level_unchanged(pad: Pad, speed_change: float) -> bool:
    """Whether a change of slip speed [m/s], from any speed, changes g by less than the tolerance.

    False where the slope has no bound: the level must then be computed.
    """
    slope = steepest_slope(pad.stribeck_exponent)
    if slope == math.inf:
        return False
    change = pad.static_gain * (pad.mu_s - pad.mu_c) * abs(speed_change) * slope
    if pad.speed_slope != 0.0:  # |d/ds of a ln(v / v_0) (1 - decayed)| <= |a| (1 + |ln(v / v_0)| slope)
        change += abs(pad.speed_slope) * pad.mu_c * abs(speed_change) * (1.0 + WIDEST * slope)
    return change <= LEVEL_TOLERANCE * pad.mu_c * pad.stribeck_velocity
