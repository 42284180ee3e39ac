"""Couples the planar sub-steps to a rigid-body engine: reads poses and normal forces, returns loads.

World plane: x to the right, z up; the grip axis n = x × z = -y points at the viewer. The
engine integrates with semi-implicit Euler steps, so its velocity is the mean velocity of a
step. The wrench sent to it gives the object the mean velocity of the sub-stepped motion
(friction's mean over the step, staggered by half a step). This wrench and its reactions on the
fingers cancel, except for the moment that tilts the box out of the plane, which the pads'
pressure carries. Other effects of the engine on the object (normal forces, collisions) appear as
the difference between expected and actual pose, and the planar world takes over the actual pose.
"""

from __future__ import annotations

import math
from typing import Any, TypeAlias

from slipgym._numba.compiled import compiled
from slipgym.contact.records import Pad, Pair, Vector
from slipgym.world.records import Finger, Records, World
from slipgym.world.substep import advance_engine_step

Pose: TypeAlias = tuple[Vector, tuple[float, float, float, float]]
"""Position (x, y, z) [m] and quaternion (x, y, z, w)."""


@compiled
def read_engine(
    world: World, fingers: Records, pose: Pose, wrist: Vector, normals: tuple[float, float]
) -> None:
    """Copy the engine's poses and normal forces. A second call changes nothing.

    Args:
        world: WORLD record.
        fingers: FINGER records (2,).
        pose: Of the object's centre of mass.
        wrist: Wrist joint positions (x, z, pitch) [m, m, rad].
        normals: Normal force of finger 1 and 2, mean over the last engine step [N].
    """
    position, orientation = pose
    dt = world.engine_ticks * world.tick_length
    angle = -2.0 * math.atan2(orientation[1], orientation[3])
    turn = angle - world.angle
    turn -= 2.0 * math.pi * round(turn / (2.0 * math.pi))
    world.velocity[0] += (position[0] - world.com[0]) / dt
    world.velocity[1] += (position[2] - world.com[1]) / dt
    world.velocity[2] += turn / dt
    world.com[0], world.com[1] = position[0], position[2]
    world.angle += turn
    for a in range(3):
        world.wrist[a] = wrist[a]
    for f in range(2):
        fingers[f].contact_force = normals[f]
        fingers[f].contact_mean_force = fingers[f].mean_force


@compiled
def engine_loads(
    bodies: tuple[Any, ...],
    pose: Pose,
    velocity: tuple[Vector, Vector],
    wrist: Vector,
    normals: tuple[float, float],
) -> tuple[Any, ...]:
    """Advance the planar world by one engine step; returns what the engine must apply.

    Args:
        bodies: The records that `advance_engine_step` takes.
        pose: As in `read_engine`, like the last two.
        velocity: Engine velocity [m/s] and angular velocity [rad/s] of the object.
        wrist: Wrist joint positions.
        normals: Normal forces.

    Returns:
        Force and torque on the object at its centre of mass; for either finger the point,
        force and torque of friction's reaction; finger efforts; wrist joint velocities.
    """
    world, pads, _, fingers, _, _ = bodies
    (position, _), (linear, angular) = pose, velocity
    read_engine(world, fingers, pose, wrist, normals)
    dt = world.engine_ticks * world.tick_length
    x, z, angle = world.com[0], world.com[1], world.angle
    advance_engine_step(*bodies)
    # total in-plane load that gives the engine this step's mean velocity
    fx = world.mass * ((world.com[0] - x) / dt - linear[0]) / dt
    fz = world.mass * ((world.com[1] - z) / dt - linear[2]) / dt + world.mass * world.gravity
    torque = world.inertia * ((world.angle - angle) / dt + angular[1]) / dt
    # the part of it that is friction, on both fingers
    excess_x, excess_z, excess_t = fx - world.external[0], fz - world.external[1], torque - world.external[2]
    for f in range(2):
        excess_x -= fingers[f].reaction[0]
        excess_z -= fingers[f].reaction[1]
    for f in range(2):
        load = fingers[f].reaction
        load[0] += 0.5 * excess_x
        load[1] += 0.5 * excess_z
        at_x, at_z = pressure_point(world, pads[f])
        excess_t -= load[2] + (at_x - x) * load[1] - (at_z - z) * load[0]
    for f in range(2):
        fingers[f].reaction[2] += 0.5 * excess_t
    goal = (
        (world.wrist_plan[0] - wrist[0]) / dt,
        (world.wrist_plan[1] - wrist[1]) / dt,
        (world.wrist_plan[2] - wrist[2]) / dt,
    )
    return (
        ((fx, 0.0, fz), (0.0, -torque, 0.0)),
        reaction(world, pads[0], fingers[0], position[1] + world.half_thickness),
        reaction(world, pads[1], fingers[1], position[1] - world.half_thickness),
        (fingers[0].mean_force, fingers[1].mean_force),
        goal,
    )


@compiled
def pressure_point(world: World, pad: Pad) -> Pair:
    """A pad's centre of pressure in the world plane (x, z) [m]."""
    cos, sin = math.cos(world.wrist[2]), math.sin(world.wrist[2])
    x, y = pad.pressure_centre
    return world.wrist[0] + cos * x - sin * y, world.wrist[1] + sin * x + cos * y


@compiled
def reaction(world: World, pad: Pad, finger: Finger, depth: float) -> tuple[Vector, Vector, Vector]:
    """Point, force and torque of friction on a finger, world coordinates."""
    x, z = pressure_point(world, pad)
    fx, fz, tau = finger.reaction
    return (x, depth, z), (-fx, 0.0, -fz), (0.0, tau, 0.0)
