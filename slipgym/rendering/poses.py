"""Draws poses of the object in the grip as outlines, and the direction of gravity."""

from __future__ import annotations

import numpy as np
from PIL import Image

from slipgym.rendering.camera import FINE, Camera
from slipgym.rendering.marks import Marks, arrow, outline
from slipgym.rendering.palette import MUTED, Colour
from slipgym.rendering.stage import View
from slipgym.rendering.text import write

Pose = tuple[float, float, float]
"""Slip displacement (x, y, theta) in the pad frame [m, m, rad]."""
AT_THE_GRASP: Pose = (0.0, 0.0, 0.0)

_CORNER, _LENGTH = (0.86, 0.62), 0.2
"""Upper end of the arrow of gravity from the middle of the view, and its length [half widths of the view]."""


def held_at(view: View, pose: Pose, camera: Camera, colour: Colour) -> Marks:
    """Outline of the object's front at a pose in the grip."""
    return outline(camera, view.place(view.front(pose)), colour, 1.5, 5.0)


def gravity(camera: Camera) -> Marks:
    """An arrow down, at the right edge of the view."""
    return arrow(camera, _path(camera), MUTED, 2.0)


def name_gravity(picture: Image.Image, camera: Camera) -> None:
    """Write "g" beside the arrow of gravity into the view."""
    x, y, _ = camera.project(_path(camera).mean(axis=0)).tolist()
    write(picture, x / FINE + 6, y / FINE + 4, "g", MUTED, 13)


def _path(camera: Camera) -> np.ndarray:
    x, z = camera.target
    across, up = _CORNER
    top = np.array([x + across * camera.span, 0.0, z + up * camera.span])
    return np.stack([top, top - (0.0, 0.0, _LENGTH * camera.span)])
