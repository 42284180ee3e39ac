"""The planar world without an engine: what the pads press with is what the actuators give."""

from __future__ import annotations

from slipgym.compiled import compiled
from slipgym.contact.patch import FLAT
from slipgym.sensors.force_torque import sample_force_torque, sample_read_next
from slipgym.world.actuator import command, least_force, relax_through, take_up, ticks_to_next
from slipgym.world.planar import HOLDING, locate, pad_axes, slide

CHANGE = 0.1  # of slip speed or v_s within a sub-step
STILL = 0.03  # of v_s: a pad's vibration with this speed is one to two percent of its limit
FIRM = 0.95  # of the friction limit; more of it is left for a load that changes
FAST = 0.7  # the same for as long as no command falls due
PATCH_FIRM, PATCH_FAST = 0.5, 0.4  # the rim of a uniform disc slips from 0.75 on


@compiled
def move(worlds, pads, cells, fingers, force_torque, chips, force, i):
    """Advance world i by one control step under a commanded grip force.

    Its fingers press alike on pads that are alike. If their centres of pressure are, too, one pad is solved
    for, with half of the object, and the other takes over what became of it.

    Args:
        worlds: WORLD (n,).
        pads: PAD (n, 2).
        cells: Patches (n, 2, CELL_FIELDS, m); None for ellipsoids.
        fingers: FINGER (n, 2).
        force_torque: FORCE_TORQUE (n, 2).
        chips: SLIP_SENSOR (n, 2).
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
        both, eyes = (pads[i, 0], pads[i, 1]), (chips[i, 0], chips[i, 1])
        return advance_alone(world, both, patches, (first, second), sensors, eyes)
    done = advance_alone(world, (pads[i, 0],), patches, (first,), sensors, (chips[i, 0],))
    pads[i, 1] = pads[i, 0]
    if cells is not None:
        cells[i, 1] = cells[i, 0]
    second.served, second.command = first.served, first.command
    second.force, second.contact_force = first.force, first.contact_force
    for k in range(3):
        chips[i, 1].moved[k] = chips[i, 0].moved[k]
    return done


@compiled
def advance_alone(world, pads, cells, fingers, force_torque, chips):
    """Advance one world by one control step.

    Only the force/torque samples that a reading needs are taken, so that sub-steps can be long
    while the contact is calm.

    Args:
        world: WORLD record.
        pads: Two PAD records, or one that stands for both, as a tuple (`step_pads` says why).
        cells: Their patches, as in `move`.
        fingers: As many FINGER records.
        force_torque: Two FORCE_TORQUE records.
        chips: As many SLIP_SENSOR records as pads.

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
        steps = -(-(stop - world.tick) // ticks)
        ticks = -(-(stop - world.tick) // steps)
        h = ticks * world.tick_length
        if sticks(pads[0]) or sticks(pads[-1]):
            carry(world, h)
        for f in range(len(pads)):
            press(world, pads[f], fingers[f], ticks)
        slide(world, pads, cells, chips, h)
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
    ax, az, alpha = carrying(world, x, z)
    rx, rz, turning = world.relative_velocity
    ago = 0.5 * h
    world.velocity[0] = vx - omega * z - ago * ax + cos * rx - sin * rz
    world.velocity[1] = vz + omega * x - ago * az + sin * rx + cos * rz
    world.velocity[2] = omega - ago * alpha + turning


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

    Quick are break-away and what the Stribeck curve does to slow slip. Calm is a pad that slips where the
    curve is flat or whose slip speed hardly changes, and one that sticks within the limit; one that sticks
    well within it and still, or is let go, has nothing to resolve.

    Args:
        world: WORLD record.
        pad: PAD record.
        cells: None for ellipsoids; a patch breaks away in parts, so only stick is calm.
        finger: FINGER record.
        load: Wrench that both pads are to carry, see `load_to_carry`.
        ticks: How many are asked for.
    """
    if pad.slip_rate != 0.0 and cells is not None:
        return world.substep_ticks
    if pad.slip_rate != 0.0:  # slips
        change = world.calm_ticks * world.tick_length * pad.slip_rate
        flat = pad.slip_speed + min(change, 0.0) > FLAT * pad.stribeck_velocity
        calm = flat or abs(change) < CHANGE * min(pad.slip_speed, pad.stribeck_velocity)
        return world.calm_ticks if calm else world.substep_ticks
    normal = touching(least_force(finger, world.tick + ticks))
    if normal <= 0.0:
        free = finger.contact_force <= 0.0
        return ticks_to_next(finger, world.tick, ticks) if free else world.substep_ticks
    fx, fy, torque = pad.wrench
    present = size(pad, fx, fy, torque)
    fx, fy = 0.5 * load[0], 0.5 * load[1]
    coming = size(pad, fx, fy, 0.5 * load[2] - pad.cop[0] * fy + pad.cop[1] * fx)
    share = max(present, coming) / (pad.r * pad.mu_s * normal) ** 2
    firm, fast = (FIRM, FAST) if cells is None else (PATCH_FIRM, PATCH_FAST)
    if share > firm * firm or vibrates(world, pad):
        return world.substep_ticks
    return world.calm_ticks if share > fast * fast else ticks


@compiled
def size(pad, fx, fy, torque):
    """Square of a wrench in the norm of the limit surface, times r [N^2 m^2]."""
    return pad.r * pad.r * (fx * fx + fy * fy) + torque * torque


@compiled
def vibrates(world, pad):
    """Whether the object that a pad holds moves in its bristles, as after slip; long steps would damp it."""
    vx, vy, omega = world.relative_velocity
    rim = pad.r * omega
    return vx * vx + vy * vy + rim * rim > (STILL * pad.stribeck_velocity) ** 2
