"""The planar world without an engine: what the pads press with is what the actuators give."""

from __future__ import annotations

import math

from slipgym.compiled import compiled
from slipgym.contact.patch import FLAT
from slipgym.sensors.force_torque import sample_force_torque, sample_read_next
from slipgym.world.actuator import relaxed, take_up, ticks_to_next
from slipgym.world.planar import HOLDING, locate, pad_axes, substep

CHANGE = 0.1  # of slip speed or v_s within a sub-step
FIRM = 0.95  # of the friction limit; more of it is left for a load that changes
FAST = 0.7  # the same for as long as no command falls due
PATCH_FIRM, PATCH_FAST = 0.5, 0.4  # the rim of a uniform disc slips from 0.75 on


@compiled
def advance_alone(world, pads, cells, fingers, force_torque, chips):
    """Advance one world by one control step.

    Only the force/torque samples that a reading needs are taken, so that sub-steps can be long
    while the contact is calm.

    Args:
        world: WORLD record.
        pads: Two PAD records, as an array or, faster (`step_pads` says why), as a tuple.
        cells: Patches (2, CELL_FIELDS, m); None for ellipsoids.
        fingers: Two FINGER records, likewise.
        force_torque: Two FORCE_TORQUE records, likewise.
        chips: Two SLIP_SENSOR records, likewise.

    Returns:
        Number of sub-steps.
    """
    done = 0
    end = world.tick + world.control_ticks
    sample = sample_read_next(force_torque[0], world.tick, world.control_ticks)
    for f in range(2):
        fingers[f].mean_force = 0.0
        fingers[f].reaction[:] = 0.0
    while world.tick < end:
        stop = min(end, sample)
        for f in range(2):
            take_up(fingers[f], world.tick)
            stop = world.tick + ticks_to_next(fingers[f], world.tick, stop - world.tick)
        ticks = stop - world.tick
        for f in range(2):
            ticks = min(ticks, longest_substep(world, pads[f], cells, fingers[f], ticks))
        steps = -(-(stop - world.tick) // ticks)
        ticks = -(-(stop - world.tick) // steps)
        h = ticks * world.tick_length
        for f in range(2):
            press(fingers[f], h)
        if sticks(pads[0]) or sticks(pads[1]):
            carry(world, h)
        substep(world, pads, cells, fingers, chips, h, ticks / world.control_ticks)
        world.tick += ticks
        done += 1
        if world.tick == sample:
            for f in range(2):
                sample_force_torque(force_torque[f], pads[f], sample)
            sample = sample_read_next(force_torque[0], sample, world.control_ticks)
    for f in range(2):
        fingers[f].contact_force = touching(fingers[f].force)
    locate(world)
    return done


@compiled
def sticks(pad):
    """Whether a pad held the object without slip in the last sub-step."""
    return pad.normal > HOLDING and pad.slip_rate == 0.0


@compiled
def carry(world, h):
    """Give an object that sticks the velocity of the pads half of the coming sub-step ago.

    Backward Euler takes the mean velocity over a sub-step for the one at its end, half a sub-step late. In
    equal sub-steps that cancels, and friction is what the acceleration a asks for; a sub-step of h after one
    of k would ask for a (k + h) / 2 h, many times of it where h is short.

    Args:
        world: WORLD record.
        h: Length of the coming sub-step [s].
    """
    cos, sin = pad_axes(world)
    x, z = world.com[0] - world.wrist[0], world.com[1] - world.wrist[1]
    vx, vz, omega = world.wrist_velocity
    ax, az, alpha = world.wrist_acceleration
    rx, rz, turning = world.relative_velocity
    ago = 0.5 * h
    world.velocity[0] = vx - omega * z - ago * (ax - alpha * z - omega * omega * x) + cos * rx - sin * rz
    world.velocity[1] = vz + omega * x - ago * (az + alpha * x - omega * omega * z) + sin * rx + cos * rz
    world.velocity[2] = omega - ago * alpha + turning


@compiled
def touching(force):
    """What a pad presses with that is given a force [N]: nothing, if the open force loop has let it go."""
    return force if force > HOLDING else 0.0


@compiled
def press(finger, h):
    """Press with the actuator's force in a coming sub-step of h."""
    end, _ = relaxed(finger, h)
    finger.contact_force, finger.contact_mean_force = touching(end), end


@compiled
def longest_substep(world, pad, cells, finger, ticks):
    """Ticks of the longest sub-step that resolves a pad's contact, at most `ticks`, or more.

    Quick are break-away and what the Stribeck curve does to slow slip. Calm is a pad that slips where the
    curve is flat or whose slip speed hardly changes, and one that sticks within the limit; one that sticks
    well within it, or is let go, has nothing to resolve.

    Args:
        world: WORLD record.
        pad: PAD record.
        cells: None for ellipsoids; a patch breaks away in parts, so only stick is calm.
        finger: FINGER record; no command falls due within `ticks`.
        ticks: How many are asked for.
    """
    if pad.slip_rate != 0.0 and cells is not None:
        return world.substep_ticks
    if pad.slip_rate != 0.0:  # slips
        change = world.calm_ticks * world.tick_length * pad.slip_rate
        flat = pad.slip_speed + min(change, 0.0) > FLAT * pad.stribeck_velocity
        calm = flat or abs(change) < CHANGE * min(pad.slip_speed, pad.stribeck_velocity)
        return world.calm_ticks if calm else world.substep_ticks
    normal = touching(min(finger.force, finger.command))  # the least within `ticks`
    if normal <= 0.0:
        return ticks if finger.contact_force <= 0.0 else world.substep_ticks
    fx, fy, rim = pad.wrench[0], pad.wrench[1], pad.wrench[2] / pad.r
    share = math.sqrt(fx * fx + fy * fy + rim * rim) / (pad.mu_s * normal)
    firm, fast = (FIRM, FAST) if cells is None else (PATCH_FIRM, PATCH_FAST)
    if share > firm or pad.slip_speed > CHANGE * pad.stribeck_velocity:
        return world.substep_ticks
    return world.calm_ticks if share > fast else ticks
