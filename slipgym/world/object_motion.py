"""The object's motion over a sub-step without friction, and what friction made of it.

In stick: backward Euler in the frame of the pads, with their acceleration at the sub-step's end. Its velocity
is that of the sub-step's end, relative to the pads. Backward Euler in the world would take the mean velocity
over a sub-step for the one at its end; friction would then balance a (k + h) / 2 h after sub-steps of k and h
instead of the pads' acceleration a.

In slip or without contact: the mean of the velocities at both ends, in the world; a fall is exact.
"""

from __future__ import annotations

import math

from slipgym._numba.compiled import compiled
from slipgym.contact.records import Vector
from slipgym.world.records import Records, World


@compiled
def pad_axes(world: World) -> tuple[float, float]:
    """Cosine and sine of the wrist's pitch, computed anew when it has changed."""
    if world.wrist[2] != world.pitch:
        world.pitch = world.wrist[2]
        world.axes[0], world.axes[1] = math.cos(world.pitch), math.sin(world.pitch)
    return world.axes[0], world.axes[1]


@compiled
def acceleration_by_loads(world: World) -> Vector:
    """Acceleration of the object by gravity and disturbance, world (x, z, angle) [m/s^2, m/s^2, rad/s^2]."""
    per_mass = 1.0 / world.mass
    return (
        world.external[0] * per_mass,
        world.external[1] * per_mass - world.gravity,
        world.external[2] / world.inertia,
    )


@compiled
def acceleration_at_rest(world: World, x: float, z: float) -> Vector:
    """Acceleration of an object at rest on the pads, its centre of mass (x, z) from theirs in the world."""
    ax, az, alpha = world.wrist_acceleration
    square = world.wrist_velocity[2] ** 2
    return ax - alpha * z - square * x, az + alpha * x - square * z, alpha


@compiled
def wrench_at_rest(world: World) -> Vector:
    """Wrench about the pads' centre, in the pad frame, that keeps an object at rest on them [N, N, N m].

    Disturbance and wrist acceleration change between control steps, and the wrench of the last sub-step does
    not contain the change: a poke may break the contact away.
    """
    x, z = world.com[0] - world.wrist[0], world.com[1] - world.wrist[1]
    ax, az, alpha = acceleration_at_rest(world, x, z)
    fx = world.mass * ax - world.external[0]
    fz = world.mass * (az + world.gravity) - world.external[1]
    torque = world.inertia * alpha - world.external[2] + x * fz - z * fx
    cos, sin = pad_axes(world)
    return cos * fx + sin * fz, cos * fz - sin * fx, torque


@compiled
def drift_on_pads(world: World, h: float) -> Vector:
    """Motion over h at the present velocity relative to the pads, in the pad frame, before the wrist moves.

    It contains the distance of the pose from `relative`, which an engine's pose may have.
    """
    cos, sin = pad_axes(world)
    x, z = world.com[0] - world.wrist[0], world.com[1] - world.wrist[1]
    omega = world.wrist_velocity[2]
    vx = world.velocity[0] - world.wrist_velocity[0] + omega * z
    vz = world.velocity[1] - world.wrist_velocity[1] - omega * x
    x, z = x + h * vx, z + h * vz
    return (
        cos * x + sin * z - world.relative[0],
        cos * z - sin * x - world.relative[1],
        world.angle - world.wrist[2] - world.relative[2] + h * (world.velocity[2] - omega),
    )


@compiled
def acceleration_on_pads(world: World, drift: Vector, h: float) -> Vector:
    """Acceleration relative to the pads without friction, in the pad frame: by loads, pads and Coriolis."""
    cos, sin = pad_axes(world)
    x = cos * world.relative[0] - sin * world.relative[1]
    z = sin * world.relative[0] + cos * world.relative[1]
    ax, az, at = acceleration_by_loads(world)
    pad_x, pad_z, pad_t = acceleration_at_rest(world, x, z)
    ax, az, at = ax - pad_x, az - pad_z, at - pad_t
    turn = 2.0 * world.wrist_velocity[2] / h
    return cos * ax + sin * az + turn * drift[1], cos * az - sin * ax - turn * drift[0], at


@compiled
def force_at_start(world: World, pads: Records) -> Vector:
    """Friction at the end of the last sub-step about the centre of mass, in the pad frame [N, N, N m]."""
    fx, fy, torque = 0.0, 0.0, 0.0
    for f in range(len(pads)):
        x, y, tau = pads[f].wrench
        arm_x = pads[f].pressure_centre[0] - world.relative[0]
        arm_y = pads[f].pressure_centre[1] - world.relative[1]
        fx, fy, torque = fx + x, fy + y, torque + tau + arm_x * y - arm_y * x
    both = 2.0 / len(pads)
    return both * fx, both * fy, both * torque


@compiled
def free_motion_on_pads(world: World, drift: Vector, before: Vector, elastic: bool, h: float) -> Vector:
    """Motion over h in the pad frame without the friction at its end, after the wrist has moved.

    By backward Euler: the accelerations are those of the sub-step's end, and an object at rest on the pads
    gives the friction that its load needs at this time, whatever the sub-steps before. On elastic pads by the
    mean of both ends (trapezoidal rule); loads and pads keep their acceleration within a sub-step, but for a
    turn. `drift` is the motion at the present velocity, `before` is `force_at_start` and counts on elastic
    pads.
    """
    x, y, turned = acceleration_on_pads(world, drift, h)
    square = (0.5 if elastic else 1.0) * h * h
    if not elastic:
        return drift[0] + square * x, drift[1] + square * y, drift[2] + square * turned
    quarter = 0.25 * h * h
    per_mass = quarter / world.mass
    return (
        drift[0] + square * x + per_mass * before[0],
        drift[1] + square * y + per_mass * before[1],
        drift[2] + square * turned + quarter / world.inertia * before[2],
    )


@compiled
def follow_pads(world: World, v_x: float, v_y: float, rate: float) -> None:
    """Set the object's pose from the relative one, its velocity from one relative to the pads."""
    cos, sin = pad_axes(world)
    p_x, p_y, angle = world.relative
    x, z = cos * p_x - sin * p_y, sin * p_x + cos * p_y
    omega = world.wrist_velocity[2]
    world.com[0], world.com[1] = world.wrist[0] + x, world.wrist[1] + z
    world.angle = world.wrist[2] + angle
    world.velocity[0] = world.wrist_velocity[0] - omega * z + cos * v_x - sin * v_y
    world.velocity[1] = world.wrist_velocity[1] + omega * x + sin * v_x + cos * v_y
    world.velocity[2] = omega + rate


@compiled
def velocity_on_pads(world: World) -> Vector:
    """Velocity of the centre of mass and rate of turn relative to the pads, in the pad frame."""
    cos, sin = pad_axes(world)
    omega = world.wrist_velocity[2]
    vx = world.velocity[0] - world.wrist_velocity[0] + omega * (world.com[1] - world.wrist[1])
    vz = world.velocity[1] - world.wrist_velocity[1] - omega * (world.com[0] - world.wrist[0])
    return cos * vx + sin * vz, cos * vz - sin * vx, world.velocity[2] - omega


@compiled
def motion_without_forces(world: World, h: float) -> Vector:
    """Motion in the pad frame over h at the present velocity, after the wrist has moved."""
    cos, sin = pad_axes(world)
    x = world.com[0] + h * world.velocity[0] - world.wrist[0]
    z = world.com[1] + h * world.velocity[1] - world.wrist[1]
    turned = world.angle + h * world.velocity[2] - world.wrist[2]
    return (
        cos * x + sin * z - world.relative[0],
        cos * z - sin * x - world.relative[1],
        turned - world.relative[2],
    )


@compiled
def free_motion(world: World, drift: Vector, h: float) -> Vector:
    """Motion over h without friction, mean of the velocities at both ends, after the wrist has moved."""
    cos, sin = pad_axes(world)
    ax, az, at = acceleration_by_loads(world)
    gain = 0.5 * h * h
    return (
        drift[0] + gain * (cos * ax + sin * az),
        drift[1] + gain * (cos * az - sin * ax),
        drift[2] + gain * at,
    )


@compiled
def with_last_friction(world: World, pads: Records, free: Vector, h: float) -> Vector:
    """Motion over h in slip under the friction of the last sub-step."""
    fx, fy, torque = force_at_start(world, pads)
    gain = 0.5 * h * h
    per_mass = gain / world.mass
    return free[0] + per_mass * fx, free[1] + per_mass * fy, free[2] + gain / world.inertia * torque


@compiled
def slide(world: World, free: Vector, motion: Vector, impulse: float, h: float) -> None:
    """Advance the object's pose and velocity over h; friction is the difference of `motion` and `free`.

    `impulse` is the friction that changes the momentum over the one that moves the object within h.
    """
    cos, sin = pad_axes(world)
    ax, az, at = acceleration_by_loads(world)
    per_gain = 2.0 / h
    braking_x = (motion[0] - free[0]) * per_gain
    braking_y = (motion[1] - free[1]) * per_gain
    # friction turns with the pads: direction in the middle of the sub-step
    back = 0.5 * h * (world.wrist_velocity[2] - 0.5 * h * world.wrist_acceleration[2])
    cos, sin = cos + back * sin, sin - back * cos
    braking_x, braking_z = cos * braking_x - sin * braking_y, sin * braking_x + cos * braking_y
    braking_t = (motion[2] - free[2]) * per_gain
    world.com[0] += h * (world.velocity[0] + 0.5 * (h * ax + braking_x))
    world.com[1] += h * (world.velocity[1] + 0.5 * (h * az + braking_z))
    world.angle += h * (world.velocity[2] + 0.5 * (h * at + braking_t))
    world.velocity[0] += h * ax + impulse * braking_x
    world.velocity[1] += h * az + impulse * braking_z
    world.velocity[2] += h * at + impulse * braking_t
