"""Draws poses of the object in the grip as outlines, and the direction of gravity."""

from __future__ import annotations

import numpy as np
from PIL import Image

from slipgym.rendering.camera import FINE, Camera
from slipgym.rendering.marks import Marks, arrow, nothing, outline
from slipgym.rendering.palette import MUTED, Colour
from slipgym.rendering.stage import View
from slipgym.rendering.text import write

Pose = tuple[float, float, float]
"""Slip displacement (x, y, theta) in the pad frame [m, m, rad]."""
AT_THE_GRASP: Pose = (0.0, 0.0, 0.0)

_CORNER, _LENGTH = (22.0, 60.0), 44.0  # upper end of the arrow of gravity, and its length [pixels]


def held_at(view: View, pose: Pose, camera: Camera, colour: Colour) -> Marks:
    """Outline of the object's front at a pose in the grip."""
    return outline(camera, view.place(view.front(pose)), colour, 1.5, 5.0)


def gravity(camera: Camera) -> Marks:
    """An arrow down, at the upper left of the view; nothing in a view without words."""
    return arrow(camera, _path(camera), MUTED, 2.0) if camera.layout.strip else nothing()


def name_gravity(picture: Image.Image, camera: Camera) -> None:
    """Write "g" beside the arrow of gravity into the view."""
    x, y, _ = camera.project(_path(camera).mean(axis=0)).tolist()
    scale = camera.layout.scale
    write(picture, x / FINE + 6 * scale, y / FINE + 4 * scale, "g", MUTED, 13 * scale)


def _path(camera: Camera) -> np.ndarray:
    top = camera.point(*(camera.layout.scale * at for at in _CORNER))
    length = camera.layout.scale * _LENGTH * camera.pixel
    return np.stack([top, top - (0.0, 0.0, length)])
