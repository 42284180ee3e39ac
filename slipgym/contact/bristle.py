"""One bristle: elasto-plastic return mapping onto a ball, in series with the rubber behind it.

Friction per normal force is

    f / f_n = sigma_0 z + sigma_1 dz/dt + sigma_2 u,        |z| <= g / sigma_0,

with u the slip twist in scaled components. In a sub-step the motion delta divides into the slip of the
bristle and the shear of the rubber (`slipgym.contact.soft_pad`); both carry the same force. With E, D, V the
elastic, damping and viscous force per displacement and the rubber's `give`, the deflection before the return
mapping is

    t = (delta + rear + (1 + give (V + D)) z) / (1 + give (E + V)),

and the slip follows from what the mapping leaves of it. Without rubber t = z + delta.
"""

from __future__ import annotations

import math

from slipgym._numba.compiled import compiled
from slipgym.contact.records import Pad, Pair, Vector


@compiled
def coefficients(pad: Pad, normal: float, h: float) -> Vector:
    """Elastic, damping and viscous force per displacement in a sub-step of h [N/m]."""
    rate = 1.0 / h
    damping = normal * pad.sigma_1 * rate
    return normal * pad.sigma_0 + damping, damping, normal * pad.sigma_2 * rate


@compiled
def softening(stiffness: Vector, give: float) -> Pair:
    """1 / (1 + give (E + V)) and 1 / (1 + give V) [-]."""
    elastic, _, viscous = stiffness
    return 1.0 / (1.0 + give * (elastic + viscous)), 1.0 / (1.0 + give * viscous)


@compiled
def trial(
    stiffness: Vector, softer: Pair, give: float, rear: Vector, z: Vector, delta: Vector
) -> tuple[Vector, Vector]:
    """Deflection before the return mapping, and the same times 1 + give (E + V) [m]."""
    _, damping, viscous = stiffness
    keep = 1.0 + give * (viscous + damping)
    whole = (
        delta[0] + rear[0] + keep * z[0],
        delta[1] + rear[1] + keep * z[1],
        delta[2] + rear[2] + keep * z[2],
    )
    return (softer[0] * whole[0], softer[0] * whole[1], softer[0] * whole[2]), whole


@compiled
def slip_of(stiffness: Vector, softer: Pair, give: float, whole: Vector, mapped: Vector, z: Vector) -> Vector:
    """Slip displacement of a bristle whose deflection was mapped [m]."""
    per, back = softer[1], give * stiffness[0]
    return (
        per * (whole[0] - back * mapped[0]) - z[0],
        per * (whole[1] - back * mapped[1]) - z[1],
        per * (whole[2] - back * mapped[2]) - z[2],
    )


@compiled
def force_of(stiffness: Vector, mapped: Vector, z: Vector, slip: Vector) -> Vector:
    """Friction opposing a slip displacement [N]."""
    elastic, damping, viscous = stiffness
    return (
        elastic * mapped[0] - damping * z[0] + viscous * slip[0],
        elastic * mapped[1] - damping * z[1] + viscous * slip[1],
        elastic * mapped[2] - damping * z[2] + viscous * slip[2],
    )


@compiled
def friction_and_jacobian(
    pad: Pad,
    give: float,
    rear: Vector,
    z: Vector,
    normal: float,
    delta: Vector,
    h: float,
    elastic_limit: float,
) -> tuple[Vector, float, float, Vector, float, Vector]:
    """Friction of one bristle after a scaled displacement (x, y, r theta) over time h, and its derivative.

    Rubber behind the bristle has the compliance `give` in this sub-step, 0 for none [m/N], and remembers
    `rear` of its shear [m]. The deflection z, not longer than `elastic_limit` = g / sigma_0, and `delta` are
    in scaled components [m]; `normal` is the force that the bristle carries [N].

    Returns:
        force: Friction opposing `delta`, scaled components [N].
        isotropic, radial, direction: Derivative of `force` by `delta`, as
            isotropic I - radial direction direction^T [N/m].
        shortening: Factor of the return mapping on `direction`, the deflection before it (1 = stick).
        slip: The part of `delta` that the bristle takes [m].
    """
    stiffness = coefficients(pad, normal, h)
    elastic, damping, viscous = stiffness
    softer = softening(stiffness, give)
    if give > 0.0:
        y, whole = trial(stiffness, softer, give, rear, z, delta)
    else:
        y = whole = (z[0] + delta[0], z[1] + delta[1], z[2] + delta[2])
    squared = y[0] * y[0] + y[1] * y[1] + y[2] * y[2]
    shortening, radial = 1.0, 0.0
    if squared > elastic_limit * elastic_limit:
        per_length = 1.0 / math.sqrt(squared)
        shortening = elastic_limit * per_length
        radial = elastic * shortening * per_length * per_length
    spring = elastic * shortening
    if give > 0.0:
        mapped = (shortening * y[0], shortening * y[1], shortening * y[2])
        slip = slip_of(stiffness, softer, give, whole, mapped, z)
        both = softer[0] * softer[1]
        isotropic, radial = both * spring + softer[1] * viscous, both * radial
    else:
        slip, isotropic = delta, spring + viscous
    force = (
        spring * y[0] - damping * z[0] + viscous * slip[0],
        spring * y[1] - damping * z[1] + viscous * slip[1],
        spring * y[2] - damping * z[2] + viscous * slip[2],
    )
    return force, isotropic, radial, y, shortening, slip


@compiled
def retention(z: Vector, elastic_limit: float) -> float:
    """Fraction of its deflection that a bristle keeps when the elastic limit may have fallen [-]."""
    squared = z[0] * z[0] + z[1] * z[1] + z[2] * z[2]
    return elastic_limit / math.sqrt(squared) if squared > elastic_limit * elastic_limit else 1.0
