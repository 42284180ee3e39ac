"""Advances the planar model by a sub-step: object, wrist, fingers and friction. Both engines use it.

The object's in-plane motion relative to the pads is stiff (14 000 rad/s in stick), so it
is integrated here, implicitly and together with the friction of both pads. A rigid-body
engine then follows by receiving the step's mean wrench.

Positions, not velocities, decide about slip: a sub-step compares the object's pose in the
pad frame before and after, with the pad's own motion taken exactly. An object that sticks
therefore stays where it is in a turning or shaken gripper, to rounding.
"""

from __future__ import annotations

import math

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.contact.coupled import step_pads
from slipgym.contact.records import Pad, Vector
from slipgym.sensors.force_torque import sample_force_torque
from slipgym.sensors.slip_velocity import accumulate_slip
from slipgym.world.actuator import advance_lag, apply_due_commands, ticks_to_next_command
from slipgym.world.records import Finger, Records, World

HOLDING = 1e-2  # [N]; pads with less, a fiftieth of the smallest grip, do not hold the object


@compiled
def advance_engine_step(
    world: World,
    pads: Records,
    cells: np.ndarray | None,
    fingers: Records,
    force_torque: Records,
    slip_sensors: Records,
) -> None:
    """Advance one world by one engine step.

    Args:
        world: WORLD record.
        pads: PAD records (2,).
        cells: Patches (2, CELL_FIELDS, m); None for ellipsoids.
        fingers: FINGER records (2,).
        force_torque: FORCE_TORQUE records (2,).
        slip_sensors: SLIP_SENSOR records (2,).
    """
    start = world.tick
    end = start + world.engine_ticks
    for f in range(2):
        fingers[f].mean_force = 0.0
        fingers[f].reaction[:] = 0.0
    both = (pads[0], pads[1]), cells, (fingers[0], fingers[1]), (slip_sensors[0], slip_sensors[1])
    while world.tick < end:
        for f in range(2):
            apply_due_commands(fingers[f], world.tick)
        ticks = resolved_ticks(world, fingers, force_torque)
        fraction = ticks / world.engine_ticks
        substep(world, *both, ticks * world.tick_length, fraction)
        world.tick += ticks
        for f in range(2):
            if world.tick % force_torque[f].period == 0:
                sample_force_torque(force_torque[f], pads[f], world.tick)


@compiled
def resolved_ticks(world: World, fingers: Records, force_torque: Records) -> int:
    """Ticks of a short sub-step: at most to the next command, force/torque sample or engine step."""
    ticks = min(world.substep_ticks, world.engine_ticks - world.tick % world.engine_ticks)
    for f in range(len(fingers)):
        ticks = ticks_to_next_command(fingers[f], world.tick, ticks)
    for f in range(len(force_torque)):
        ticks = min(ticks, force_torque[f].period - world.tick % force_torque[f].period)
    return ticks


@compiled
def substep(
    world: World,
    pads: Records,
    cells: np.ndarray | None,
    fingers: Records,
    slip_sensors: Records,
    h: float,
    fraction: float,
) -> None:
    """Advance wrist, fingers, friction and object by h, a `fraction` of the engine step.

    Args:
        world: WORLD record.
        pads: Two PAD records, as an array or, faster (see `step_pads`), as a tuple.
        cells: As in `advance_engine_step`.
        fingers: Two FINGER records, likewise.
        slip_sensors: Two SLIP_SENSOR records, likewise.
        h: Time [s].
        fraction: Of the engine step: weight in its mean force and friction.
    """
    for f in range(2):
        mean = advance_lag(fingers[f], h)
        fingers[f].mean_force += fraction * mean
        # in slip the momentum counts, hence the mean force; in stick the force at the sub-step's end
        pads[f].normal = normal_force(fingers[f], mean if pads[f].slip_rate != 0.0 else fingers[f].force)
    advance_object(world, pads, cells, slip_sensors, h)
    cos, sin = pad_axes(world)
    for f in range(2):
        fx, fy, tau = pads[f].wrench
        fingers[f].reaction[0] += fraction * (cos * fx - sin * fy)
        fingers[f].reaction[1] += fraction * (sin * fx + cos * fy)
        fingers[f].reaction[2] += fraction * tau


@compiled
def advance_object(
    world: World, pads: Records, cells: np.ndarray | None, slip_sensors: Records, h: float
) -> None:
    """Advance wrist, friction and object by h under the pads' normal forces.

    Args:
        world: WORLD record.
        pads: Two PAD records, or one that stands for both, as an array or a tuple.
        cells: As in `advance_engine_step`.
        slip_sensors: As many SLIP_SENSOR records, likewise.
        h: Time [s].
    """
    # in stick: backward Euler. In slip or without contact: the mean of the velocities at both ends, of second
    # order. Where slip ends within the sub-step that would reverse the velocity: this counts as stick
    held = sticks(pads[0], h) or sticks(pads[-1], h)
    if held:
        drift = drift_on_pads(world, h)
        move_wrist(world, h)
        free, middle = free_motion_on_pads(world, drift, h), (0.0, 0.0)
    else:
        move_wrist(world, h)
        drift = motion_without_forces(world, h)
        free, middle = free_motion(world, drift, h), (0.5 * drift[0], 0.5 * drift[1])
    # levers at the time at which the accelerations apply
    centre = (world.relative[0] + middle[0], world.relative[1] + middle[1])
    # only firm stick takes sub-steps this long: the drift without friction would lie far beyond break-away,
    # from where Newton's iteration may not converge
    firm = h > 1.001 * world.calm_ticks * world.tick_length
    guess = (0.0, 0.0, 0.0) if firm else drift
    part = (0.5 if held else 1.0) * len(pads)  # one pad holds half of the object
    motion = step_pads(pads, cells, (part * world.mass, part * world.inertia), centre, free, guess, h)
    rate = 1.0 / h  # a product costs less than a quotient
    for a in range(3):
        world.relative[a] += motion[a]
        world.relative_velocity[a] = motion[a] * rate
    if held:
        follow_pads(world)
    else:
        slide(world, free, motion, h)
    slip = (motion[0] + motion[2] * centre[1], motion[1] - motion[2] * centre[0], motion[2])
    for f in range(len(pads)):
        accumulate_slip(slip_sensors[f], slip)


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
def free_motion_on_pads(world: World, drift: Vector, h: float) -> Vector:
    """Motion over h without friction by backward Euler in the pad frame, after the wrist has moved.

    The accelerations of the pads, of Coriolis and of the loads are those of the sub-step's end. An object at
    rest on the pads so gives the friction that its load at this time needs, whatever the sub-steps before.
    """
    cos, sin = pad_axes(world)
    x = cos * world.relative[0] - sin * world.relative[1]
    z = sin * world.relative[0] + cos * world.relative[1]
    ax, az, at = acceleration_by_loads(world)
    pad_x, pad_z, pad_t = acceleration_at_rest(world, x, z)
    ax, az, at = ax - pad_x, az - pad_z, at - pad_t
    square, turn = h * h, 2.0 * h * world.wrist_velocity[2]
    return (
        drift[0] + square * (cos * ax + sin * az) + turn * drift[1],
        drift[1] + square * (cos * az - sin * ax) - turn * drift[0],
        drift[2] + square * at,
    )


@compiled
def follow_pads(world: World) -> None:
    """Set the object's pose and velocity from those relative to the pads."""
    cos, sin = pad_axes(world)
    p_x, p_y, angle = world.relative
    v_x, v_y, rate = world.relative_velocity
    x, z = cos * p_x - sin * p_y, sin * p_x + cos * p_y
    omega = world.wrist_velocity[2]
    world.com[0], world.com[1] = world.wrist[0] + x, world.wrist[1] + z
    world.angle = world.wrist[2] + angle
    world.velocity[0] = world.wrist_velocity[0] - omega * z + cos * v_x - sin * v_y
    world.velocity[1] = world.wrist_velocity[1] + omega * x + sin * v_x + cos * v_y
    world.velocity[2] = omega + rate


@compiled
def free_motion(world: World, drift: Vector, h: float) -> Vector:
    """Motion over h without friction by the mean of the velocities at both ends, after the wrist has moved."""
    cos, sin = pad_axes(world)
    ax, az, at = acceleration_by_loads(world)
    gain = 0.5 * h * h
    return (
        drift[0] + gain * (cos * ax + sin * az),
        drift[1] + gain * (cos * az - sin * ax),
        drift[2] + gain * at,
    )


@compiled
def slide(world: World, free: Vector, motion: Vector, h: float) -> None:
    """Advance the object's pose and velocity over h; `motion` against `free` tells what friction did."""
    cos, sin = pad_axes(world)
    ax, az, at = acceleration_by_loads(world)
    per_gain = 2.0 / h
    braking_x = (motion[0] - free[0]) * per_gain
    braking_y = (motion[1] - free[1]) * per_gain
    # friction turns with the pads: direction in the middle of the sub-step
    back = 0.5 * h * (world.wrist_velocity[2] - 0.5 * h * world.wrist_acceleration[2])
    cos, sin = cos + back * sin, sin - back * cos
    gained_x = h * ax + cos * braking_x - sin * braking_y
    gained_z = h * az + sin * braking_x + cos * braking_y
    gained_t = h * at + (motion[2] - free[2]) * per_gain
    world.velocity[0] += gained_x
    world.velocity[1] += gained_z
    world.velocity[2] += gained_t
    world.com[0] += h * (world.velocity[0] - 0.5 * gained_x)
    world.com[1] += h * (world.velocity[1] - 0.5 * gained_z)
    world.angle += h * (world.velocity[2] - 0.5 * gained_t)


@compiled
def normal_force(finger: Finger, force: float) -> float:
    """Normal force at an actuator's force [N]: the engine's last mean, moved on by the change since."""
    if finger.contact_force <= 0.0:
        return 0.0
    return max(0.0, finger.contact_force + force - finger.contact_mean_force)


@compiled
def sticks(pad: Pad, h: float) -> bool:
    """Whether a pad sticks, or its slip is expected to end within h."""
    slip = pad.slip_rate != 0.0 and pad.slip_speed + (pad.half_step + h) * pad.slip_rate > 0.0
    return pad.normal > HOLDING and not slip


@compiled
def move_wrist(world: World, h: float) -> None:
    """Advance the commanded wrist motion by h (constant acceleration)."""
    for a in range(3):
        step = h * (world.wrist_velocity[a] + 0.5 * h * world.wrist_acceleration[a])
        world.wrist[a] += step
        world.wrist_plan[a] += step
        world.wrist_velocity[a] += h * world.wrist_acceleration[a]


@compiled
def pad_axes(world: World) -> tuple[float, float]:
    """Cosine and sine of the wrist's pitch, computed anew when it has changed."""
    if world.wrist[2] != world.pitch:
        world.pitch = world.wrist[2]
        world.axes[0], world.axes[1] = math.cos(world.pitch), math.sin(world.pitch)
    return world.axes[0], world.axes[1]


@compiled
def motion_without_forces(world: World, h: float) -> Vector:
    """Motion of the centre of mass in the pad frame over h at its present velocity, after the wrist has moved."""
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
def update_slip(world: World) -> None:
    """Update slip displacement and slip twist at the pad centre from the relative pose.

    The displacement is that of the object's point that lay at the pad centre at the grasp.
    """
    cos, sin = math.cos(world.relative[2]), math.sin(world.relative[2])
    px, py = world.grasp_point
    world.slip[0] = world.relative[0] + cos * px - sin * py
    world.slip[1] = world.relative[1] + sin * px + cos * py
    world.slip[2] = world.relative[2]
    vx, vy, omega = world.relative_velocity
    world.slip_twist[0] = vx + omega * world.relative[1]
    world.slip_twist[1] = vy - omega * world.relative[0]
    world.slip_twist[2] = omega
