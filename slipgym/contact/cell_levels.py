"""The friction levels of a patch's cells, from the slip speed that each is expected to have.

Part of `slipgym.contact.distributed_kernel`, which has the equations.
"""

from __future__ import annotations

import math

from slipgym._numba.compiled import compiled, compiled_sum
from slipgym.contact import bristle, stribeck
from slipgym.contact.records import (
    ELASTIC_LIMIT,
    LOAD,
    RETENTION,
    SPEED_CAP,
    Z_X,
    Z_Y,
    Cells,
    Pad,
    Vector,
    X,
    Y,
)


@compiled
def length(vector: Vector) -> float:
    """Length of a tuple of 3."""
    return math.sqrt(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2])


@compiled
def at_cell(x: float, y: float, motion: Vector) -> Vector:
    """Displacement or velocity of a cell, a tuple of 3 with zero spin."""
    return motion[0] - motion[2] * y, motion[1] + motion[2] * x, 0.0


@compiled
def speed_at(x: float, y: float, cap: float, twist: Vector) -> float:
    """Slip speed that sets a cell's friction level [m/s]."""
    v_x, v_y, _ = at_cell(x, y, twist)
    return min(math.sqrt(v_x * v_x + v_y * v_y), cap)


@compiled
def expected_twist(pad: Pad, h: float) -> Vector:
    """Scaled slip twist expected in the middle of a sub-step of h [m/s]."""
    ahead = pad.half_step + 0.5 * h
    return (
        pad.twist[0] + ahead * pad.twist_rate[0],
        pad.twist[1] + ahead * pad.twist_rate[1],
        pad.twist[2] + ahead * pad.twist_rate[2],
    )


@compiled
def write_speeds(pad: Pad, cells: Cells, twist: Vector) -> int:
    """Write the cells' s_i / v_s into ELASTIC_LIMIT; returns for how many the level may exceed mu_c."""
    x, y, cap, speed = cells[X], cells[Y], cells[SPEED_CAP], cells[ELASTIC_LIMIT]
    per_unit, slow = 1.0 / pad.stribeck_velocity, 0
    bound = stribeck.vanishing_speed(pad.stribeck_exponent)
    for i in range(cells.shape[1]):
        speed[i] = speed_at(x[i], y[i], cap[i], twist) * per_unit
        slow += speed[i] < bound
    return slow


@compiled
def write_levels(pad: Pad, cells: Cells, exponent: float) -> None:
    """Replace the scaled slip speeds in ELASTIC_LIMIT by friction levels."""
    level = cells[ELASTIC_LIMIT]
    mu_c, mu_s = stribeck.levels(pad)
    for i in range(cells.shape[1]):
        level[i] = stribeck.friction_level(mu_c, mu_s, level[i], exponent)


@compiled_sum
def set_friction_levels(pad: Pad, cells: Cells, twist: Vector) -> float:
    """Set every cell's friction level and shorten its bristle to it; a second call replaces the first.

    Returns their mean over the load at a scaled slip twist of the coming sub-step [m/s].
    """
    load, z_x, z_y = cells[LOAD], cells[Z_X], cells[Z_Y]
    limit, kept = cells[ELASTIC_LIMIT], cells[RETENTION]
    compliance, mean = 1.0 / pad.sigma_0, 0.0
    slow = write_speeds(pad, cells, twist)
    if pad.speed_slope != 0.0:
        for i in range(cells.shape[1]):
            limit[i] = stribeck.level_at(pad, limit[i] * pad.stribeck_velocity)
    elif slow == 0:
        limit[:] = stribeck.levels(pad)[0]
    elif pad.stribeck_exponent == 2.0:
        write_levels(pad, cells, 2.0)  # a loop of its own, without a power: several cells at once
    else:
        write_levels(pad, cells, pad.stribeck_exponent)
    for i in range(cells.shape[1]):
        mean += load[i] * limit[i]
        limit[i] *= compliance
        x, y = z_x[i] / kept[i], z_y[i] / kept[i]
        kept[i] = bristle.retention((x, y, 0.0), limit[i])
        z_x[i], z_y[i] = kept[i] * x, kept[i] * y
    return mean


@compiled
def update_friction_levels(pad: Pad, cells: Cells, delta: Vector, h: float, level: float) -> float:
    """Set the friction levels anew if the slip displacement solved for with them gives others.

    Returns their mean over the load; `level`, the one so far, if they differ by less than LEVEL_TOLERANCE.
    """
    expected, found = expected_twist(pad, h), (delta[0] / h, delta[1] / h, delta[2] / h)
    away = length((found[0] - expected[0], found[1] - expected[1], found[2] - expected[2]))
    flat = stribeck.flat_speed(pad.stribeck_exponent) * pad.stribeck_velocity
    mu_c, _ = stribeck.levels(pad)
    low = level - mu_c < stribeck.LEVEL_TOLERANCE * mu_c
    fast = low and pad.speed_slope == 0.0 and math.hypot(found[0], found[1]) > flat
    if fast or stribeck.level_unchanged(pad, away):
        return level  # without a look at the cells
    mean = set_friction_levels(pad, cells, found)
    if abs(mean - level) > stribeck.LEVEL_TOLERANCE * level:
        return mean
    return set_friction_levels(pad, cells, expected)
