"""A camera at a fixed place that looks along the grip axis, somewhat from the side and from above.

The renderer is our own: it reads poses and touches nothing of the simulation, needs no
graphics hardware, and gives the same picture on every run.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from slipgym.rendering.raster import fill, shrink
from slipgym.rendering.stage import View, assemble, grid

WIDTH, HEIGHT = 480, 480
_TARGET = np.array([-0.03, 0.0, -0.015])  # [m]
_DISTANCE = 0.5  # [m]
_YAW, _PITCH = math.radians(28.0), math.radians(16.0)
_FOCAL = 2.6  # in half heights of the picture
_NEAREST = 0.05  # [m]
_LIGHT = np.array([-0.25, -0.75, 0.61])
_AMBIENT = 0.6
_TOP, _BOTTOM = np.array([249.0, 250.0, 251.0]), np.array([229.0, 232.0, 237.0])


def picture(view: View) -> np.ndarray:
    """Draw a scene.

    Args:
        view: What is where.

    Returns:
        RGB picture (HEIGHT, WIDTH, 3), uint8; the caller's own.
    """
    corners, colours = assemble(view)
    shaded = colours.copy()
    shaded[:, :3] *= 255.0 * _brightness(corners)[:, None]
    image = _backdrop().copy()
    fill(_project(corners), shaded, image, np.zeros(image.shape[:2], dtype=np.float32))
    result = np.empty((HEIGHT, WIDTH, 3), dtype=np.uint8)
    shrink(image, result)
    return result


@lru_cache(maxsize=1)
def _backdrop() -> np.ndarray:
    """The picture of an empty scene, twice as fine."""
    shades = np.linspace(0.0, 1.0, 2 * HEIGHT)[:, None]
    image = np.empty((2 * HEIGHT, 2 * WIDTH, 3), dtype=np.uint8)
    image[:] = np.rint((1.0 - shades) * _TOP + shades * _BOTTOM)[:, None]
    corners, colours = grid()
    fill(
        _project(corners), colours * [255.0, 255.0, 255.0, 1.0], image, np.zeros(image.shape[:2], np.float32)
    )
    return image


def _brightness(corners: np.ndarray) -> np.ndarray:
    """Share of a triangle's colour that is seen: ambient light and a lamp at the upper left."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    facing = normals @ _LIGHT / np.maximum(np.linalg.norm(normals, axis=1), 1e-30)
    return _AMBIENT + (1.0 - _AMBIENT) * np.maximum(facing, 0.0)


def _project(corners: np.ndarray) -> np.ndarray:
    """World points (n, 3, 3) to x, y [samples] and 1/depth; see `fill`."""
    right = np.array([math.cos(_YAW), math.sin(_YAW), 0.0])
    forward = np.array(
        [-math.sin(_YAW) * math.cos(_PITCH), math.cos(_YAW) * math.cos(_PITCH), -math.sin(_PITCH)]
    )
    up = np.cross(right, forward)
    seen = (corners - _TARGET) @ np.column_stack([right, up, forward])
    depth = seen[..., 2] + _DISTANCE
    near = np.where(depth > _NEAREST, 1.0 / np.maximum(depth, _NEAREST), 0.0)
    x = WIDTH + HEIGHT * _FOCAL * seen[..., 0] * near
    y = HEIGHT - HEIGHT * _FOCAL * seen[..., 1] * near
    return np.stack([x, y, near], axis=-1)
