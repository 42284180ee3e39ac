"""Steps PyBullet with an object that pads hold upright: it moves in the contact plane alone."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from slipgym.world.actuator import FINGER_DAMPING
from slipgym.world.bullet_rows import BulletRows
from slipgym.world.quiet_pybullet import p
from slipgym.world.scene import FINGER_LINKS, JOINTS, WRIST_FORCE, WRIST_JOINTS

_LEAST = 1e-9  # [N]; less is rounding of a finger that touches nothing


def stepper(
    client: int, body: int, gripper: int, rows: BulletRows, steps: int, inertia: float
) -> Callable[[tuple[Any, ...]], tuple[Any, ...]]:
    """Return a function that advances by some engine steps.

    Normal forces are read off the fingers' momentum: what slows a finger down besides its effort and its
    damping. They equal the sums over the engine's contact points, to rounding, and take less time to read.

    Args:
        client: PyBullet's client.
        body: The box.
        gripper: The gripper.
        rows: The compiled functions of the world; `loads` is called.
        steps: Number of engine steps.
        inertia: Mass of a finger times the rate of the engine [kg/s].

    Returns:
        The function: it takes `BulletWorld.reading` and returns the new one.
    """
    push, twist, drive = p.applyExternalForce, p.applyExternalTorque, p.setJointMotorControlArray
    engine_step, effort, motion, world = p.stepSimulation, p.TORQUE_CONTROL, p.VELOCITY_CONTROL, p.WORLD_FRAME
    pose_of, velocity_of, joints_of = p.getBasePositionAndOrientation, p.getBaseVelocity, p.getJointStates
    first, second = FINGER_LINKS
    count = range(steps)

    def advance(reading: tuple[Any, ...]) -> tuple[Any, ...]:
        loads = rows.loads
        pose, velocity, wrist, normals, (*_, before_1, before_2) = reading
        for _ in count:
            (force, torque), at_first, at_second, efforts, speeds = loads(pose, velocity, wrist, normals)
            push(body, -1, force, pose[0], world, client)
            twist(body, -1, torque, world, client)
            push(gripper, first, at_first[1], at_first[0], world, client)
            twist(gripper, first, at_first[2], world, client)
            push(gripper, second, at_second[1], at_second[0], world, client)
            twist(gripper, second, at_second[2], world, client)
            drive(gripper, FINGER_LINKS, effort, forces=efforts, physicsClientId=client)
            drive(
                gripper,
                WRIST_JOINTS,
                motion,
                targetVelocities=speeds,
                forces=WRIST_FORCE,
                physicsClientId=client,
            )
            engine_step(client)
            pose, velocity = pose_of(body, client), velocity_of(body, client)
            x, z, pitch, finger_1, finger_2 = joints_of(gripper, JOINTS, client)
            wrist, after_1, after_2 = (x[0], z[0], pitch[0]), finger_1[1], finger_2[1]
            normal_1 = efforts[0] - inertia * (after_1 - before_1) - FINGER_DAMPING * before_1
            normal_2 = efforts[1] - inertia * (after_2 - before_2) - FINGER_DAMPING * before_2
            normals = normal_1 if normal_1 > _LEAST else 0.0, normal_2 if normal_2 > _LEAST else 0.0
            before_1, before_2 = after_1, after_2
        return pose, velocity, wrist, normals, (x[1], z[1], pitch[1], before_1, before_2)

    return advance
