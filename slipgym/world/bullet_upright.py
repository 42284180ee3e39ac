"""Steps PyBullet with an object that pads hold upright: it moves in the contact plane alone."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from slipgym.world.momentum import normal_forces
from slipgym.world.quiet_pybullet import p
from slipgym.world.scene import FINGER_LINKS, WRIST_FORCE, WRIST_JOINTS


def step(
    client: int,
    body: int,
    gripper: int,
    loads: Callable[..., tuple[Any, ...]],
    reading: tuple[Any, ...],
    read: Callable[[int, int, int], tuple[Any, ...]],
    steps: int,
    inertia: float,
) -> tuple[Any, ...]:
    """Advance by some engine steps.

    Args:
        client: PyBullet's client.
        body: The box.
        gripper: The gripper.
        loads: `slipgym.world.bullet_rows.BulletRows.loads`.
        reading: `BulletWorld.reading`.
        read: Reads, for client, box and gripper: pose and velocity of the box, the wrist's joints, and the
            speeds of all joints.
        steps: Number of engine steps.
        inertia: Mass of a finger times the rate of the engine [kg/s].

    Returns:
        The new reading.
    """
    push, twist, drive = p.applyExternalForce, p.applyExternalTorque, p.setJointMotorControlArray
    (first, second), world = FINGER_LINKS, p.WORLD_FRAME
    pose, velocity, wrist, normals, before = reading
    for _ in range(steps):
        (force, torque), at_first, at_second, efforts, speeds = loads(pose, velocity, wrist, normals)
        push(body, -1, force, pose[0], world, client)
        twist(body, -1, torque, world, client)
        push(gripper, first, at_first[1], at_first[0], world, client)
        twist(gripper, first, at_first[2], world, client)
        push(gripper, second, at_second[1], at_second[0], world, client)
        twist(gripper, second, at_second[2], world, client)
        drive(gripper, FINGER_LINKS, p.TORQUE_CONTROL, forces=efforts, physicsClientId=client)
        drive(
            gripper,
            WRIST_JOINTS,
            p.VELOCITY_CONTROL,
            targetVelocities=speeds,
            forces=WRIST_FORCE,
            physicsClientId=client,
        )
        p.stepSimulation(client)
        pose, velocity, wrist, after = read(client, body, gripper)
        normals = normal_forces(efforts, before, after, inertia)
        before = after
    return pose, velocity, wrist, normals, before
