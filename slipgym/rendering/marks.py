"""Builds flat marks over the scene from triangles: lines, arrows, arcs."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from slipgym.rendering.camera import FINE, Camera
from slipgym.rendering.palette import PAPER, Colour

_CASING = 1.6  # white around a mark [pixels]
_HEAD = 4.2  # length of an arrow's head, in widths of its shaft
_SPREAD = 1.6  # half its breadth
_SHORT = 6.5  # least length of an arrow of full width, in widths
_LEAST = 2.0  # width of an arrow that is still drawn [samples]
_STEP = math.radians(6.0)

Marks = tuple[np.ndarray, np.ndarray]
"""Triangles (n, 3, 3) as `raster.fill` takes them, and their colours (n, 4)."""


def arrow(
    camera: Camera, path: np.ndarray, colour: Colour, width: float, opacity: float = 1.0, cased: bool = True
) -> Marks:
    """An arrow along world points (n, 3) [m]; thinner if it is short, nothing if it has no length.

    The width of its shaft is in pixels of a picture of the usual size. A cased one has a white edge against
    the background; for marks that are `stacked`.
    """
    seen = camera.project(path)
    left = np.cumsum(np.linalg.norm(np.diff(seen[::-1, :2], axis=0), axis=1))
    fine = FINE * camera.layout.scale
    size = min(fine * width, left[-1] / _SHORT)
    if size < _LEAST:
        return nothing()
    keep = np.flatnonzero(left[::-1] > _HEAD * size)[-1] + 1  # the points before the head
    tip, last = seen[-1], seen[keep - 1]
    neck = last + (tip - last) * (1.0 - _HEAD * size / np.linalg.norm(tip[:2] - last[:2]))
    shaft = np.vstack([seen[:keep], neck])
    parts = []
    for extra, paint in ((_CASING * fine, PAPER), (0.0, colour)) if cased else ((0.0, colour),):
        shape = _ribbon(shaft, size / 2 + extra), _head(neck, tip, _SPREAD * size, extra)
        parts.append(_painted(np.concatenate(shape), paint, opacity))
    return _joined(parts)


def outline(camera: Camera, path: np.ndarray, colour: Colour, width: float, dash: float) -> Marks:
    """A dashed closed line through world points (n, 3) [m]; width and dash as in `arrow`."""
    seen, fine = camera.project(np.vstack([path, path[:1]])), FINE * camera.layout.scale
    ends = []
    for start, end in pairwise(seen):
        count = 2 * max(1, round(np.linalg.norm(end[:2] - start[:2]) / (2 * fine * dash))) - 1
        at = start + np.linspace(0.0, 1.0, count + 1)[:, None] * (end - start)
        ends.append(at.reshape(-1, 2, 3))
    both = np.concatenate(ends)
    side = _normals(both[:, 1] - both[:, 0]) * fine * width / 2
    return _painted(_band(both[:, 0], both[:, 1], side, side), colour, 1.0)


def arc(centre: np.ndarray, radius: float, start: float, sweep: float) -> np.ndarray:
    """Points on a circle in the plane of x and z, counterclockwise for sweep > 0, (n, 3) [m]."""
    angles = start + np.linspace(0.0, sweep, max(3, math.ceil(abs(sweep) / _STEP)))
    return centre + radius * np.column_stack([np.cos(angles), np.zeros_like(angles), np.sin(angles)])


def stacked(parts: list[Marks]) -> Marks:
    """Combine marks into one; each covers those before it, whatever their depth."""
    corners, colours = _joined(parts)
    corners[..., 2] = np.arange(1.0, len(corners) + 1.0)[:, None]
    return corners, colours


def nothing() -> Marks:
    """No mark."""
    return np.zeros((0, 3, 3)), np.zeros((0, 4))


def _ribbon(points: np.ndarray, half: float) -> np.ndarray:
    """A band along screen points (n, 3)."""
    steps = np.diff(points, axis=0)
    normals = half * _normals(np.concatenate([steps[:1], steps[:-1] + steps[1:], steps[-1:]]))
    return _band(points[:-1], points[1:], normals[:-1], normals[1:])


def _normals(along: np.ndarray) -> np.ndarray:
    """Unit vectors on the screen across directions (n, 3), (n, 3)."""
    side = np.column_stack([-along[:, 1], along[:, 0], np.zeros(len(along))])
    return side / np.maximum(np.linalg.norm(side, axis=1, keepdims=True), 1e-9)


def _band(start: np.ndarray, end: np.ndarray, side: np.ndarray, last: np.ndarray) -> np.ndarray:
    """Two triangles for each piece from start to end, with what is beside them at each end, all (n, 3)."""
    one, other, far, corner = start + side, start - side, end - last, end + last
    return np.concatenate([np.stack([one, corner, far], axis=1), np.stack([one, far, other], axis=1)])


def _head(neck: np.ndarray, tip: np.ndarray, half: float, extra: float) -> np.ndarray:
    """The triangle at an arrow's tip, `extra` larger on each side."""
    length = float(np.linalg.norm((tip - neck)[:2]))
    x, y = (tip - neck)[:2] / length
    flank = math.hypot(length, half)
    slope = flank / half  # how far the tip moves when the flanks move by one
    side, forward = np.array([-y, x, 0.0]), np.array([x, y, 0.0])
    broad = half + extra * (half + flank) / length
    base = neck - extra * forward
    return np.stack([base + broad * side, tip + extra * slope * forward, base - broad * side])[None]


def _painted(corners: np.ndarray, colour: Colour, opacity: float) -> Marks:
    return corners, np.broadcast_to((*map(float, colour), opacity), (len(corners), 4))


def _joined(parts: list[Marks]) -> Marks:
    return np.concatenate([part[0] for part in parts]), np.concatenate([part[1] for part in parts])
