"""Draws the view: gripper and object, with forces and slip over them."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from PIL import Image

from slipgym.rendering.camera import FINE, Camera
from slipgym.rendering.look import Contact, Pose, View
from slipgym.rendering.poses import above, name_gravity, push
from slipgym.rendering.raster import fill
from slipgym.rendering.stage import assemble, grid

_LIGHT = np.array([-0.25, -0.75, 0.61])
_AMBIENT = 0.6
_TOP, _BOTTOM = np.array([249.0, 250.0, 251.0]), np.array([229.0, 232.0, 237.0])


def draw_scene(view: View, contact: Contact, camera: Camera, target: Pose | None = None) -> Image.Image:
    """Draw the scene, RGB, in the size of the camera's view, with the pose that the task asks for if any."""
    corners, colours = assemble(view)
    shaded = colours.copy()
    shaded[:, :3] *= 255.0 * _brightness(corners)[:, None]
    image, nearness = _backdrop(camera).copy(), _empty(camera)
    fill(camera.project(corners), shaded, image, nearness)
    fill(*push(view, contact, 0, camera), image, nearness)  # nearer bodies hide it
    nearness[:] = 0.0
    fill(*above(view, contact, camera, target), image, nearness)
    picture = Image.fromarray(image).reduce(FINE)
    if camera.layout.strip:
        name_gravity(picture, camera)
    return picture


def measure_depth(view: View, camera: Camera) -> np.ndarray:
    """Distances along the camera's axis, (height, width) float32 [m]; the background is infinite."""
    corners, colours = assemble(view)
    nearness = _empty(camera)
    image = np.zeros((*nearness.shape, 3), np.uint8)
    fill(camera.project(corners), np.ones_like(colours), image, nearness)
    rows = np.maximum(nearness[::FINE], nearness[1::FINE])
    nearest = np.maximum(rows[:, ::FINE], rows[:, 1::FINE])
    return np.divide(1.0, nearest, out=np.full_like(nearest, math.inf), where=nearest > 0.0)


@lru_cache(maxsize=4)
def _backdrop(camera: Camera) -> np.ndarray:
    """The picture of an empty scene, with `FINE` samples per pixel."""
    nearness = _empty(camera)
    shades = np.linspace(0.0, 1.0, len(nearness))[:, None]
    image = np.empty((*nearness.shape, 3), dtype=np.uint8)
    image[:] = np.rint((1.0 - shades) * _TOP + shades * _BOTTOM)[:, None]
    corners, colours = grid(camera.target, camera.pixel * max(nearness.shape))
    fill(camera.project(corners), colours * [255.0, 255.0, 255.0, 1.0], image, nearness)
    return image


def _empty(camera: Camera) -> np.ndarray:
    """Nearness of a view without anything in it, with `FINE` samples per pixel."""
    return np.zeros((FINE * camera.layout.height, FINE * camera.layout.width), dtype=np.float32)


def _brightness(corners: np.ndarray) -> np.ndarray:
    """Brightness of triangles, 0 to 1: ambient light and a lamp at the upper left."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    facing = normals @ _LIGHT / np.maximum(np.linalg.norm(normals, axis=1), 1e-30)
    return _AMBIENT + (1.0 - _AMBIENT) * np.maximum(facing, 0.0)
