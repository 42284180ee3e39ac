"""The planar world without an engine: what the pads press with is what the actuators give."""

from __future__ import annotations

import math

from slipgym.compiled import compiled
from slipgym.sensors.force_torque import sample_force_torque, sample_read_next
from slipgym.world.actuator import relaxed, take_up, ticks_to_next
from slipgym.world.planar import HOLDING, locate, substep

FLAT = 3.0  # slip speed over v_s from which the Stribeck curve has decayed, to exp(-9)
CHANGE = 0.1  # of slip speed or v_s within a sub-step
FIRM = 0.95  # of the friction limit; more of it is left for a load that changes
PATCH_FIRM = 0.5  # the rim of a uniform disc slips from 0.75 on


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
    """
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
        ticks = world.calm_ticks
        for f in range(2):
            if not calm(pads[f], cells, fingers[f], ticks * world.tick_length):
                ticks = world.substep_ticks
        steps = -(-(stop - world.tick) // ticks)
        ticks = -(-(stop - world.tick) // steps)
        h = ticks * world.tick_length
        for f in range(2):
            press(fingers[f], h)
        substep(world, pads, cells, fingers, chips, h, ticks / world.control_ticks)
        world.tick += ticks
        if world.tick == sample:
            for f in range(2):
                sample_force_torque(force_torque[f], pads[f], sample)
            sample = sample_read_next(force_torque[0], sample, world.control_ticks)
    for f in range(2):
        fingers[f].contact_force = touching(fingers[f].force)
    locate(world)


@compiled
def touching(force):
    """What a pad presses with that is given a force [N]: nothing, if the open force loop has let it go."""
    return force if force > HOLDING else 0.0


@compiled
def press(finger, h):
    """The pad presses with the actuator's mean force over a sub-step of h.

    With the force at its end the momentum of a slide under a closing grip would be wrong in the first order.
    """
    end, mean = relaxed(finger, h)
    finger.contact_force, finger.contact_mean_force = touching(mean), end


@compiled
def calm(pad, cells, finger, h):
    """Whether nothing about a pad's contact is quick, so that a sub-step of h resolves it.

    Quick are break-away and what the Stribeck curve does to slow slip. Calm is a pad that sticks well within
    the limit, one that slips where the curve is flat, one whose slip speed hardly changes, and one let go.

    Args:
        pad: PAD record.
        cells: None for ellipsoids; a patch breaks away in parts, so only stick is calm.
        finger: FINGER record; no command falls due within h.
        h: Sub-step [s].
    """
    if pad.slip_rate != 0.0:  # slips
        change = h * pad.slip_rate
        if pad.slip_speed + min(change, 0.0) > FLAT * pad.stribeck_velocity:
            return True
        return abs(change) < CHANGE * min(pad.slip_speed, pad.stribeck_velocity)
    normal = touching(min(finger.force, finger.command))  # the least within h
    if normal <= 0.0:
        return finger.contact_force <= 0.0
    fx, fy, rim = pad.wrench[0], pad.wrench[1], pad.wrench[2] / pad.r
    share = FIRM if cells is None else PATCH_FIRM
    firm = math.sqrt(fx * fx + fy * fy + rim * rim) < share * pad.mu_s * normal
    return firm and pad.slip_speed < CHANGE * pad.stribeck_velocity
