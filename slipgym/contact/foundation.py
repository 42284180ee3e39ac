"""The normal contact of a pad against a tilted flat face: a disc of independent springs and dampers.

A round elastic layer (Winkler foundation) of stiffness k and radius R has the pressure k d / (pi R^2) where
it is compressed by d > 0. With the depth d_0 at its centre and the slope s of the face, d = d_0 + s x along
the slope. With a = d_0 / (s R), over the disc's compressed part x > -a R,

    f_n = k s R (a A + B) / pi,    M = k s R^2 (a B + C) / pi,

A, B, C being the area and its first and second moment on the unit disc. Up to the lift-off of an edge,
at a = 1 and M = f_n R / 4, this is f_n = k d_0 and M = k R^2 s / 4; beyond it M grows to at most f_n R.
"""

from __future__ import annotations

import math

from slipgym._numba.compiled import compiled
from slipgym.contact.records import Vector


@compiled
def press(
    depth: float, slope: tuple[float, float], rates: Vector, radius: float, relaxation: float
) -> Vector:
    """Normal force of a pad and its moment about the pad's centre, per stiffness; the pad does not pull.

    The compression at the pad's centre is `depth`, negative for a gap [m], and changes by `slope` along the
    pad's two axes [-]; `rates` are theirs [m/s, 1/s, 1/s]. `relaxation` is damping over stiffness [s].

    Returns:
        Normal force [m], and the integral of pressure times position along both axes [m^2]; the stiffness
        [N/m] makes them forces and moments.
    """
    steep = math.sqrt(slope[0] * slope[0] + slope[1] * slope[1])
    edge = steep * radius
    if depth >= edge:  # the whole pad
        quarter = 0.25 * radius * radius
        force = depth + relaxation * rates[0]
        if force <= 0.0:
            return 0.0, 0.0, 0.0
        return (
            force,
            quarter * (slope[0] + relaxation * rates[1]),
            quarter * (slope[1] + relaxation * rates[2]),
        )
    if depth <= -edge:
        return 0.0, 0.0, 0.0
    e_x, e_z = slope[0] / steep, slope[1] / steep
    a = depth / edge
    area, first, second, across = compressed_part(a)
    per_pi = 1.0 / math.pi
    along_rate, across_rate = e_x * rates[1] + e_z * rates[2], e_x * rates[2] - e_z * rates[1]
    force = edge * (a * area + first) + relaxation * (area * rates[0] + radius * first * along_rate)
    if force <= 0.0:
        return 0.0, 0.0, 0.0
    moment = edge * (a * first + second) + relaxation * (first * rates[0] + radius * second * along_rate)
    aside = relaxation * radius * across * across_rate
    scale = per_pi * radius
    return per_pi * force, scale * (moment * e_x - aside * e_z), scale * (moment * e_z + aside * e_x)


@compiled
def compressed_part(a: float) -> tuple[float, float, float, float]:
    """Integrals over the part x > -a of the unit disc, -1 < a < 1.

    Returns:
        Area, integral of x, of x^2 and of the square of the other coordinate.
    """
    s = math.sqrt(1.0 - a * a)
    angle = 0.5 * math.pi + math.atan2(a, s)
    return (
        angle + a * s,
        2.0 / 3.0 * s * s * s,
        0.25 * (angle - a * s * (1.0 - 2.0 * a * a)),
        0.25 * angle + a * s * (5.0 - 2.0 * a * a) / 12.0,
    )
