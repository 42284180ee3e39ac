"""Builds the scene's shapes from triangles, counterclockwise seen from outside."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Triangles = NDArray[np.float64]
"""(n, 3, 3): triangle, corner, coordinate (x, y, z) [m]."""

_SIDES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))


def quad(corners: np.ndarray) -> Triangles:
    """A flat four-sided face, corners (4, 3)."""
    return np.stack([corners[[0, 1, 2]], corners[[0, 2, 3]]])


def box(half: tuple[float, float, float], centre: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Triangles:
    """An upright box by its half extents."""
    x, y, z = half
    return frustum(np.array([-z, z]), np.array([x, x]), y) + np.asarray(centre)


def frustum(along: np.ndarray, across: np.ndarray, thick: float) -> Triangles:
    """A solid along z, symmetric in x: two ends, lower first, and half widths there (2,), half depth [m]."""
    ends = list(zip(across, along, strict=True))
    corners = np.array([(sign * x, y, z) for sign in (-1, 1) for y in (-thick, thick) for x, z in ends])
    return np.concatenate([quad(corners[list(side)]) for side in _SIDES])


def disc(radius: float, y: float, sides: int = 24) -> Triangles:
    """A disc in the plane of that y, seen from -y."""
    angles = 2.0 * math.pi * np.arange(sides) / sides
    rim = np.column_stack([radius * np.cos(angles), np.full(sides, y), radius * np.sin(angles)])
    centre = np.broadcast_to([0.0, y, 0.0], rim.shape)
    return np.stack([centre, rim, np.roll(rim, -1, axis=0)], axis=1)


def cylinder(radius: float, length: float, sides: int = 24) -> Triangles:
    """A cylinder around the y axis, its middle at the origin."""
    front = disc(radius, -length / 2, sides)
    back = disc(radius, length / 2, sides)[:, ::-1]
    here, there = front[:, 1], front[:, 2]
    along = np.array([0.0, length, 0.0])
    left = np.stack([there, here, here + along], axis=1)
    right = np.stack([there, here + along, there + along], axis=1)
    return np.concatenate([front, back, left, right])


def patch(x: tuple[float, float], z: tuple[float, float], y: float) -> Triangles:
    """A rectangle in the plane of that y, seen from -y."""
    return quad(np.array([(x[0], y, z[0]), (x[1], y, z[0]), (x[1], y, z[1]), (x[0], y, z[1])]))
