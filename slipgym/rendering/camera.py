"""Lays a picture out, and projects world points into its view by a camera roughly along the grip axis."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

PICTURE_WIDTH, PICTURE_HEIGHT = 720, 480
"""Size of a picture, unless another one is asked for [pixels]."""
STRIP = 272
"""Width of the plots in it [pixels]."""
_READABLE = 2.0 / 3.0  # least scale with words
_VISIBLE = 0.4  # least scale of marks
FINE = 2
"""Samples per pixel in each direction, see `scene.fill`."""
_WORDS = 54, 76  # heights of the words above and below the view [pixels, in a picture of the usual size]
_MARGIN = 0.08  # of the view's width and height
_STILL = 0.1  # how far the gripper moves in the view before the camera follows it [half widths of the view]
_YAW, _PITCH = math.radians(28.0), math.radians(16.0)
_FOCAL = 4.5  # in half widths of the view
_NEAREST = 0.05  # [m]

_RIGHT = np.array([math.cos(_YAW), math.sin(_YAW), 0.0])
_FORWARD = np.array(
    [-math.sin(_YAW) * math.cos(_PITCH), math.cos(_YAW) * math.cos(_PITCH), -math.sin(_PITCH)]
)
_AXES = np.column_stack([_RIGHT, np.cross(_RIGHT, _FORWARD), _FORWARD])


@dataclass(frozen=True)
class Layout:
    """Sizes of a picture and its parts."""

    width: int
    """Of the view [pixels]."""
    height: int
    """Of view and picture [pixels]."""
    scale: float = 1.0
    """Size of words and marks over that in a picture of `PICTURE_WIDTH` by `PICTURE_HEIGHT`."""
    strip: int = STRIP
    """Width of the plots beside the view [pixels]; 0: no plots and no words."""


def arrange(mode: str, size: Sequence[int] | None) -> Layout:
    """Lay a picture of a render mode out; its size is width and height [pixels], None for the mode's own.

    The view stands alone in a "depth_array", and where words would be too small to read.
    """
    width, height = size or (PICTURE_WIDTH - STRIP * (mode == "depth_array"), PICTURE_HEIGHT)
    scale = min(width / PICTURE_WIDTH, height / PICTURE_HEIGHT)
    if mode == "depth_array" or scale < _READABLE:
        return Layout(width, height, max(scale, _VISIBLE), strip=0)
    strip = round(scale * STRIP)
    return Layout(width - strip, height, scale, strip)


DEFAULT = arrange("rgb_array", None)
WIDTH, HEIGHT = DEFAULT.width, DEFAULT.height
"""Size of the view in a picture of the usual size [pixels]."""


@dataclass(frozen=True)
class Camera:
    """Position and orientation of the camera, and the picture that it takes."""

    target: tuple[float, float]
    """Point (x, z) in the middle of the view [m]."""
    span: float
    """Half of what is seen at the target, of the shorter of width and height [m]."""
    layout: Layout = DEFAULT
    """Sizes of the picture."""

    def project(self, points: np.ndarray) -> np.ndarray:
        """World points (..., 3) [m] to x and y [samples] and nearness 1/depth [1/m]; see `scene.fill`."""
        seen = (points - (self.target[0], 0.0, self.target[1])) @ _AXES
        depth = seen[..., 2] + _FOCAL * self.span
        near = np.where(depth > _NEAREST, 1.0 / np.maximum(depth, _NEAREST), 0.0)
        width, height = FINE * self.layout.width, FINE * self.layout.height
        scale = min(width, height) / 2 * _FOCAL * near
        return np.stack([width / 2 + scale * seen[..., 0], height / 2 - scale * seen[..., 1], near], axis=-1)

    @property
    def pixel(self) -> float:
        """Size of a pixel at the target [m]."""
        return self.span / (min(self.layout.width, self.layout.height) / 2)

    def point(self, x: float, y: float) -> np.ndarray:
        """World point (3,) [m] that is seen at x and y [pixels], as far from the camera as the target."""
        right, down = x - self.layout.width / 2, y - self.layout.height / 2
        middle = np.array([self.target[0], 0.0, self.target[1]])
        return middle + _AXES @ (self.pixel * right, -self.pixel * down, 0)

    def follow(self, way: np.ndarray) -> Camera:
        """Camera after the gripper has moved by (x, z) [m]; small moves are seen, and it stays."""
        x, z = (way - np.clip(way, -_STILL * self.span, _STILL * self.span)).tolist()
        return replace(self, target=(self.target[0] + x, self.target[1] + z)) if x or z else self


def framing(points: np.ndarray, layout: Layout = DEFAULT) -> Camera:
    """Make a camera that shows points (n, 3) [m] as large as possible where the view is free of words."""
    above, below = (layout.scale * size if layout.strip else 0.0 for size in _WORDS)
    middle = np.array([layout.width, layout.height + above - below]) / 2
    free = np.array([layout.width, layout.height - above - below]) * (1.0 - 2.0 * _MARGIN)
    low, high = points.min(axis=0), points.max(axis=0)
    camera = Camera(
        (float(low[0] + high[0]) / 2, float(low[2] + high[2]) / 2), float(max(high - low)), layout
    )
    for _ in range(10):  # perspective: each step corrects the one before
        seen = camera.project(points)[:, :2] / FINE
        low, high = seen.min(axis=0), seen.max(axis=0)
        x, down = (middle - (low + high) / 2) * camera.pixel
        target = float(camera.target[0] - x / _RIGHT[0]), float(camera.target[1] + down / math.cos(_PITCH))
        camera = Camera(target, float(camera.span * max((high - low) / free)), layout)
    return camera
