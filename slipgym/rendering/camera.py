"""Projects world points into the view of a camera that looks roughly along the grip axis."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

WIDTH, HEIGHT = 448, 480
"""Size of the view [pixels]."""
_CLEAR = 370
"""Height of the view between the words [pixels]."""
FINE = 2
"""Samples per pixel in each direction, see `raster.shrink`."""
_YAW, _PITCH = math.radians(28.0), math.radians(16.0)
_FOCAL = 4.5  # in half widths of the view
_NEAREST = 0.05  # [m]

_RIGHT = np.array([math.cos(_YAW), math.sin(_YAW), 0.0])
_FORWARD = np.array(
    [-math.sin(_YAW) * math.cos(_PITCH), math.cos(_YAW) * math.cos(_PITCH), -math.sin(_PITCH)]
)
_AXES = np.column_stack([_RIGHT, np.cross(_RIGHT, _FORWARD), _FORWARD])


@dataclass(frozen=True)
class Camera:
    """Position and orientation of the camera, constant in an episode."""

    target: tuple[float, float]
    """Point (x, z) in the middle of the view [m]."""
    span: float
    """Half the width that is seen at the target [m]."""

    def project(self, points: np.ndarray) -> np.ndarray:
        """World points (..., 3) [m] to x and y [samples] and nearness 1/depth [1/m]; see `raster.fill`."""
        seen = (points - (self.target[0], 0.0, self.target[1])) @ _AXES
        depth = seen[..., 2] + _FOCAL * self.span
        near = np.where(depth > _NEAREST, 1.0 / np.maximum(depth, _NEAREST), 0.0)
        scale = FINE * WIDTH / 2 * _FOCAL * near
        x = FINE * WIDTH / 2 + scale * seen[..., 0]
        y = FINE * HEIGHT / 2 - scale * seen[..., 1]
        return np.stack([x, y, near], axis=-1)


def framing(points: np.ndarray, margin: float = 1.5) -> Camera:
    """Make a camera that has all points in view.

    Args:
        points: (n, 3) [m].
        margin: Half the visible width over the half width of the points.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    span = margin / 2 * max(high[0] - low[0], (high[2] - low[2]) * WIDTH / _CLEAR)
    return Camera((float(low[0] + high[0]) / 2, float(low[2] + high[2]) / 2), float(span))
