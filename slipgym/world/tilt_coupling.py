"""Couples the motion out of the contact plane to a rigid-body engine.

As in the plane (`slipgym.world.bullet_coupling`), the engine receives loads that give the object the mean
velocity and angular velocity of the step, so that its pose lands on the one computed here. A
pose that differs is taken over. The engine's own gravity is off. To the engine the object's inertia is the
same about all axes: its gyroscopic term then vanishes, and the true one acts in `slipgym.world.tilt`.
"""

from __future__ import annotations

import math
from typing import Any

from slipgym._numba.compiled import compiled
from slipgym.contact.records import Vector
from slipgym.world.bullet_coupling import Pose, engine_loads
from slipgym.world.records import Records, Tilt, World
from slipgym.world.rotation import Quaternion, inertia_tensor, rotation_between, times
from slipgym.world.tilt import acceleration_along_y, advance_tilt


@compiled
def take_over(world: World, tilt: Tilt, height: float, attitude: Quaternion, dt: float) -> None:
    """Take over the engine's pose out of the plane; a second call changes nothing."""
    known = (tilt.attitude[0], tilt.attitude[1], tilt.attitude[2], tilt.attitude[3])
    tilt.speed += (height - tilt.height) / dt
    tilt.height = height
    x, y, z = rotation_between(known, attitude)
    gyration = (tilt.gyration[0], tilt.gyration[1], tilt.gyration[2])
    gained = times(inertia_tensor(attitude, world.mass, gyration), (x / dt, y / dt, z / dt))
    for a in range(3):
        tilt.momentum[a] += gained[a]
    for a in range(4):
        tilt.attitude[a] = attitude[a]


@compiled
def set_inertial_loads(world: World, tilt: Tilt, dt: float) -> None:
    """Set the plane's gravity, and add what roll and sway do in the plane to the external load.

    The values are those of the step's middle. In a frame that rolls about x at the rate p and sways along y
    at the velocity u, the acceleration along z gains -p u - dp/dt y + p^2 z - 2 p v_y.
    """
    half = 0.5 * dt
    rate = tilt.roll[1] + half * tilt.roll[2]
    roll = tilt.roll[0] + half * (tilt.roll[1] + 0.5 * half * tilt.roll[2])
    world.gravity = tilt.gravity * math.cos(roll)
    if tilt.roll[1] != 0.0 or tilt.roll[2] != 0.0:
        y, z = tilt.height + half * tilt.speed, world.com[1] + half * world.velocity[1]
        sway, speed = tilt.sway[1] + half * tilt.sway[2], tilt.speed
        if tilt.normal[0] == 0.0 and tilt.normal[1] == 0.0:
            speed += half * acceleration_along_y(tilt, roll, rate, y, z, world.velocity[1])
        added = rate * (rate * z - sway - 2.0 * speed) - tilt.roll[2] * y
        world.external[1] += world.mass * added
        world.external[2] -= rate * tilt.momentum[2]


@compiled
def follow_pads_set_outside(tilt: Tilt, pads: Records) -> None:
    """Take a centre of pressure that was set from outside as the one without tilt."""
    for f in range(2):
        for a in range(2):
            if pads[f].cop[a] != tilt.cop[f, a]:
                tilt.cop_rest[f, a] = tilt.cop[f, a] = pads[f].cop[a]


@compiled
def tilted_loads(
    bodies: tuple[Any, ...], tilt: Tilt, pose: Pose, velocity: tuple[Vector, Vector], wrist: Vector
) -> tuple[Any, ...]:
    """Advance the world by one engine step in all freedoms; returns what the engine must apply.

    The arguments are those of `slipgym.world.bullet_coupling.engine_loads`, and a TILT record.

    Returns:
        Force and torque on the object at its centre of mass; for either finger the point, force and torque of
        its contact's reaction; joint velocities of wrist and fingers; normal forces, mean over the step.
    """
    world, pads, _, fingers, _, _ = bodies
    (position, orientation), (linear, angular) = pose, velocity
    dt = world.engine_ticks * world.tick_length
    take_over(world, tilt, position[1], orientation, dt)
    follow_pads_set_outside(tilt, pads)
    normals = (tilt.normal[0], tilt.normal[1])
    push = world.external[1], world.external[2]
    set_inertial_loads(world, tilt, dt)
    before, closure = (position[0], position[2], world.angle), tilt.closure
    _, first, second, _, goal = engine_loads(bodies, pose, velocity, wrist, normals)
    world.external[1], world.external[2] = push
    advance_tilt(world, tilt, pads, fingers, before, push[1], dt)
    after = (tilt.attitude[0], tilt.attitude[1], tilt.attitude[2], tilt.attitude[3])
    turn = rotation_between(orientation, after)
    per_step, per_turn = world.mass / dt, world.inertia / dt
    force = (
        per_step * ((world.com[0] - position[0]) / dt - linear[0]),
        per_step * ((tilt.height - position[1]) / dt - linear[1]),
        per_step * ((world.com[1] - position[2]) / dt - linear[2]),
    )
    torque = (
        per_turn * (turn[0] / dt - angular[0]),
        per_turn * (turn[1] / dt - angular[1]),
        per_turn * (turn[2] / dt - angular[2]),
    )
    closing = (tilt.closure - closure) / dt
    return (
        (force, torque),
        with_pressure(tilt, first, 0),
        with_pressure(tilt, second, 1),
        (goal[0], goal[1], goal[2], closing, closing),
        (tilt.normal[0], tilt.normal[1]),
    )


@compiled
def with_pressure(
    tilt: Tilt, reaction: tuple[Vector, Vector, Vector], f: int
) -> tuple[Vector, Vector, Vector]:
    """Friction's reaction on a finger, together with that of its pad's pressure along the grip axis."""
    point, force, torque = reaction
    return point, (force[0], (1.0 - 2.0 * f) * tilt.normal[f], force[2]), torque
