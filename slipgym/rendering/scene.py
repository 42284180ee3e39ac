"""Draws the view: gripper and object, with forces and slip over them, by filled triangles.

Compiled code rasterises them. It needs no GL, takes milliseconds and gives the same picture on every machine.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from PIL import Image

from slipgym._numba.compiled import compiled
from slipgym.rendering.camera import FINE, Camera
from slipgym.rendering.look import Contact, Pose, View
from slipgym.rendering.poses import above, name_gravity, push
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


@compiled
def fill(corners, colours, image, nearness):
    """Draw triangles in their order; triangles that face away are left out.

    Args:
        corners: (n, 3, 3): x to the right and y down [samples], nearness 1/depth [1/m]; a
            corner behind the camera has nearness <= 0 and hides its triangle.
        colours: (n, 4): red, green and blue in 0 to 255, opacity in 0 to 1.
        image: (height, width, 3) uint8, blended into.
        nearness: (height, width): nearness of the triangles drawn so far; opaque triangles update it.
    """
    height, width = nearness.shape
    for i in range(corners.shape[0]):
        (ax, ay, an), (bx, by, bn), (cx, cy, cn) = corners[i]
        area = (cx - ax) * (by - ay) - (bx - ax) * (cy - ay)
        if area <= 0.0 or min(an, bn, cn) <= 0.0:
            continue
        red, green, blue, opacity = colours[i]
        top, bottom = max(0.0, min(ay, by, cy)), min(height - 1.0, max(ay, by, cy))
        for row in range(int(top), int(bottom) + 1):
            y = row + 0.5
            left, right = max(0.0, min(ax, bx, cx)), min(width - 0.5, max(ax, bx, cx))
            near, slope = 0.0, 0.0  # nearness in this row: near + slope x
            for px, py, qx, qy, n in ((bx, by, cx, cy, an), (cx, cy, ax, ay, bn), (ax, ay, bx, by, cn)):
                # weight of the corner across the edge p q: start + rise x
                rise = (qy - py) / area
                start = ((qx - px) * (py - y) - (qy - py) * px) / area
                near, slope = near + n * start, slope + n * rise
                if rise > 0.0:
                    left = max(left, -start / rise)
                elif rise < 0.0:
                    right = min(right, -start / rise)
                elif start < 0.0:
                    right = -1.0
            for column in range(math.ceil(left - 0.5), math.floor(right - 0.5) + 1):
                here = near + slope * (column + 0.5)
                if here <= nearness[row, column]:
                    continue
                pixel = image[row, column]
                pixel[0] = round(pixel[0] + opacity * (red - pixel[0]))
                pixel[1] = round(pixel[1] + opacity * (green - pixel[1]))
                pixel[2] = round(pixel[2] + opacity * (blue - pixel[2]))
                if opacity >= 1.0:
                    nearness[row, column] = here
