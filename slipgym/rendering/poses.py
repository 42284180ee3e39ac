"""Draws flat marks over the scene: the pads' forces, slip, poses of the object in the grip, gravity."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from PIL import Image

from slipgym.rendering.camera import FINE, Camera
from slipgym.rendering.look import AT_THE_GRASP, Contact, Pose, View
from slipgym.rendering.palette import FRICTION, GRIP, MUTED, PAPER, SLIP, TARGET, Colour
from slipgym.rendering.text import write
from slipgym.world.scene import PAD_THICKNESS

FRICTION_LENGTH, GRIP_LENGTH = 0.14, 0.075
"""Length of an arrow for 1 N, in half widths of the view."""
TORQUE_SWEEP = math.radians(1800.0)
"""Angle of the arc for 1 N m [rad]."""
_LONGEST, _WIDEST = 0.9, math.radians(300.0)
_BAR = 0.01  # [m] thickness of a finger behind its pad
_WIDTH = 3.0  # [pixels]
_CORNER, _LENGTH = (22.0, 60.0), 44.0  # upper end of the arrow of gravity, and its length [pixels]
_CASING = 1.6  # white around a mark [pixels]
_HEAD = 4.2  # length of an arrow's head, in widths of its shaft
_SPREAD = 1.6  # half its breadth
_SHORT = 6.5  # least length of an arrow of full width, in widths
_LEAST = 2.0  # width of an arrow that is still drawn [samples]
_STEP = math.radians(6.0)

Marks = tuple[np.ndarray, np.ndarray]
"""Triangles (n, 3, 3) as `scene.fill` takes them, and their colours (n, 4)."""


def above(view: View, contact: Contact, camera: Camera, target: Pose | None = None) -> Marks:
    """Marks that nothing hides, among them the slip displacement that the task asks for, if there is one."""
    face = -view.box.size[1] / 2
    grasp = np.array([view.box.grasp_offset[0], face, view.box.grasp_offset[1]])
    centre = np.array([0.0, face, 0.0])
    slip = np.stack([view.place(centre), view.carry(grasp)])
    parts = [arrow(camera, _down(camera), MUTED, 2.0) if camera.layout.strip else nothing()]
    parts.append(held_at(view, AT_THE_GRASP, camera, SLIP))
    if target is not None:
        parts.append(held_at(view, target, camera, TARGET))
    parts.append(arrow(camera, slip, SLIP, _WIDTH))
    if math.hypot(*contact.friction) > 0.0:
        force = FRICTION_LENGTH * np.array([contact.friction[0], 0.0, contact.friction[1]])
        force *= min(1.0, _LONGEST / np.linalg.norm(force))
        path = view.place(np.stack([centre, centre + camera.span * force]))
        parts.append(arrow(camera, path, FRICTION, _WIDTH))
    sweep = max(-_WIDEST, min(TORQUE_SWEEP * contact.torque, _WIDEST))
    turn = arc(centre, 1.7 * view.pad_radius, math.pi * (view.side > 0.0), sweep)
    parts.append(arrow(camera, view.place(turn), FRICTION, _WIDTH))
    parts.append(push(view, contact, 0, camera, 0.3))
    parts.append(push(view, contact, 1, camera, cased=True))
    return stacked(parts)


def push(
    view: View, contact: Contact, finger: int, camera: Camera, opacity: float = 1.0, cased: bool = False
) -> Marks:
    """The normal force of finger 0, behind the object, or 1; its tip is at the finger's back."""
    side = 1.0 - 2.0 * finger
    back = view.box.size[1] / 2 + PAD_THICKNESS + _BAR
    length = camera.span * min(GRIP_LENGTH * contact.grip[finger], _LONGEST)
    path = view.place(np.array([(0.0, side * (back + length), 0.0), (0.0, side * back, 0.0)]))
    return arrow(camera, path, GRIP, _WIDTH, opacity, cased)


def held_at(view: View, pose: Pose, camera: Camera, colour: Colour) -> Marks:
    """Outline of the object's front at a pose in the grip."""
    return outline(camera, view.place(view.front(pose)), colour, 1.5, 5.0)


def name_gravity(picture: Image.Image, camera: Camera) -> None:
    """Write "g" beside the arrow of gravity into the view."""
    x, y, _ = camera.project(_down(camera).mean(axis=0)).tolist()
    scale = camera.layout.scale
    write(picture, x / FINE + 6 * scale, y / FINE + 4 * scale, "g", MUTED, 13 * scale)


def _down(camera: Camera) -> np.ndarray:
    """The arrow of gravity at the upper left of the view, (2, 3) [m]."""
    top = camera.point(*(camera.layout.scale * at for at in _CORNER))
    length = camera.layout.scale * _LENGTH * camera.pixel
    return np.stack([top, top - (0.0, 0.0, length)])


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
