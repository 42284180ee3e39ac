"""The friction step of a pad without cells that is soft or uneven, or whose limit surface is a disc's.

As `slipgym.contact.ellipsoid_kernel`, with the rubber of `slipgym.contact.soft_pad` in series, and with the
closest point of `slipgym.contact.disc_surface` where the surface is a disc. A kernel of its own, because a
hard ellipsoid takes about two thirds of the time.
"""

from __future__ import annotations

import math

import numpy as np

from slipgym._numba.compiled import compiled, compiled_call
from slipgym.contact import bristle
from slipgym.contact.disc_surface import project
from slipgym.contact.ellipsoid_kernel import expected_speed, found_level
from slipgym.contact.records import DISC, Pad, Symmetric, Vector
from slipgym.contact.soft_pad import advance_age, advance_shear, load_pad, prepare_shear
from slipgym.contact.stribeck import level_at


@compiled
def rear_of(pad: Pad) -> Vector:
    """Remembered shear of the rubber [m]."""
    now, before, rate = pad.recall
    return (
        now * pad.shear[0] + before * pad.relaxed[0] + rate * pad.shear_rate[0],
        now * pad.shear[1] + before * pad.relaxed[1] + rate * pad.shear_rate[1],
        now * pad.shear[2] + before * pad.relaxed[2] + rate * pad.shear_rate[2],
    )


@compiled
def closest_point(pad: Pad, y: Vector, size: float) -> tuple[Vector, Symmetric, bool]:
    """Closest point of the limit surface of a size, its derivative by y, and whether y lies within."""
    if pad.surface == DISC:
        point, slope, turn = project(y, size, pad.turn)
        if turn >= 0.0:
            pad.turn = turn
        return point, slope, turn < 0.0
    fraction = bristle.retention(y, size)
    if fraction == 1.0:
        return y, (1.0, 1.0, 1.0, 0.0, 0.0, 0.0), True
    a, b, c = y
    radial = fraction / (a * a + b * b + c * c)
    slope = (
        fraction - radial * a * a,
        fraction - radial * b * b,
        fraction - radial * c * c,
        -radial * a * b,
        -radial * a * c,
        -radial * b * c,
    )
    return (fraction * a, fraction * b, fraction * c), slope, False


@compiled_call
def friction_and_jacobian(pad: Pad, delta: Vector, level: float) -> tuple[Vector, Symmetric]:
    """Friction of a pad after a scaled displacement in a sub-step, and its derivative.

    `set_friction_level` has prepared the sub-step. The pad keeps friction, deflection and slip for
    `update_friction_level` and `store_state`.

    Returns:
        Friction opposing `delta` [N] and its derivative (xx, yy, tt, xy, xt, yt) [N/m], scaled.
    """
    z = (pad.z[0], pad.z[1], pad.z[2])
    stiffness, give = (pad.stiffness[0], pad.stiffness[1], pad.stiffness[2]), pad.give
    soft = (pad.softer[0], pad.softer[1])
    y, whole = bristle.trial(stiffness, soft, give, rear_of(pad), z, delta)
    mapped, slope, stuck = closest_point(pad, y, level / pad.sigma_0)
    slip = bristle.slip_of(stiffness, soft, give, whole, mapped, z)
    elastic, viscous = soft[0] * soft[1] * stiffness[0], soft[1] * stiffness[2]
    force = bristle.force_of(stiffness, mapped, z, slip)
    for a in range(3):
        pad.friction[a], pad.mapped[a], pad.slip[a] = force[a], mapped[a], slip[a]
    pad.stuck = stuck
    return force, (
        elastic * slope[0] + viscous,
        elastic * slope[1] + viscous,
        elastic * slope[2] + viscous,
        elastic * slope[3],
        elastic * slope[4],
        elastic * slope[5],
    )


@compiled
def set_friction_level(pad: Pad, h: float) -> float:
    """Set the friction level of a sub-step and shorten the bristles to it; returns the level [-]."""
    prepare_shear(pad, h, h / (h + 2.0 * pad.half_step))
    loaded = pad.loaded
    if loaded[0] != pad.normal or loaded[1] != h or loaded[2] != pad.give:
        loaded[0], loaded[1], loaded[2] = pad.normal, h, pad.give
        stiffness = bristle.coefficients(pad, pad.normal, h)
        for a in range(3):
            pad.stiffness[a] = stiffness[a]
        pad.softer[0], pad.softer[1] = bristle.softening(stiffness, pad.give)
    level = level_at(pad, expected_speed(pad, h))
    shorten_bristles(pad, level)
    return level


@compiled_call
def shorten_bristles(pad: Pad, level: float) -> None:
    """Bring the bristles within the elastic limit of a friction level."""
    limit = level / pad.sigma_0
    if limit < pad.elastic_limit:  # else they lie within it
        if pad.slip_rate != 0.0:  # on the surface, which shrinks in proportion
            fraction = limit / pad.elastic_limit
            for a in range(3):
                pad.z[a] *= fraction
        else:
            z, _, within = closest_point(pad, (pad.z[0], pad.z[1], pad.z[2]), limit)
            if not within:
                for a in range(3):
                    pad.z[a] = z[a]


@compiled
def update_friction_level(pad: Pad, before: Vector, h: float, level: float) -> float:
    """Set the friction level anew if the solved displacement, whose results the pad keeps, gives another one.

    `before` are the bristles at the start of the sub-step [m]; returns the level, see `found_level`.
    """
    found = found_level(pad, (pad.slip[0], pad.slip[1], pad.slip[2]), pad.stuck != 0, h, level)
    if found != level:
        for a in range(3):
            pad.z[a] = before[a]
        shorten_bristles(pad, found)
    return found


@compiled
def store_state(pad: Pad, delta: Vector, h: float, level: float) -> None:
    """Store the results for the solved scaled displacement."""
    pad.elastic_limit = level / pad.sigma_0
    for a in range(3):
        pad.z[a] = pad.mapped[a]
    x, y, t = pad.slip
    speed = math.sqrt(x * x + y * y + t * t) * (1.0 / h)
    between, pad.half_step = pad.half_step + 0.5 * h, 0.5 * h
    if pad.stuck != 0:
        pad.slip_rate = 0.0
        pad.slip_speed = min(speed, pad.slip_speed)
        advance_age(pad, 0.0, h)
    else:
        pad.slip_rate = (speed - pad.slip_speed) / between
        pad.slip_speed = speed
        advance_age(pad, speed, h)
    advance_shear(pad, delta, (x, y, t))
    pad.wrench[0], pad.wrench[1] = -pad.axes[0] * pad.friction[0], -pad.axes[1] * pad.friction[1]
    pad.wrench[2] = -pad.radius * pad.friction[2]


@compiled
def prescribed_step(pad: Pad, twist: np.ndarray, h: float) -> None:
    """Advance one pad by a prescribed slip twist (v_x, v_y, omega) at its centre of pressure."""
    load_pad(pad, pad.normal)
    delta = (h * pad.axes[0] * twist[0], h * pad.axes[1] * twist[1], h * pad.radius * twist[2])
    level = set_friction_level(pad, h)
    friction_and_jacobian(pad, delta, level)
    store_state(pad, delta, h, level)
