"""Steps PyBullet with an object that may tilt; pads and object do not collide there."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from slipgym.world.bullet_rows import BulletRows
from slipgym.world.quiet_pybullet import p
from slipgym.world.scene import FINGER_LINKS, JOINTS, WRIST_FORCE

_FORCES = (*WRIST_FORCE, 1e4, 1e4)


def stepper(
    client: int,
    body: int,
    gripper: int,
    rows: BulletRows,
    steps: int,
    read: Callable[[int, int, int], tuple[Any, ...]],
) -> Callable[[tuple[Any, ...]], tuple[Any, ...]]:
    """Return a function that advances by some engine steps.

    Args:
        client: PyBullet's client.
        body: The box.
        gripper: The gripper.
        rows: The compiled functions of the world; `loads` is called.
        steps: Number of engine steps.
        read: Reads, for client, box and gripper: pose and velocity of the box, the wrist's joints, and the
            speeds of all joints.

    Returns:
        The function: it takes `BulletWorld.reading` and returns the new one.
    """
    push, twist, drive = p.applyExternalForce, p.applyExternalTorque, p.setJointMotorControlArray
    (first, second), world, motor, engine_step = (
        FINGER_LINKS,
        p.WORLD_FRAME,
        p.VELOCITY_CONTROL,
        p.stepSimulation,
    )

    def advance(reading: tuple[Any, ...]) -> tuple[Any, ...]:
        loads = rows.loads
        for _ in range(steps):
            pose, velocity, wrist, _, _ = reading
            (force, torque), at_first, at_second, speeds, normals = loads(pose, velocity, wrist)
            push(body, -1, force, pose[0], world, client)
            twist(body, -1, torque, world, client)
            push(gripper, first, at_first[1], at_first[0], world, client)
            twist(gripper, first, at_first[2], world, client)
            push(gripper, second, at_second[1], at_second[0], world, client)
            twist(gripper, second, at_second[2], world, client)
            drive(gripper, JOINTS, motor, targetVelocities=speeds, forces=_FORCES, physicsClientId=client)
            engine_step(client)
            pose, velocity, wrist, after = read(client, body, gripper)
            reading = pose, velocity, wrist, normals, after
        return reading

    return advance
