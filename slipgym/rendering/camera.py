"""A camera that looks at the pads, slightly from the side and from above."""

from __future__ import annotations

import numpy as np
import pybullet as p

from slipgym.world.bullet import BulletWorld

WIDTH, HEIGHT = 480, 480
_DISTANCE = 0.34  # [m]
_FIELD_OF_VIEW = 45.0  # [deg]


def picture(world: BulletWorld) -> np.ndarray:
    """Render the scene with PyBullet's software renderer.

    Args:
        world: The world, which must be open.

    Returns:
        RGB picture (HEIGHT, WIDTH, 3), uint8.
    """
    client = world.client
    view = p.computeViewMatrixFromYawPitchRoll(
        cameraTargetPosition=[0.0, 0.0, -0.02],
        distance=_DISTANCE,
        yaw=35.0,
        pitch=-12.0,
        roll=0.0,
        upAxisIndex=2,
    )
    lens = p.computeProjectionMatrixFOV(_FIELD_OF_VIEW, WIDTH / HEIGHT, 0.02, 2.0)
    _, _, pixels, _, _ = p.getCameraImage(
        WIDTH,
        HEIGHT,
        view,
        lens,
        lightDirection=[0.4, -0.6, 1.0],
        shadow=1,
        renderer=p.ER_TINY_RENDERER,
        flags=p.ER_NO_SEGMENTATION_MASK,
        physicsClientId=client,
    )
    return np.asarray(pixels, dtype=np.uint8).reshape(HEIGHT, WIDTH, 4)[..., :3].copy()
