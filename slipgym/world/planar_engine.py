"""The planar engine: object, wrist and fingers without PyBullet, a control step at a time.

The mean of both actuators' forces is either pad's normal force. Sub-steps are long while the contact is calm.
"""

from __future__ import annotations

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym._numba.rows import row_of
from slipgym.contact.disc_surface import INNER
from slipgym.contact.kinds import PATCHES, set_normal
from slipgym.contact.records import DISC, Pad, Vector
from slipgym.contact.soft_pad import load_pad, static_limit
from slipgym.sensors.force_torque import next_sample_read, sample_force_torque
from slipgym.world.actuator import (
    advance_fingers_through_commands,
    apply_due_commands,
    highest_mean_force,
    lowest_mean_force,
    mean_force,
    queue_command,
    ticks_to_next_command,
)
from slipgym.world.object_motion import acceleration_at_rest, pad_axes
from slipgym.world.records import Finger, Records, World
from slipgym.world.substep import HOLDING, advance_object, resolved_ticks, update_slip

FIRM = 0.95  # of the friction limit: below it sub-steps may have `calm_ticks`; the rest is for changing loads
FAST = 0.7  # of the friction limit: below it a sub-step may last until the next command
PATCH_FIRM, PATCH_FAST = 0.5, 0.4  # the rim of a uniform disc slips from 0.75 on
STILL = 1e-3  # of the friction limit; a weaker vibration of what sticks may be damped


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
    if not (same_pads(pads[i, 0], pads[i, 1]) and same_fingers(first, second)):
        both, eyes = (pads[i, 0], pads[i, 1]), (slip_sensors[i, 0], slip_sensors[i, 1])
        return advance_substeps(world, both, patches, (first, second), sensors, eyes)
    done = advance_substeps(world, (pads[i, 0],), patches, (first,), sensors, (slip_sensors[i, 0],))
    pads[i, 1] = pads[i, 0]
    if cells is not None:
        cells[i, 1] = cells[i, 0]
    second.served, second.command = first.served, first.command
    second.force, second.contact_force = first.force, first.contact_force
    for k in range(3):
        slip_sensors[i, 1].moved[k] = slip_sensors[i, 0].moved[k]
    return done


@compiled
def same_pads(first: Pad, second: Pad) -> bool:
    """Whether two pads have the same friction, centre of pressure and state."""
    same = first.mu_c == second.mu_c and first.mu_s == second.mu_s and first.r == second.r
    same = same and first.cop[0] == second.cop[0] and first.cop[1] == second.cop[1]
    for a in range(3):
        same = same and first.z[a] == second.z[a] and first.shear[a] == second.shear[a]
    return same and first.slip_speed == second.slip_speed and first.slip_rate == second.slip_rate


@compiled
def same_fingers(first: Finger, second: Finger) -> bool:
    """Whether two fingers have the same force loop and force."""
    same = first.lag == second.lag and first.dead_ticks == second.dead_ticks and first.gain == second.gain
    return same and first.force == second.force and first.command == second.command


@compiled
def advance_substeps(
    world: World,
    pads: Records,
    cells: np.ndarray | None,
    fingers: Records,
    force_torque: Records,
    slip_sensors: Records,
) -> int:
    """Advance one world by one control step.

    While the contact is calm, sub-steps are long, and only the force/torque samples that a reading needs are
    taken. Slip, break-away and vibration take the same sub-steps as with PyBullet: friction that falls with
    speed amplifies any difference.

    Args:
        world: WORLD record.
        pads: Two PAD records, or one that stands for both, as a tuple (see `step_pads`).
        cells: Their patches, as in `step_world`.
        fingers: As many FINGER records.
        force_torque: Two FORCE_TORQUE records.
        slip_sensors: As many SLIP_SENSOR records as pads.

    Returns:
        Number of sub-steps.
    """
    done = 0
    end = world.tick + world.control_ticks
    load = wrench_at_rest(world)
    sample = next_sample_read(force_torque[0], world.tick, world.control_ticks)
    while world.tick < end:
        for f in range(len(pads)):
            apply_due_commands(fingers[f], world.tick)
        stop = min(end, sample)
        ticks = longest_common_substep(world, pads, cells, fingers, load, stop)
        if ticks < stop - world.tick:  # then a command that falls due ends a sub-step, too
            for f in range(len(pads)):
                stop = world.tick + ticks_to_next_command(fingers[f], world.tick, stop - world.tick)
            ticks = longest_common_substep(world, pads, cells, fingers, load, stop)
        calm = ticks > world.substep_ticks
        if calm:
            steps = -(-(stop - world.tick) // ticks)
            ticks = -(-(stop - world.tick) // steps)
        else:
            ticks = resolved_ticks(world, fingers, force_torque)
        h = ticks * world.tick_length
        set_normal_forces(world, pads, cells, fingers, ticks)
        advance_object(world, pads, cells, slip_sensors, h)
        world.tick += ticks
        done += 1
        if world.tick == sample:
            for f in range(2):
                sample_force_torque(force_torque[f], pads[min(f, len(pads) - 1)], sample)
            sample = next_sample_read(force_torque[0], sample, world.control_ticks)
    normal = normal_force_of(mean_force(fingers))
    for f in range(len(pads)):
        fingers[f].contact_force = normal
    update_slip(world)
    return done


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
def normal_force_of(force: float) -> float:
    """Normal force of a pad at the mean actuator force [N]: 0 if the open force loop has let it go."""
    return force if force > HOLDING else 0.0


@compiled
def set_normal_forces(
    world: World, pads: Records, cells: np.ndarray | None, fingers: Records, ticks: int
) -> None:
    """Set the pads' normal forces: the mean over a sub-step in slip, the value at its end in stick.

    The value at the end would give the momentum of a slide under a closing grip an error of first order.
    """
    mean = advance_fingers_through_commands(fingers, world.tick, ticks, world.tick_length)
    now = mean_force(fingers)
    for f in range(len(pads)):
        fingers[f].contact_force = normal_force_of(mean if pads[f].slip_rate != 0.0 else now)
        set_normal(pads[f], cells, fingers[f].contact_force)


@compiled
def longest_common_substep(
    world: World, pads: Records, cells: np.ndarray | None, fingers: Records, load: Vector, stop: int
) -> int:
    """Ticks of the longest sub-step that resolves the contact of every pad, at most those until `stop`."""
    asked = ticks = stop - world.tick
    for f in range(len(pads)):
        goal = expected_wrench(pads, f, load)
        ticks = min(ticks, longest_substep(world, pads[f], cells, fingers, goal, asked))
    return ticks


@compiled
def expected_wrench(pads: Records, f: int, load: Vector) -> Vector:
    """Wrench that a pad will have at its centre of pressure when all pads carry a load [N, N, N m].

    Args:
        pads: Two PAD records, or one that stands for both.
        f: Which of them.
        load: Wrench that both pads are to carry, see `wrench_at_rest`.
    """
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
def longest_substep(
    world: World, pad: Pad, cells: np.ndarray | None, fingers: Records, goal: Vector, ticks: int
) -> int:
    """Ticks of the longest sub-step that resolves a pad's contact, at most `ticks`, or more.

    Slip, break-away and vibration in stick need short sub-steps. A pad at rest below FIRM of the limit is
    calm; one at rest below FAST of it, or without contact, needs no sub-steps of its own.

    Args:
        world: WORLD record.
        pad: PAD record.
        cells: Which kind of pad; a patch breaks away in parts.
        fingers: The FINGER records of all pads.
        goal: Wrench that the pad is to carry, see `expected_wrench`.
        ticks: Ticks asked for.
    """
    if pad.slip_rate != 0.0:
        return world.substep_ticks
    normal = normal_force_of(lowest_mean_force(fingers, world.tick + ticks))
    if normal <= 0.0:
        highest = normal_force_of(highest_mean_force(fingers, world.tick + ticks))
        return ticks if max(fingers[0].contact_force, highest) <= 0.0 else world.substep_ticks
    fx, fy, torque = pad.wrench
    gx, gy, turned = goal
    most = max(squared_norm(pad, fx, fy, torque), squared_norm(pad, gx, gy, turned))
    weaker = min(pad.axes[0], pad.axes[1])
    limit = (pad.radius * weaker * static_limit(pad, normal)) ** 2
    swing = squared_norm(pad, fx - gx, fy - gy, torque - turned) + squared_vibration_force(world, pad, normal)
    firm, fast = FIRM, FAST
    if cells is not None:
        if cells.ndim == PATCHES:
            firm, fast = PATCH_FIRM, PATCH_FAST
        elif pad.surface == DISC:
            firm, fast = INNER * FIRM, INNER * FAST
    if most > firm * firm * limit or swing > STILL * STILL * limit:
        return world.substep_ticks
    return world.calm_ticks if most > fast * fast * limit else ticks


@compiled
def squared_norm(pad: Pad, fx: float, fy: float, torque: float) -> float:
    """Square of a wrench in the norm of the limit surface, times r [N^2 m^2]."""
    return pad.radius * pad.radius * (fx * fx + fy * fy) + torque * torque


@compiled
def squared_vibration_force(world: World, pad: Pad, normal: float) -> float:
    """`squared_norm` of the force with which the bristles will have stopped the motion relative to the pads.

    Their stiffness k turns a kinetic energy E into a force of (2 k E)^0.5; a pad has half of the object.
    """
    vx, vy, omega = world.relative_velocity
    energy = world.mass * (vx * vx + vy * vy) + world.inertia * omega * omega
    bristles = pad.sigma_0 * normal
    return 0.5 * pad.radius * pad.radius * bristles / (1.0 + pad.compliance * bristles) * energy
