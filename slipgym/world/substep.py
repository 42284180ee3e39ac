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
from typing import Any

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.contact.coupled import step_pads
from slipgym.contact.kinds import set_normal
from slipgym.contact.records import Pad
from slipgym.contact.soft_pad import load_pad
from slipgym.sensors.force_torque import sample_force_torque
from slipgym.sensors.slip_velocity import accumulate_slip
from slipgym.sensors.structure import vibrate
from slipgym.world.actuator import advance_fingers, apply_due_commands, mean_force, ticks_to_next_command
from slipgym.world.object_motion import (
    drift_on_pads,
    follow_pads,
    force_at_start,
    free_motion,
    free_motion_on_pads,
    motion_without_forces,
    pad_axes,
    slide,
    velocity_on_pads,
    with_last_friction,
)
from slipgym.world.records import Finger, Records, World

HOLDING = 1e-2  # [N]; pads with less, a fiftieth of the smallest grip, do not hold the object
RESOLVED = 0.2
"""Angle of a vibration on rubber per sub-step [rad]: its period is then off by 0.2^2 / 12 = 0.3 %."""


@compiled
def advance_engine_step(
    world: World,
    pads: Records,
    cells: np.ndarray | None,
    fingers: Records,
    force_torque: Records,
    slip_sensors: Records,
) -> None:
    """Advance one world, whose records these are, two of each finger's, by one engine step.

    `cells` are the pads' patches (2, CELL_FIELDS, m), None for ellipsoids.
    """
    start = world.tick
    end = start + world.engine_ticks
    for f in range(2):
        fingers[f].mean_force = 0.0
        fingers[f].reaction[:] = 0.0
    for f in range(2):
        load_pad(pads[f], pads[f].normal)
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
                sample_finger(force_torque[f], pads[f], world)


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
    """Advance wrist, fingers, friction and object by h [s].

    `fraction` of the engine step is the weight in its mean force and friction. Records of the fingers may be
    arrays or, faster (see `step_pads`), tuples.
    """
    mean = advance_fingers(fingers, h)
    now = mean_force(fingers)
    for f in range(2):
        fingers[f].mean_force += fraction * mean
        # in slip the momentum counts, hence the mean force; in stick the force at the sub-step's end
        force = mean if pads[f].slip_rate != 0.0 else now
        set_normal(pads[f], cells, normal_force(fingers[f], force))
    advance_object(world, pads, cells, slip_sensors, h)
    cos, sin = pad_axes(world)
    for f in range(2):
        fx, fy, tau = pads[f].wrench
        fingers[f].reaction[0] += fraction * (cos * fx - sin * fy)
        fingers[f].reaction[1] += fraction * (sin * fx + cos * fy)
        fingers[f].reaction[2] += fraction * tau


@compiled
def advance_object(
    world: World,
    pads: Records,
    cells: np.ndarray | None,
    slip_sensors: Records,
    h: float,
    impulse: float = 1.0,
) -> None:
    """Advance wrist, friction and object by h [s] under the pads' normal forces.

    There may be one pad and slip sensor that stand for both. `impulse` is, in slip, the mean normal force
    over the one that the pads have.
    """
    # in stick: backward Euler. In slip or without contact: the mean of the velocities at both ends, of second
    # order. Where slip ends within the sub-step that would reverse the velocity: this counts as stick
    held = sticks(pads[0], h) or sticks(pads[-1], h)
    # rubber vibrates slowly: the mean of the forces at both ends, of second order, where sub-steps resolve it
    elastic = False
    if held and cells is not None:
        longest = world.substep_ticks * world.tick_length
        elastic = pads[0].compliance > 0.0 and h < 1.001 * max(longest, longest_vibration(world, pads[0]))
    part = 0.5 * len(pads)  # one pad holds half of the object
    if held:
        drift = drift_on_pads(world, h)
        before = force_at_start(world, pads) if elastic else (0.0, 0.0, 0.0)
        move_wrist(world, h)
        free = free_motion_on_pads(world, drift, before, elastic, h)
        part, middle = (4.0 if elastic else 1.0) * part, (0.0, 0.0)
    else:
        move_wrist(world, h)
        drift = motion_without_forces(world, h)
        free = free_motion(world, drift, h)
        part, middle = 2.0 * part, (0.5 * drift[0], 0.5 * drift[1])
    # levers at the time at which the accelerations apply
    centre = (world.relative[0] + middle[0], world.relative[1] + middle[1])
    guess = drift
    if held and h > 1.001 * world.calm_ticks * world.tick_length:
        # firm stick: the drift without friction would lie far beyond break-away, from where Newton's
        # iteration may not converge
        guess = (0.0, 0.0, 0.0)
    elif not held:
        guess = with_last_friction(world, pads, free, h)
    motion = step_pads(pads, cells, (part * world.mass, part * world.inertia), centre, free, guess, h)
    rate = 1.0 / h  # a product costs less than a quotient
    for a in range(3):
        world.relative[a] += motion[a]
        world.relative_velocity[a] = motion[a] * rate
    if held:
        # at the end: by backward Euler that of the sub-step, else twice it less that at the start
        both, start = (2.0 * rate, rate) if elastic else (rate, 0.0)
        follow_pads(
            world,
            both * motion[0] - start * drift[0],
            both * motion[1] - start * drift[1],
            both * motion[2] - start * drift[2],
        )
    else:
        slide(world, free, motion, impulse, h)
        if h > 1.001 * world.substep_ticks * world.tick_length:  # the mean would be that of too long ago
            vx, vy, omega = velocity_on_pads(world)
            world.relative_velocity[0], world.relative_velocity[1], world.relative_velocity[2] = vx, vy, omega
    slip = (motion[0] + motion[2] * centre[1], motion[1] - motion[2] * centre[0], motion[2])
    for f in range(len(pads)):
        accumulate_slip(slip_sensors[f], slip)


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
def longest_vibration(world: World, pad: Pad) -> float:
    """Longest sub-step that resolves the object's vibration on the rubber of pads like this one [s]."""
    x, y = pad.pressure_centre[0] - world.relative[0], pad.pressure_centre[1] - world.relative[1]
    mobility = 1.0 / world.mass + (pad.radius * pad.radius + x * x + y * y) / world.inertia
    stiffness = 2.0 / (pad.compliance + 1.0 / (pad.sigma_0 * max(pad.normal, HOLDING)))
    return RESOLVED / math.sqrt(stiffness * mobility)


@compiled
def move_wrist(world: World, h: float) -> None:
    """Advance the commanded wrist motion by h (constant acceleration)."""
    for a in range(3):
        step = h * (world.wrist_velocity[a] + 0.5 * h * world.wrist_acceleration[a])
        world.wrist[a] += step
        world.wrist_plan[a] += step
        world.wrist_velocity[a] += h * world.wrist_acceleration[a]


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


@compiled
def weigh_tip(sensor: Any, world: World) -> None:
    """Set `tip_load` of a FORCE_TORQUE record to weight and inertia of the fingertip in front of it now.

    Such a sensor reads m (g - a) beside the load on the pad, with m the mass between it and the object, g
    gravity and a the acceleration of the pad centre, where the mass is taken to be (for tools at a wrist:
    Shaker & Erden, arXiv 2604.23696). Only the part in the contact plane counts; it turns with the pitch.
    """
    cos, sin = pad_axes(world)
    x, z = -world.wrist_acceleration[0], -world.gravity - world.wrist_acceleration[1]
    sensor.tip_load[0] = sensor.tip_mass * (cos * x + sin * z)
    sensor.tip_load[1] = sensor.tip_mass * (cos * z - sin * x)


@compiled
def sample_finger(sensor: Any, pad: Pad, world: World) -> None:
    """`sample_force_torque` of a finger whose tip has a mass and may vibrate, at the world's time."""
    sample_force_torque(sensor, pad, world.tick)
    if sensor.tip_mass > 0.0:
        weigh_tip(sensor, world)
        load = sensor.history[(world.tick // sensor.period) % sensor.kept]
        load[0] += sensor.tip_load[0]
        load[1] += sensor.tip_load[1]
    if sensor.mode[0] > 0.0:
        vibrate(sensor, sensor.history[(world.tick // sensor.period) % sensor.kept])
