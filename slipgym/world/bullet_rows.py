"""Steps a single world in PyBullet, with compiled functions for the first row of its arrays."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numba import types

from slipgym._numba.compiled import compiled
from slipgym._numba.fixed import Fixed, direct_call, opened
from slipgym._numba.rows import row_of
from slipgym.contact.records import Vector
from slipgym.world.actuator import FINGER_DAMPING, queue_command
from slipgym.world.bullet_coupling import engine_loads
from slipgym.world.bullet_coupling import read_engine as coupled_reading
from slipgym.world.plant import Plant
from slipgym.world.quiet_pybullet import p
from slipgym.world.scene import FINGER_LINKS, JOINTS, WRIST_FORCE, WRIST_JOINTS
from slipgym.world.substep import update_slip
from slipgym.world.tilt_coupling import tilted_loads as coupled_loads

VECTOR, PAIR = types.UniTuple(types.float64, 3), types.UniTuple(types.float64, 2)
POSE = types.Tuple([VECTOR, types.UniTuple(types.float64, 4)])
"""Types of what the engine is read into."""
_LEAST = 1e-9  # [N]; less is rounding of a finger that touches nothing
_FORCES = (*WRIST_FORCE, 1e4, 1e4)


@compiled
def loads(
    fixed: Fixed, pose: tuple, velocity: tuple, wrist: Vector, normals: tuple[float, float]
) -> tuple[Any, ...]:
    """`engine_loads` of the first world; `fixed` has the arrays of its records."""
    worlds, pads, cells, fingers, force_torque, slip_sensors = opened(fixed)
    bodies = worlds[0], pads[0], row_of(cells, 0), fingers[0], force_torque[0], slip_sensors[0]
    return engine_loads(bodies, pose, velocity, wrist, normals)


@compiled
def tilted_loads(fixed: Fixed, pose: tuple, velocity: tuple, wrist: Vector) -> tuple[Any, ...]:
    """`slipgym.world.tilt_coupling.tilted_loads` of the first world; `fixed` has the arrays, tilts last."""
    worlds, pads, cells, fingers, force_torque, slip_sensors, tilts = opened(fixed)
    bodies = worlds[0], pads[0], row_of(cells, 0), fingers[0], force_torque[0], slip_sensors[0]
    return coupled_loads(bodies, tilts[0], pose, velocity, wrist)


@compiled
def read_engine(
    worlds: np.ndarray, fingers: np.ndarray, pose: tuple, wrist: Vector, normals: tuple[float, float]
) -> None:
    """`read_engine` of the first world, and its slip."""
    coupled_reading(worlds[0], fingers[0], pose, wrist, normals)
    update_slip(worlds[0])


@compiled
def queue(worlds: np.ndarray, fingers: np.ndarray, force: float) -> None:
    """`queue_command` of both fingers of the first world [N]."""
    for f in range(2):
        queue_command(fingers[0, f], worlds[0].tick, force)


class BulletRows:
    """These functions, compiled for the arrays of a plant, which must stay, without numba's dispatch.

    Attributes:
        loads: Takes the arguments of `loads` after the first; those of `tilted_loads` with `physics.tilt`.
        queue: Takes the grip force [N].
    """

    def __init__(self, plant: Plant) -> None:
        function: Any = loads
        arrays: tuple[Any, ...] = (
            plant.world,
            plant.pads,
            plant.cells,
            plant.fingers,
            plant.force_torque,
            plant.slip_sensors,
        )
        readings: list[Any] = [POSE, types.UniTuple(VECTOR, 2), VECTOR, PAIR]
        if plant.tilt is not None:
            function, arrays = tilted_loads, (*arrays, plant.tilt)
            readings.pop()
        self.loads = direct_call(function, (Fixed(arrays),), *readings)
        self.queue = direct_call(queue, (plant.world, plant.fingers), types.float64)


def read_bodies(client: int, body: int, gripper: int) -> tuple[Any, ...]:
    """Pose and velocity of the box, positions of the wrist's joints, speeds of all."""
    pose = p.getBasePositionAndOrientation(body, client)
    velocity = p.getBaseVelocity(body, client)
    x, z, pitch, first, second = p.getJointStates(gripper, JOINTS, client)
    return pose, velocity, (x[0], z[0], pitch[0]), (x[1], z[1], pitch[1], first[1], second[1])


def stepper(
    client: int, body: int, gripper: int, rows: BulletRows, steps: int, inertia: float | None
) -> Callable[[tuple[Any, ...]], tuple[Any, ...]]:
    """Return a function that takes `BulletWorld.reading` and returns the one after some engine steps.

    Of an upright object, which moves in the contact plane alone, normal forces are read off the fingers'
    momentum: what slows a finger down besides its effort and its damping. They equal the sums over the
    engine's contact points, to rounding, and take less time to read. Pads and an object that may tilt do not
    collide in the engine.

    `rows.loads` is called. `inertia` is the mass of a finger times the rate of the engine [kg/s]; None: the
    object may tilt.
    """
    push, twist, drive = p.applyExternalForce, p.applyExternalTorque, p.setJointMotorControlArray
    world, effort, motion = p.WORLD_FRAME, p.TORQUE_CONTROL, p.VELOCITY_CONTROL
    engine_step, (first, second) = p.stepSimulation, FINGER_LINKS

    def apply(place: Any, own: Any, at_first: Any, at_second: Any) -> None:
        parts = (body, -1, (place, *own)), (gripper, first, at_first), (gripper, second, at_second)
        for bodies, link, (point, force, torque) in parts:
            push(bodies, link, force, point, world, client)
            twist(bodies, link, torque, world, client)

    def upright(reading: tuple[Any, ...], inertia: float) -> tuple[Any, ...]:
        pose, velocity, wrist, normals, (*_, before_1, before_2) = reading
        own, at_first, at_second, efforts, speeds = rows.loads(pose, velocity, wrist, normals)
        apply(pose[0], own, at_first, at_second)
        drive(gripper, FINGER_LINKS, effort, forces=efforts, physicsClientId=client)
        goal: dict[str, Any] = {"targetVelocities": speeds, "forces": WRIST_FORCE}
        drive(gripper, WRIST_JOINTS, motion, **goal, physicsClientId=client)
        engine_step(client)
        pose, velocity, wrist, after = read_bodies(client, body, gripper)
        normal_1 = efforts[0] - inertia * (after[3] - before_1) - FINGER_DAMPING * before_1
        normal_2 = efforts[1] - inertia * (after[4] - before_2) - FINGER_DAMPING * before_2
        normals = normal_1 if normal_1 > _LEAST else 0.0, normal_2 if normal_2 > _LEAST else 0.0
        return pose, velocity, wrist, normals, after

    def tilted(reading: tuple[Any, ...]) -> tuple[Any, ...]:
        pose, velocity, wrist, _, _ = reading
        own, at_first, at_second, speeds, normals = rows.loads(pose, velocity, wrist)
        apply(pose[0], own, at_first, at_second)
        drive(gripper, JOINTS, motion, targetVelocities=speeds, forces=_FORCES, physicsClientId=client)
        engine_step(client)
        pose, velocity, wrist, after = read_bodies(client, body, gripper)
        return pose, velocity, wrist, normals, after

    def advance(reading: tuple[Any, ...]) -> tuple[Any, ...]:
        for _ in range(steps):
            reading = tilted(reading) if inertia is None else upright(reading, inertia)
        return reading

    return advance
