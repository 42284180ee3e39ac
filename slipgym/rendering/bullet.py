"""What PyBullet's world looks like now. Reads poses only: a picture changes nothing."""

from __future__ import annotations

import numpy as np
import pybullet as p

from slipgym.rendering.stage import View
from slipgym.world.bullet import BulletWorld
from slipgym.world.scene import FINGER_LINKS, WRIST_JOINTS


def look(world: BulletWorld, material: str, pad_radius: float) -> View:
    """Where everything is in a world.

    Args:
        world: The world, open and reset.
        material: Name of the object's material.
        pad_radius: Radius of the pads [m].
    """
    client = world.client
    position, orientation = p.getBasePositionAndOrientation(world.body, physicsClientId=client)
    rotation = np.reshape(p.getMatrixFromQuaternion(orientation), (3, 3))
    joints = p.getJointStates(world.gripper, (*WRIST_JOINTS, *FINGER_LINKS), physicsClientId=client)
    x, z, pitch, first, second = (joint[0] for joint in joints)
    centre = np.array(position)
    return View(world.box, material, centre, rotation, (x, z, pitch), (first, second), pad_radius)
