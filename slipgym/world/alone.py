"""The planar world without an engine: what the pads press with is what the actuators give."""

from __future__ import annotations

from slipgym.compiled import compiled
from slipgym.sensors.force_torque import sample_force_torque, sample_read_next
from slipgym.world.actuator import take_up, ticks_to_next
from slipgym.world.planar import HOLDING, locate, substep


@compiled
def advance_alone(world, pads, cells, fingers, force_torque, chips):
    """Advance one world by one control step.

    Only the force/torque samples that a reading needs are taken, so that sub-steps can be long.

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
        steps = -(-(stop - world.tick) // world.substep_ticks)
        ticks = -(-(stop - world.tick) // steps)
        for f in range(2):
            press(fingers[f])
        share = ticks / world.control_ticks
        substep(world, pads, cells, fingers, chips, ticks * world.tick_length, share)
        world.tick += ticks
        if world.tick == sample:
            for f in range(2):
                sample_force_torque(force_torque[f], pads[f], sample)
            sample = sample_read_next(force_torque[0], sample, world.control_ticks)
    for f in range(2):
        press(fingers[f])
    locate(world)


@compiled
def press(finger):
    """The pad presses with the actuator's force; one that the open force loop has let go does not."""
    force = finger.force if finger.force > HOLDING else 0.0
    finger.contact_force = finger.contact_mean_force = force
