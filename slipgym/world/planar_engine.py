"""The planar engine: object, wrist and fingers without PyBullet, a control step at a time.

The mean of both actuators' forces is either pad's normal force. Sub-steps are as
long as the contact allows (`slipgym.world.substep_length`).
"""

from __future__ import annotations

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym._numba.rows import row_of
from slipgym.contact.kinds import PATCHES, set_normal
from slipgym.contact.records import Pad, Pair, copy_patch_state, same_pads, same_patches
from slipgym.contact.soft_pad import load_pad
from slipgym.sensors.force_torque import next_sample
from slipgym.world.actuator import (
    advance_fingers_through_commands,
    apply_due_commands,
    mean_force,
    queue_command,
    ticks_to_next_command,
)
from slipgym.world.object_motion import wrench_at_rest
from slipgym.world.records import Records, World, copy_finger_state, same_fingers
from slipgym.world.substep import HOLDING, advance_object, resolved_ticks, sample_finger, update_slip
from slipgym.world.substep_length import longest_common_substep


@compiled
def step_world(
    worlds: np.ndarray,
    pads: np.ndarray,
    cells: np.ndarray | None,
    fingers: np.ndarray,
    force_torque: np.ndarray,
    slip_sensors: np.ndarray,
    force: float,
    i: int,
) -> int:
    """Advance world i by one control step under a commanded grip force.

    If both fingers and both pads are the same in parameters and state, one pad is solved with half of the
    object's mass, and its state is copied to the other.

    Args:
        worlds: WORLD (n,).
        pads: PAD (n, 2).
        cells: As `slipgym.world.plant.Plant.cells`.
        fingers: FINGER (n, 2).
        force_torque: FORCE_TORQUE (n, 2).
        slip_sensors: SLIP_SENSOR (n, 2).
        force: Grip force per finger [N].
        i: Which world.

    Returns:
        Number of sub-steps.
    """
    world, patches = worlds[i], row_of(cells, i)
    for f in range(2):
        load_pad(pads[i, f], pads[i, f].normal)
    first, second = fingers[i, 0], fingers[i, 1]
    sensors = force_torque[i, 0], force_torque[i, 1]
    queue_command(first, world.tick, force)
    queue_command(second, world.tick, force)
    both = pads[i, 0], pads[i, 1]
    if not alike(both, patches, (first, second)):
        eyes = slip_sensors[i, 0], slip_sensors[i, 1]
        return advance_substeps(world, both, patches, (first, second), sensors, eyes)
    done = advance_substeps(world, (pads[i, 0],), patches, (first,), sensors, (slip_sensors[i, 0],))
    pads[i, 1] = pads[i, 0]
    if cells is not None:
        copy_patch_state(cells[i], pads[i, 0])
    copy_finger_state(first, second)
    for k in range(3):
        slip_sensors[i, 1].moved[k] = slip_sensors[i, 0].moved[k]
    return done


@compiled
def alike(pads: Records, cells: np.ndarray | None, fingers: Records) -> bool:
    """Whether both pads, their patches and both fingers are the same in parameters and state."""
    if not (same_pads(pads[0], pads[1]) and same_fingers(fingers[0], fingers[1])):
        return False
    return cells is None or cells.ndim != PATCHES or same_patches(cells, pads[0])


@compiled
def advance_substeps(
    world: World,
    pads: Records,
    cells: np.ndarray | None,
    fingers: Records,
    force_torque: Records,
    slip_sensors: Records,
) -> int:
    """Advance one world, whose records these are, by one control step; returns the number of sub-steps.

    While the contact is calm, sub-steps are long, and only the force/torque samples that a reading needs are
    taken. Slip, break-away and vibration take the same sub-steps as with PyBullet: friction that falls with
    speed amplifies any difference.

    Pads, fingers and slip sensors are two each, or one that stands for both, as tuples (see `step_pads`).
    """
    done = 0
    end = world.tick + world.control_ticks
    load = wrench_at_rest(world)
    sample = next_sample(force_torque, world.tick, world.control_ticks)
    while world.tick < end:
        for f in range(len(pads)):
            apply_due_commands(fingers[f], world.tick)
        stop = min(end, sample)
        cut = False
        while True:  # at most twice: a short sub-step also ends with a command that falls due
            ticks = longest_common_substep(world, pads, cells, fingers, load, stop)
            if cut or ticks >= stop - world.tick:
                break
            until, cut = stop, True
            for f in range(len(pads)):
                stop = world.tick + ticks_to_next_command(fingers[f], world.tick, stop - world.tick)
            if stop == until:
                break
        calm = ticks > world.substep_ticks
        if calm:
            steps = -(-(stop - world.tick) // ticks)
            ticks = -(-(stop - world.tick) // steps)
        else:
            ticks = resolved_ticks(world, fingers, force_torque)
        h = ticks * world.tick_length
        impulse, force = set_normal_forces(world, pads, cells, fingers, ticks)
        slipped = pads[0].slip_rate != 0.0, pads[-1].slip_rate != 0.0
        advance_object(world, pads, cells, slip_sensors, h, impulse)
        for f in range(len(pads)):
            if slipped[f] and pads[f].slip_rate != 0.0:
                move_to_end(pads[f], cells, force)
        world.tick += ticks
        done += 1
        if world.tick == sample:
            for f in range(2):
                sample_finger(force_torque[f], pads[min(f, len(pads) - 1)], world)
            sample = next_sample(force_torque, sample, world.control_ticks)
    normal = normal_force_of(mean_force(fingers))
    for f in range(len(pads)):
        fingers[f].contact_force = normal
    update_slip(world)
    return done


@compiled
def normal_force_of(force: float) -> float:
    """Normal force of a pad at the mean actuator force [N]: 0 if the open force loop has let it go."""
    return force if force > HOLDING else 0.0


@compiled
def set_normal_forces(
    world: World, pads: Records, cells: np.ndarray | None, fingers: Records, ticks: int
) -> Pair:
    """Set the pads' normal forces for a sub-step: in stick those of its end.

    In slip the mean weighted by the time that is left: it gives the displacement, exactly if friction is in
    proportion to it. The momentum changes by the plain mean.

    Returns:
        Plain mean over the weighted, and the normal force at the end [N].
    """
    mean, early = advance_fingers_through_commands(fingers, world.tick, ticks, world.tick_length)
    mean, early, now = normal_force_of(mean), normal_force_of(early), normal_force_of(mean_force(fingers))
    for f in range(len(pads)):
        fingers[f].contact_force = early if pads[f].slip_rate != 0.0 else now
        set_normal(pads[f], cells, fingers[f].contact_force)
    return mean / early if early > 0.0 else 1.0, now


@compiled
def move_to_end(pad: Pad, cells: np.ndarray | None, force: float) -> None:
    """Give a pad that slips the normal force of a sub-step's end [N], and friction in proportion to it."""
    if cells is None or cells.ndim != PATCHES:
        share = force / pad.normal if pad.normal > 0.0 else 0.0
        pad.normal = force
        for a in range(3):
            pad.wrench[a] *= share
