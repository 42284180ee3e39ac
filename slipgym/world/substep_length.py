"""Chooses the length of a sub-step of the planar engine, as long as the state of the contacts allows.

Stick far from break-away and without vibration needs no sub-steps of its own. Slip needs short ones where
friction falls with speed, and where the slip twist changes by much of itself; a steady slide needs few.
"""

from __future__ import annotations

import math

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.contact.disc_surface import INNER
from slipgym.contact.kinds import PATCHES
from slipgym.contact.records import DISC, Pad, Pair, Vector
from slipgym.contact.soft_pad import static_limit
from slipgym.contact.stribeck import flat_speed, levels
from slipgym.world.actuator import force_bounds, lowest_force
from slipgym.world.records import Records, World
from slipgym.world.substep import HOLDING, longest_vibration

FIRM = 0.95  # of the friction limit: below it sub-steps may have `calm_ticks`; the rest is for changing loads
FAST = 0.85  # of the friction limit: below it a sub-step may last until the next command
PATCH_FIRM, PATCH_FAST = 0.5, 0.4  # the rim of a uniform disc slips from 0.75 on
STILL = 1e-3  # of the friction limit; a weaker vibration of what sticks may be damped
STEADY = 0.1
"""Change of the slip twist in a sub-step, over its distance from the speeds at which friction falls [-].

If slip turns by this angle, the mean friction differs from that of the mean twist by 0.1^2 / 24 = 0.04 %."""


@compiled
def longest_common_substep(
    world: World, pads: Records, cells: np.ndarray | None, fingers: Records, load: Vector, stop: int
) -> int:
    """Ticks of the longest sub-step that resolves the contact of every pad, at most those until `stop`.

    There are two pads and fingers, or one that stands for both. `load` is the wrench that both pads are to
    carry, see `slipgym.world.object_motion.wrench_at_rest`.
    """
    asked = ticks = stop - world.tick
    forces = force_bounds(fingers, world.tick + asked)
    for f in range(len(pads)):
        if pads[f].slip_rate != 0.0:
            ticks = min(ticks, longest_slip(world, pads, f, cells, fingers[0].lag, forces, load, asked))
        else:
            goal = expected_wrench(pads, f, load)
            ticks = min(ticks, longest_stick(world, pads[f], cells, fingers, forces, goal, asked))
    return ticks


@compiled
def expected_wrench(pads: Records, f: int, load: Vector) -> Vector:
    """Wrench that pad f will have at its centre of pressure when all pads carry a load [N, N, N m]."""
    pad = pads[f]
    if len(pads) == 1:
        gx, gy = 0.5 * load[0], 0.5 * load[1]
        return gx, gy, 0.5 * load[2] - pad.pressure_centre[0] * gy + pad.pressure_centre[1] * gx
    # pads that differ keep what they have; of a change each takes half of the force, at its centre of
    # pressure, and of the torque a part in proportion to its bristles' stiffness
    gx, gy, torque, stiffness = load[0], load[1], load[2], 0.0
    for k in range(len(pads)):
        fx, fy, tau = pads[k].wrench
        gx, gy = gx - fx, gy - fy
        torque -= tau + pads[k].pressure_centre[0] * fy - pads[k].pressure_centre[1] * fx
        stiffness += pads[k].radius * pads[k].radius
    gx, gy = 0.5 * gx, 0.5 * gy
    for k in range(len(pads)):
        torque -= pads[k].pressure_centre[0] * gy - pads[k].pressure_centre[1] * gx
    fx, fy, tau = pad.wrench
    return fx + gx, fy + gy, tau + torque * pad.radius * pad.radius / stiffness


@compiled
def longest_stick(
    world: World, pad: Pad, cells: np.ndarray | None, fingers: Records, forces: Pair, goal: Vector, asked: int
) -> int:
    """Ticks of the longest sub-step for a pad that sticks, at most `asked`.

    Possible break-away and vibration need short sub-steps, a vibration on rubber not as short ones. A pad at
    rest below FIRM of the limit is calm; one at rest below FAST of it, or without contact, needs no sub-steps
    of its own. A patch breaks away in parts.

    `forces` are bounds of the force on either pad until then [N], `goal` is its `expected_wrench`.
    """
    if forces[0] <= HOLDING:
        return asked if max(fingers[0].contact_force, forces[1]) <= HOLDING else world.substep_ticks
    gx, gy, turned = goal
    fx, fy, torque = pad.wrench
    most = max(squared_norm(pad, fx, fy, torque), squared_norm(pad, gx, gy, turned))
    swing = squared_norm(pad, fx - gx, fy - gy, torque - turned)
    firm, fast = FIRM, FAST
    if cells is not None:
        if cells.ndim == PATCHES:
            firm, fast = PATCH_FIRM, PATCH_FAST
        elif pad.surface == DISC:
            firm, fast = INNER * FIRM, INNER * FAST
    ticks, part, limit = asked, fast, squared_limit(pad, forces[0])
    if most > fast * fast * limit:  # the lag keeps the force from going all the way
        limit = squared_limit(pad, lowest_force(fingers, world.tick, asked, world.tick_length))
        if most > fast * fast * limit:
            ticks, part = min(asked, world.calm_ticks), firm
            limit = squared_limit(pad, lowest_force(fingers, world.tick, ticks, world.tick_length))
    if most > part * part * limit:
        return world.substep_ticks
    swing += squared_vibration_force(world, pad, fingers, forces[0])
    if swing <= STILL * STILL * limit:
        return ticks
    if cells is None or cells.ndim == PATCHES or pad.compliance == 0.0:
        return world.substep_ticks
    return min(ticks, max(world.substep_ticks, int(longest_vibration(world, pad) / world.tick_length)))


@compiled
def squared_limit(pad: Pad, normal: float) -> float:
    """Square of the static friction limit at a normal force, times r [N^2 m^2]."""
    return (pad.radius * min(pad.axes[0], pad.axes[1]) * static_limit(pad, normal)) ** 2


@compiled
def squared_norm(pad: Pad, fx: float, fy: float, torque: float) -> float:
    """Square of a wrench in the norm of the limit surface, times r [N^2 m^2]."""
    return pad.radius * pad.radius * (fx * fx + fy * fy) + torque * torque


@compiled
def squared_vibration_force(world: World, pad: Pad, fingers: Records, normal: float) -> float:
    """`squared_norm` of the force with which the bristles will have stopped a vibration.

    Their stiffness k turns a kinetic energy E into a force of (2 k E)^0.5; a pad has half of the object. The
    velocity counts from that of bristles which carry a constant load while the normal force changes:
    z f_n is constant, so that dz/dt = -z / f_n df_n/dt.
    """
    vx, vy, omega = world.relative_velocity
    if pad.normal > HOLDING:
        follow = -force_rate(fingers) / pad.normal
        turn = follow * pad.z[2] / pad.radius
        arm_x = pad.pressure_centre[0] - world.relative[0]
        arm_y = pad.pressure_centre[1] - world.relative[1]
        vx -= follow * pad.z[0] + turn * arm_y
        vy -= follow * pad.z[1] - turn * arm_x
        omega -= turn
    energy = world.mass * (vx * vx + vy * vy) + world.inertia * omega * omega
    bristles = pad.sigma_0 * normal
    return 0.5 * pad.radius * pad.radius * bristles / (1.0 + pad.compliance * bristles) * energy


@compiled
def force_rate(fingers: Records) -> float:
    """Rate of change of the force on either pad [N/s]; 0 without lag."""
    total = 0.0
    for f in range(len(fingers)):
        if fingers[f].lag > 0.0:
            total += (fingers[f].command - fingers[f].force) / fingers[f].lag
    return total / len(fingers)


@compiled
def longest_slip(
    world: World,
    pads: Records,
    f: int,
    cells: np.ndarray | None,
    lag: float,
    forces: Pair,
    load: Vector,
    asked: int,
) -> int:
    """Ticks of the longest sub-step for pad f, which slips, at most `asked`.

    Where friction is flat, the scaled slip twist may change by STEADY of its distance from where it is not.
    Patches and rubber, whose parts move on their own, need the shortest sub-steps.

    `lag` is the time constant of the force [s], `forces` are bounds of the force on either pad until then
    [N], `load` is the wrench that keeps the object at rest on the pads.
    """
    pad = pads[f]
    if cells is not None and (cells.ndim == PATCHES or pad.compliance > 0.0):
        return world.substep_ticks
    speed = pad.slip_speed + min(0.0, pad.half_step * pad.slip_rate)
    may_change = STEADY * (speed - pad.stribeck_velocity * flat_speed(pad.stribeck_exponent))
    if may_change <= 0.0 or lag <= 0.0:
        return world.substep_ticks
    now = scaled_acceleration(world, pads, f, load)
    x, y = pad.pressure_centre[0] - world.relative[0], pad.pressure_centre[1] - world.relative[1]
    mobility = 1.0 / world.mass + (pad.radius * pad.radius + x * x + y * y) / world.inertia
    later = 2.0 * levels(pad)[0] * mobility * (forces[1] - forces[0]) / lag
    # now h + later h^2 = may_change
    h = 2.0 * may_change / (now + math.sqrt(now * now + 4.0 * later * may_change) + 1e-9)
    return min(asked, max(world.substep_ticks, int(min(h / world.tick_length, 1e6))))


@compiled
def scaled_acceleration(world: World, pads: Records, f: int, load: Vector) -> float:
    """Rate of change of a pad's scaled slip twist under the last friction and a load [m/s^2]."""
    fx, fy, torque, both = -load[0], -load[1], -load[2], 2.0 / len(pads)
    for k in range(len(pads)):
        x, y, tau = pads[k].wrench
        fx, fy = fx + both * x, fy + both * y
        torque += both * (tau + pads[k].pressure_centre[0] * y - pads[k].pressure_centre[1] * x)
    px, py = world.relative[0], world.relative[1]
    turn = (torque - px * fy + py * fx) / world.inertia
    x = fx / world.mass - turn * (pads[f].pressure_centre[1] - py)
    y = fy / world.mass + turn * (pads[f].pressure_centre[0] - px)
    turn *= pads[f].radius
    return math.sqrt(x * x + y * y + turn * turn)
