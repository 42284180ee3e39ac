"""Builds the scene: gripper, object, and a grid behind them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from slipgym.rendering import solids
from slipgym.rendering.bodies import draw_body
from slipgym.rendering.materials import Part
from slipgym.world.scene import PAD_THICKNESS, Box

REACH = 0.12
"""Length of a finger [m]."""
SEE_THROUGH = 0.35
"""Opacity of the finger between camera and object."""
_PAD, _FINGER, _PALM = (0.17, 0.19, 0.23), (0.50, 0.55, 0.62), (0.33, 0.37, 0.43)
_INK, _MARK, _GRID = (0.13, 0.12, 0.12), (0.97, 0.97, 0.95), (0.83, 0.85, 0.88)
_LIFT = 2e-4  # [m] of what is printed on a face, so that it is seen


@dataclass(frozen=True)
class View:
    """Poses of object and gripper; world frame, x to the right, z up, finger 2 towards the camera."""

    box: Box
    """The object."""
    material: str
    """Name of the object's material."""
    position: np.ndarray
    """The object's centre of mass (3,) [m]."""
    rotation: np.ndarray
    """Rotation from the object's frame to the world frame, (3, 3)."""
    wrist: tuple[float, float, float]
    """Pad centre (x, z) and pitch [m, m, rad]."""
    pad_radius: float
    """[m]."""
    body: str = "box"
    """What the object is drawn as, see `slipgym.rendering.bodies`."""

    def place(self, points: np.ndarray) -> np.ndarray:
        """Points (..., 3) of the pad frame in the world; y stays."""
        cos, sin = np.cos(self.wrist[2]), np.sin(self.wrist[2])
        turn = np.array([[cos, 0.0, -sin], [0.0, 1.0, 0.0], [sin, 0.0, cos]])
        return points @ turn.T + (self.wrist[0], 0.0, self.wrist[1])

    def carry(self, points: np.ndarray) -> np.ndarray:
        """Points (..., 3) from the object's geometric centre, on its axes, in the world."""
        x, z = self.box.com_offset
        return (points - (x, 0.0, z)) @ self.rotation.T + self.position

    def front(self, pose: tuple[float, float, float]) -> np.ndarray:
        """Corners of the object's front in the pad frame at a slip displacement (x, y, theta), (4, 3) [m]."""
        half, grasp = np.array(self.box.size) / 2, np.array(self.box.grasp_offset)
        corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * half[[0, 2]] - grasp
        cos, sin = np.cos(pose[2]), np.sin(pose[2])
        turned = corners @ np.array([[cos, sin], [-sin, cos]]) + pose[:2]
        return np.column_stack([turned[:, 0], np.full(4, -half[1]), turned[:, 1]])

    @property
    def side(self) -> float:
        """Side from which the gripper reaches in, opposite to the object: -1 the left, 1 the right."""
        return 1.0 if self.box.grasp_offset[0] > 0.0 else -1.0


def assemble(view: View) -> tuple[np.ndarray, np.ndarray]:
    """All triangles (n, 3, 3) in the world [m] and their colours (n, 4), the see-through ones last."""
    body, body_colours = object_triangles(view.box, view.material, view.body)
    palm, finger = gripper_triangles(view.pad_radius, view.side)
    offset = view.box.size[1] / 2 + PAD_THICKNESS / 2
    far = finger[0] + [0.0, offset, 0.0]
    near = mirrored(finger[0], 1) - [0.0, offset, 0.0]
    glass = finger[1] * [1.0, 1.0, 1.0, SEE_THROUGH]
    held = view.place(np.concatenate([palm[0], far, near]))
    corners = np.concatenate([view.carry(body), held])
    return corners, np.concatenate([body_colours, palm[1], finger[1], glass])


def footprint(
    view: View,
    start: tuple[float, float, float],
    target: tuple[float, float, float] | None,
    turns: Sequence[float],
) -> np.ndarray:
    """Points around the object, where it is held and where it is to be, and around the gripper, (n, 3) [m].

    Args:
        view: Present poses, to which the target belongs.
        start: Pad centre (x, z) and pitch at the start of the episode [m, m, rad].
        target: Slip displacement that the task asks for; None: none.
        turns: Angles by which the wrist is going to pitch [rad].
    """
    x, y, theta = target or (0.0, 0.0, 0.0)
    held = view.front((0.0, 0.0, 0.0))
    asked = [view.front((share * x, share * y, share * theta)) for share in (0.5, 1.0)]
    rail = [(view.side * (REACH + 0.018), y, z) for y in (-0.062, 0.062) for z in (-0.016, 0.016)]
    places = [(np.concatenate([held, rail]), start[2] + turn) for turn in (0.0, *turns)]
    places += [(np.concatenate(asked), view.wrist[2] if target else start[2])]
    points = [replace(view, wrist=(*start[:2], pitch)).place(each) for each, pitch in places]
    return np.concatenate([*points, *(each * (1.0, -1.0, 1.0) for each in points)])


def grid(around: tuple[float, float], reach: float) -> tuple[np.ndarray, np.ndarray]:
    """Grid lines every 50 mm on a plane in the background, which make the wrist's motion visible.

    Args:
        around: Point (x, z) in front of its middle [m].
        reach: How far it is seen to each side [m].
    """
    count = min(round(reach / 0.05) + 1, 40)
    y, far, thick = 0.12, 0.05 * count, 5e-4
    x, z = (0.05 * round(at / 0.05) for at in around)
    lines = []
    for k in range(-count, count + 1):
        at = 0.05 * k
        lines.append(solids.patch((x + at - thick, x + at + thick), (z - far, z + far), y))
        lines.append(solids.patch((x - far, x + far), (z + at - thick, z + at + thick), y))
    return _painted([(line, _GRID) for line in lines])


def _painted(parts: list[Part]) -> tuple[np.ndarray, np.ndarray]:
    colours = [np.broadcast_to((*colour, 1.0), (len(part), 4)) for part, colour in parts]
    return np.concatenate([part for part, _ in parts]), np.concatenate(colours)


@lru_cache(maxsize=64)
def object_triangles(box: Box, material: str, body: str = "box") -> tuple[np.ndarray, np.ndarray]:
    """The body, a box with a ruler of 10 mm, and a dot where it was grasped; from its geometric centre.

    Args:
        box: The object.
        material: Name of its material.
        body: What it is drawn as, see `slipgym.rendering.bodies`.

    Returns:
        Triangles (n, 3, 3) [m] and their colours (n, 4).
    """
    half = box.size[0] / 2, box.size[1] / 2, box.size[2] / 2
    face = -half[1] - _LIFT
    parts = draw_body(body, box, material, face)
    face -= _LIFT
    if body == "box":
        parts += _ruler(half[0], half[2], face)
    grasp = np.array([box.grasp_offset[0], 0.0, box.grasp_offset[1]])
    parts.append((solids.disc(0.005, face) + grasp, _MARK))
    parts.append((solids.disc(0.0033, face - _LIFT) + grasp, _INK))
    return _painted(parts)


def _ruler(half: float, height: float, face: float) -> list[Part]:
    """Marks of 10 mm along the edge of a face, longer ones every 50 mm."""
    parts, last = [], int((min(height - 0.005, 0.5)) / 0.01)
    for k in range(-last, last + 1):
        length, thick = (0.011, 4e-4) if k % 5 == 0 else (0.006, 2.5e-4)
        z = 0.01 * k
        parts.append((solids.patch((half - length, half), (z - thick, z + thick), face), _INK))
    return parts


@lru_cache(maxsize=8)
def gripper_triangles(
    pad_radius: float, side: float
) -> tuple[tuple[np.ndarray, ...], tuple[np.ndarray, ...]]:
    """Palm around the wrist's axis, and finger 1 around its pad's middle; it reaches in from that side.

    Args:
        pad_radius: [m].
        side: -1 for the left, 1 for the right.

    Returns:
        Of the palm, then of the finger: triangles (n, 3, 3) [m] and their colours (n, 4).
    """
    pad = solids.cylinder(pad_radius, PAD_THICKNESS)
    bar = solids.box((REACH / 2, 0.005, 0.009), (-REACH / 2 + 0.008, PAD_THICKNESS / 2 + 0.005, 0.0))
    rail = solids.box((0.014, 0.062, 0.016), (-REACH - 0.004, 0.0, 0.0))
    flange = solids.box((0.03, 0.03, 0.024), (-REACH - 0.048, 0.0, 0.0))
    parts = _painted([(rail, _PALM), (flange, _FINGER)]), _painted([(pad, _PAD), (bar, _FINGER)])
    if side < 0.0:
        return parts
    (palm, palm_colours), (finger, finger_colours) = parts
    return (mirrored(palm, 0), palm_colours), (mirrored(finger, 0), finger_colours)


def mirrored(corners: np.ndarray, axis: int) -> np.ndarray:
    """Mirror triangles (n, 3, 3) along an axis, and turn them so that they still face outside."""
    flip = np.ones(3)
    flip[axis] = -1.0
    return (corners * flip)[:, ::-1]
