"""Moves the object and the jaws out of the contact plane: along the grip axis, and in tilt.

The frame is the contact plane's, which rolls about x and sways along y with the wrist: x and z span the
plane, finger 1 is on the side of +y. The planar world advances first; its motion in the plane and its
friction are given here. The steps are as short as the stiffest contact needs, and of second order.

- Either pad presses as a disc of springs (`slipgym.contact.foundation`). Its force acts along y: it moves and
  tilts the object and opens the jaws.
- The jaws mirror each other, as those of a parallel gripper with one motor do. Both actuators close them. The
  difference of the normal forces is carried by the mechanism, so that a weight along the grip axis does not
  push both jaws aside.
- Without contact the object is a free rigid body in three dimensions, and its angle in the plane is computed
  here. While pads hold it, the planar world determines that angle.
"""

from __future__ import annotations

import math

from slipgym._numba.compiled import compiled
from slipgym.contact.coupled import solve_symmetric
from slipgym.contact.foundation import press
from slipgym.contact.records import Symmetric, Vector
from slipgym.world.object_motion import pad_axes
from slipgym.world.records import Records, Tilt, World
from slipgym.world.rotation import (
    angle_in_plane,
    inertia_tensor,
    spin_with,
    times,
    turned,
    upright,
    with_angle,
)

_ANGLE = 0.25  # [rad] by which the stiffest oscillation advances in a step, at most
_DECAY = 0.4  # fraction that the strongest damping takes in a step, at most
_UPRIGHT = 0.5  # cosine of the tilt beyond which the pads have lost the object


@compiled
def advance_tilt(
    world: World, tilt: Tilt, pads: Records, fingers: Records, before: Vector, torque: float, dt: float
) -> None:
    """Advance by an engine step of dt [s], after the planar world, with its mean forces and friction.

    `before` are centre of mass (x, z) and angle at the step's start [m, m, rad], `torque` is the load about
    the grip axis while nothing holds the object [N m].
    """
    held = pads[0].normal > 0.0 or pads[1].normal > 0.0
    about_y = (before[2] - world.angle) / dt
    arms = pad_arm(world, tilt, 0), pad_arm(world, tilt, 1)
    steps = math.ceil(dt * fastest_rate(world, tilt, arms))
    h = dt / steps
    gyration = (tilt.gyration[0], tilt.gyration[1], tilt.gyration[2])
    pull = friction_moment(world, fingers)
    closing_force = fingers[0].mean_force + fingers[1].mean_force
    middle_z, rate_z = 0.5 * (before[1] + world.com[1]), (world.com[1] - before[1]) / dt
    y, v, c, v_c = tilt.height, tilt.speed, tilt.closure, tilt.closing
    q = (tilt.attitude[0], tilt.attitude[1], tilt.attitude[2], tilt.attitude[3])
    momentum = (tilt.momentum[0], tilt.momentum[1], tilt.momentum[2])
    spin = spin_of(inertia_tensor(q, world.mass, gyration), momentum, about_y, tilt.roll[1], held)
    tilt.normal[:] = 0.0
    tilt.moment[:] = 0.0
    for k in range(steps):
        time = (k + 0.5) * h
        roll_rate = tilt.roll[1] + time * tilt.roll[2]
        roll = tilt.roll[0] + 0.5 * time * (tilt.roll[1] + roll_rate)
        # forces in the step's middle
        half = turned(q, spin, 0.5 * h)
        tensor = inertia_tensor(half, world.mass, gyration)
        height, closure = y + 0.5 * h * v, c + 0.5 * h * v_c
        normal = upright(half)
        force_y, force_c, moment_x, moment_z = 0.0, 0.0, 0.0, 0.0
        for f in range(2):
            side, arm = 1.0 - 2.0 * f, arms[f]
            depth = closure + side * (height - normal[0] * arm[0] - normal[2] * arm[1])
            rate = v_c + side * (v + spin[2] * arm[0] - spin[0] * arm[1])
            pressed, m_x, m_z = press(
                depth if normal[1] > _UPRIGHT else -1.0,
                (-side * normal[0], -side * normal[2]),
                (rate, side * spin[2], -side * spin[0]),
                tilt.pad_radius,
                tilt.relaxation,
            )
            pressed, m_x, m_z = tilt.stiffness * pressed, tilt.stiffness * m_x, tilt.stiffness * m_z
            force_y -= side * pressed
            force_c += pressed
            moment_x += side * (arm[1] * pressed + m_z)
            moment_z -= side * (arm[0] * pressed + m_x)
            tilt.normal[f] += pressed
            tilt.moment[f, 0] += m_x
            tilt.moment[f, 1] += m_z
        falling = acceleration_along_y(tilt, roll, roll_rate, height, middle_z, rate_z)
        gained = h * (falling + force_y / world.mass)
        y += h * (v + 0.5 * gained)
        v += gained
        resisting = force_c + tilt.jaw_damping * v_c
        gained = h * (closing_force - resisting) / tilt.jaw_mass
        c += h * (v_c + 0.5 * gained)
        v_c += gained
        # the momentum turns against the frame
        turn = 0.5 * h * roll_rate
        _, l_y, l_z = momentum
        after = (
            momentum[0] + h * (pull[0] + moment_x),
            l_y + h * roll_rate * (l_z - turn * l_y) - (0.0 if held else h * torque),
            l_z + h * (pull[1] + moment_z) - h * roll_rate * (l_y + turn * l_z),
        )
        old = spin_of(tensor, momentum, about_y, roll_rate, held)
        spin = spin_of(tensor, after, about_y, roll_rate, held)
        mean = (0.5 * (old[0] + spin[0]), 0.5 * (old[1] + spin[1]), 0.5 * (old[2] + spin[2]))
        q, momentum = turned(q, mean, h), after
    tilt.roll[0] += dt * (tilt.roll[1] + 0.5 * dt * tilt.roll[2])
    tilt.roll[1] += dt * tilt.roll[2]
    tilt.sway[0] += dt * (tilt.sway[1] + 0.5 * dt * tilt.sway[2])
    tilt.sway[1] += dt * tilt.sway[2]
    if held:
        q = with_angle(q, world.angle)
        tensor = inertia_tensor(q, world.mass, gyration)
        momentum = momentum[0], times(tensor, (spin[0] + tilt.roll[1], spin[1], spin[2]))[1], momentum[2]
    else:
        turn = angle_in_plane(q) - world.angle
        world.angle += turn - 2.0 * math.pi * round(turn / (2.0 * math.pi))
        world.velocity[2] = -spin[1]
    tilt.height, tilt.speed, tilt.closure, tilt.closing = y, v, c, v_c
    for a in range(3):
        tilt.momentum[a], tilt.spin[a] = momentum[a], spin[a]
    for a in range(4):
        tilt.attitude[a] = q[a]
    for f in range(2):
        tilt.normal[f] /= steps
        tilt.moment[f, 0] /= steps
        tilt.moment[f, 1] /= steps
        shift_pressure(world, tilt, pads[f], f)


@compiled
def acceleration_along_y(tilt: Tilt, roll: float, roll_rate: float, y: float, z: float, v_z: float) -> float:
    """Acceleration along y of a free object at (y, z) in the frame that rolls and sways [m/s^2]."""
    weight = -tilt.gravity * math.sin(roll) - tilt.sway[2]
    return weight + tilt.roll[2] * z + roll_rate * (roll_rate * y + 2.0 * v_z)


@compiled
def spin_of(tensor: Symmetric, momentum: Vector, about_y: float, roll_rate: float, held: bool) -> Vector:
    """Angular velocity in the rolling frame; of a held object the component about y is given [rad/s]."""
    if held:
        x, y, z = spin_with(tensor, momentum, about_y)
    else:
        x, y, z = solve_symmetric(tensor, momentum)
    return x - roll_rate, y, z


@compiled
def fastest_rate(world: World, tilt: Tilt, arms: tuple[tuple[float, float], tuple[float, float]]) -> float:
    """Steps per time that the stiffest oscillation of object and jaws needs, from bounds [1/s]."""
    lever = 0.25 * tilt.pad_radius**2
    for f in range(2):
        lever = max(lever, 0.25 * tilt.pad_radius**2 + arms[f][0] ** 2 + arms[f][1] ** 2)
    per_mass = (1.0 + lever / min(tilt.gyration[0], tilt.gyration[2])) / world.mass + 1.0 / tilt.jaw_mass
    square = 2.0 * tilt.stiffness * per_mass
    return max(math.sqrt(square) / _ANGLE, square * tilt.relaxation / _DECAY)


@compiled
def pad_arm(world: World, tilt: Tilt, f: int) -> tuple[float, float]:
    """Vector (x, z) from the centre of mass to the centre of a pad's pressure without tilt [m]."""
    cos, sin = pad_axes(world)
    x, y = tilt.cop_rest[f]
    return (
        world.wrist[0] + cos * x - sin * y - world.com[0],
        world.wrist[1] + sin * x + cos * y - world.com[1],
    )


@compiled
def friction_moment(world: World, fingers: Records) -> tuple[float, float]:
    """Moment about x and z of the pads' friction, which acts on the object's faces [N m]."""
    half = world.half_thickness
    return (
        half * (fingers[0].reaction[1] - fingers[1].reaction[1]),
        -half * (fingers[0].reaction[0] - fingers[1].reaction[0]),
    )


@compiled
def shift_pressure(world: World, tilt: Tilt, pad: Records, f: int) -> None:
    """Move a pad's centre of pressure to where tilt has it: its moment over its normal force."""
    x, y = 0.0, 0.0
    if tilt.normal[f] > 0.0:
        cos, sin = pad_axes(world)
        m_x, m_z = tilt.moment[f, 0], tilt.moment[f, 1]
        length = math.sqrt(m_x * m_x + m_z * m_z)
        # damping can carry a moment that the pressure alone could not
        scale = 1.0 / max(tilt.normal[f], length / tilt.pad_radius)
        x, y = scale * (cos * m_x + sin * m_z), scale * (cos * m_z - sin * m_x)
    pad.cop[0] = tilt.cop[f, 0] = tilt.cop_rest[f, 0] + x
    pad.cop[1] = tilt.cop[f, 1] = tilt.cop_rest[f, 1] + y
