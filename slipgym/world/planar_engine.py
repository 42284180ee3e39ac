"""The planar world without an engine: what the pads press with is what the actuators give."""

from __future__ import annotations

from slipgym._numba.compiled import compiled
from slipgym.sensors.force_torque import sample_force_torque, sample_read_next
from slipgym.world.actuator import command, least_force, relax_through, take_up, ticks_to_next
from slipgym.world.substep import HOLDING, locate, pad_axes, resolving_ticks, slide

FIRM = 0.95  # of the friction limit; more of it is left for a load that changes
FAST = 0.7  # the same for as long as no command falls due
PATCH_FIRM, PATCH_FAST = 0.5, 0.4  # the rim of a uniform disc slips from 0.75 on
STILL = 1e-3  # of the friction limit; a weaker vibration of what sticks may be damped


@compiled
def move(worlds, pads, cells, fingers, force_torque, slip_sensors, force, i):
    """Advance world i by one control step under a commanded grip force.

    Its fingers press alike on pads that are alike. If their centres of pressure are, too, one pad is solved
    for, with half of the object, and the other takes over what became of it.

    Args:
        worlds: WORLD (n,).
        pads: PAD (n, 2).
        cells: Patches (n, 2, CELL_FIELDS, m); None for ellipsoids.
        fingers: FINGER (n, 2).
        force_torque: FORCE_TORQUE (n, 2).
        slip_sensors: SLIP_SENSOR (n, 2).
        force: Grip force per finger [N].
        i: Which world.

    Returns:
        Number of sub-steps.
    """
    world, patches = worlds[i], None if cells is None else cells[i]
    first, second = fingers[i, 0], fingers[i, 1]
    sensors = force_torque[i, 0], force_torque[i, 1]
    command(first, world.tick, force)
    command(second, world.tick, force)
    here, there = pads[i, 0].cop, pads[i, 1].cop
    if here[0] != there[0] or here[1] != there[1]:
        both, eyes = (pads[i, 0], pads[i, 1]), (slip_sensors[i, 0], slip_sensors[i, 1])
        return advance_alone(world, both, patches, (first, second), sensors, eyes)
    done = advance_alone(world, (pads[i, 0],), patches, (first,), sensors, (slip_sensors[i, 0],))
    pads[i, 1] = pads[i, 0]
    if cells is not None:
        cells[i, 1] = cells[i, 0]
    second.served, second.command = first.served, first.command
    second.force, second.contact_force = first.force, first.contact_force
    for k in range(3):
        slip_sensors[i, 1].moved[k] = slip_sensors[i, 0].moved[k]
    return done


@compiled
def advance_alone(world, pads, cells, fingers, force_torque, slip_sensors):
    """Advance one world by one control step.

    While the contact is calm sub-steps are long: only the force/torque samples that a reading needs are
    taken. What must be resolved is, in the very sub-steps of a world with an engine: friction that falls with
    speed amplifies any difference.

    Args:
        world: WORLD record.
        pads: Two PAD records, or one that stands for both, as a tuple (`step_pads` says why).
        cells: Their patches, as in `move`.
        fingers: As many FINGER records.
        force_torque: Two FORCE_TORQUE records.
        slip_sensors: As many SLIP_SENSOR records as pads.

    Returns:
        Number of sub-steps.
    """
    done = 0
    end = world.tick + world.control_ticks
    load = load_to_carry(world)
    sample = sample_read_next(force_torque[0], world.tick, world.control_ticks)
    while world.tick < end:
        for f in range(len(pads)):
            take_up(fingers[f], world.tick)
        stop = min(end, sample)
        ticks = longest_of_all(world, pads, cells, fingers, load, stop)
        if ticks < stop - world.tick:  # then a command that falls due ends a sub-step, too
            for f in range(len(pads)):
                stop = world.tick + ticks_to_next(fingers[f], world.tick, stop - world.tick)
            ticks = longest_of_all(world, pads, cells, fingers, load, stop)
        calm = ticks > world.substep_ticks
        if calm:
            steps = -(-(stop - world.tick) // ticks)
            ticks = -(-(stop - world.tick) // steps)
        else:
            ticks = resolving_ticks(world, fingers, force_torque)
        h = ticks * world.tick_length
        if calm and rests(pads):
            carry(world, h)
        for f in range(len(pads)):
            press(world, pads[f], fingers[f], ticks)
        slide(world, pads, cells, slip_sensors, h)
        if calm and rests(pads):
            carry(world, world.substep_ticks * world.tick_length)
        world.tick += ticks
        done += 1
        if world.tick == sample:
            for f in range(2):
                sample_force_torque(force_torque[f], pads[min(f, len(pads) - 1)], sample)
            sample = sample_read_next(force_torque[0], sample, world.control_ticks)
    for f in range(len(pads)):
        fingers[f].contact_force = touching(fingers[f].force)
    locate(world)
    return done


@compiled
def rests(pads):
    """Whether the pads held the object without slip in the last sub-step."""
    slip = pads[0].slip_rate != 0.0 or pads[-1].slip_rate != 0.0
    return not slip and max(pads[0].normal, pads[-1].normal) > HOLDING


@compiled
def carry(world, h):
    """Give an object that rests on the pads their velocity half of the coming sub-step ago.

    Backward Euler takes the mean velocity over a sub-step for the one at its end, half a sub-step late. In
    equal sub-steps that cancels, and friction is what the acceleration a asks for; a sub-step of h after one
    of k would ask for a (k + h) / 2 h, many times of it where h is short.

    Args:
        world: WORLD record.
        h: Length of the coming sub-step [s].
    """
    x, z = world.com[0] - world.wrist[0], world.com[1] - world.wrist[1]
    vx, vz, omega = world.wrist_velocity
    ax, az, alpha = carrying(world, x, z)
    ago = 0.5 * h
    world.velocity[0] = vx - omega * z - ago * ax
    world.velocity[1] = vz + omega * x - ago * az
    world.velocity[2] = omega - ago * alpha
    world.relative_velocity[:] = 0.0


@compiled
def carrying(world, x, z):
    """Acceleration of an object at rest on the pads, its centre of mass (x, z) from theirs in the world."""
    ax, az, alpha = world.wrist_acceleration
    square = world.wrist_velocity[2] ** 2
    return ax - alpha * z - square * x, az + alpha * x - square * z, alpha


@compiled
def load_to_carry(world):
    """Wrench about the pads' centre, in the pad frame, that keeps an object at rest on them [N, N, N m].

    What pushes the object and how the wrist accelerates change with a control step, and the last wrench
    does not know of it: a poke may break away what was held firmly.
    """
    x, z = world.com[0] - world.wrist[0], world.com[1] - world.wrist[1]
    ax, az, alpha = carrying(world, x, z)
    fx = world.mass * ax - world.external[0]
    fz = world.mass * (az + world.gravity) - world.external[1]
    torque = world.inertia * alpha - world.external[2] + x * fz - z * fx
    cos, sin = pad_axes(world)
    return cos * fx + sin * fz, cos * fz - sin * fx, torque


@compiled
def touching(force):
    """What a pad presses with that is given a force [N]: nothing, if the open force loop has let it go."""
    return force if force > HOLDING else 0.0


@compiled
def press(world, pad, finger, ticks):
    """Press with the actuator's mean force over a sub-step in slip, with that at its end in stick.

    With the force at the end the momentum of a slide under a closing grip would be wrong in the first order.
    """
    mean = relax_through(finger, world.tick, ticks, world.tick_length)
    pad.normal = finger.contact_force = touching(mean if pad.slip_rate != 0.0 else finger.force)


@compiled
def longest_of_all(world, pads, cells, fingers, load, stop):
    """Ticks of the longest sub-step that resolves the contact of every pad, at most those until `stop`."""
    asked = ticks = stop - world.tick
    for f in range(len(pads)):
        ticks = min(ticks, longest_substep(world, pads[f], cells, fingers[f], load, asked))
    return ticks


@compiled
def longest_substep(world, pad, cells, finger, load, ticks):
    """Ticks of the longest sub-step that resolves a pad's contact, at most `ticks`, or more.

    Slip, break-away and vibration in stick are resolved. A pad that sticks within the limit and rests is
    calm; one that rests well within it, or is let go, has nothing to resolve.

    Args:
        world: WORLD record.
        pad: PAD record.
        cells: None for ellipsoids; a patch breaks away in parts.
        finger: FINGER record.
        load: Wrench that both pads are to carry, see `load_to_carry`.
        ticks: How many are asked for.
    """
    if pad.slip_rate != 0.0:
        return world.substep_ticks
    normal = touching(least_force(finger, world.tick + ticks))
    if normal <= 0.0:
        free = finger.contact_force <= 0.0
        return ticks_to_next(finger, world.tick, ticks) if free else world.substep_ticks
    fx, fy, torque = pad.wrench
    gx, gy = 0.5 * load[0], 0.5 * load[1]
    goal = 0.5 * load[2] - pad.cop[0] * gy + pad.cop[1] * gx
    most = max(size(pad, fx, fy, torque), size(pad, gx, gy, goal))
    limit = (pad.r * pad.mu_s * normal) ** 2
    swing = size(pad, fx - gx, fy - gy, torque - goal) + swinging(world, pad, normal)
    firm, fast = (FIRM, FAST) if cells is None else (PATCH_FIRM, PATCH_FAST)
    if most > firm * firm * limit or swing > STILL * STILL * limit:
        return world.substep_ticks
    return world.calm_ticks if most > fast * fast * limit else ticks


@compiled
def size(pad, fx, fy, torque):
    """Square of a wrench in the norm of the limit surface, times r [N^2 m^2]."""
    return pad.r * pad.r * (fx * fx + fy * fy) + torque * torque


@compiled
def swinging(world, pad, normal):
    """What the motion relative to the pads amounts to in terms of `size` when the bristles have stopped it.

    Their stiffness k turns a kinetic energy E into a force of (2 k E)^0.5; a pad has half of the object.
    """
    vx, vy, omega = world.relative_velocity
    energy = world.mass * (vx * vx + vy * vy) + world.inertia * omega * omega
    return 0.5 * pad.r * pad.r * pad.sigma_0 * normal * energy
