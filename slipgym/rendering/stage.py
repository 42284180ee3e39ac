"""What is to be seen: gripper and object, and a grid behind them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from slipgym.rendering import solids
from slipgym.world.scene import PAD_THICKNESS, Box

COLOURS = {
    "wood": (0.76, 0.56, 0.35),
    "case": (0.36, 0.52, 0.66),
    "plastic": (0.83, 0.40, 0.33),
    "cardboard": (0.82, 0.71, 0.51),
}
"""Colour of the object by its material's name."""
_OTHER = (0.52, 0.63, 0.50)
_PAD, _FINGER, _PALM = (0.17, 0.19, 0.23), (0.50, 0.55, 0.62), (0.33, 0.37, 0.43)
_INK, _MARK, _GRID = (0.13, 0.12, 0.12), (0.97, 0.97, 0.95), (0.83, 0.85, 0.88)
_SEE_THROUGH = 0.4  # opacity of the finger between camera and object
_LIFT = 2e-4  # [m] of what is printed on a face, so that it is seen


@dataclass(frozen=True)
class View:
    """Where everything is; world frame, x to the right, z up, finger 2 towards the camera."""

    box: Box
    """The object."""
    material: str
    """Its material's name."""
    position: tuple[float, float, float]
    """Its centre of mass [m]."""
    rotation: np.ndarray
    """From its frame to the world's, (3, 3)."""
    wrist: tuple[float, float, float]
    """Pad centre (x, z) and pitch [m, m, rad]."""
    closing: tuple[float, float]
    """Travel of finger 1 and 2 towards the object since they touched it [m]."""
    pad_radius: float
    """[m]."""


def assemble(view: View) -> tuple[np.ndarray, np.ndarray]:
    """All triangles (n, 3, 3) in the world [m] and their colours (n, 4), the see-through ones last."""
    body, body_colours = _object(view.box, view.material)
    body = body @ view.rotation.T + view.position
    palm, finger = _gripper(view.pad_radius)
    offset = view.box.size[1] / 2 + PAD_THICKNESS / 2
    cos, sin = math.cos(view.wrist[2]), math.sin(view.wrist[2])
    turn = np.array([[cos, 0.0, -sin], [0.0, 1.0, 0.0], [sin, 0.0, cos]])
    wrist = np.array([view.wrist[0], 0.0, view.wrist[1]])
    far = finger[0] + [0.0, offset - view.closing[0], 0.0]
    near = finger[0] * [1.0, -1.0, 1.0] - [0.0, offset - view.closing[1], 0.0]
    near = near[:, ::-1]  # mirroring turned them inside out
    glass = finger[1] * [1.0, 1.0, 1.0, _SEE_THROUGH]
    held = np.concatenate([palm[0], far, near]) @ turn.T + wrist
    corners = np.concatenate([body, held])
    return corners, np.concatenate([body_colours, palm[1], finger[1], glass])


def _painted(parts: list[tuple[solids.Triangles, tuple[float, float, float]]]) -> tuple[np.ndarray, ...]:
    colours = [np.broadcast_to((*colour, 1.0), (len(part), 4)) for part, colour in parts]
    return np.concatenate([part for part, _ in parts]), np.concatenate(colours)


@lru_cache(maxsize=64)
def _object(box: Box, material: str) -> tuple[np.ndarray, ...]:
    """The box with a ruler of 10 mm and a dot where it was grasped, in its own frame."""
    half = box.size[0] / 2, box.size[1] / 2, box.size[2] / 2
    face = -half[1] - _LIFT
    parts = [(solids.box(half), COLOURS.get(material, _OTHER))]
    height = min(half[2] - 0.005, 0.5)
    for k in range(-int(height / 0.01), int(height / 0.01) + 1):
        length, thick = (0.011, 4e-4) if k % 5 == 0 else (0.006, 2.5e-4)
        z = 0.01 * k
        parts.append((solids.patch((half[0] - length, half[0]), (z - thick, z + thick), face), _INK))
    grasp = np.array([box.grasp_offset[0], 0.0, box.grasp_offset[1]])
    parts.append((solids.disc(0.006, face) + grasp, _MARK))
    parts.append((solids.disc(0.004, face - _LIFT) + grasp, _INK))
    corners, colours = _painted(parts)
    return corners - [box.com_offset[0], 0.0, box.com_offset[1]], colours


@lru_cache(maxsize=8)
def _gripper(pad_radius: float) -> tuple[tuple[np.ndarray, ...], tuple[np.ndarray, ...]]:
    """Palm around the wrist's axis, and finger 1 around its pad's middle; it reaches in from the left."""
    pad = solids.cylinder(pad_radius, PAD_THICKNESS)
    reach = 0.12
    bar = solids.box((reach / 2, 0.005, 0.009), (-reach / 2 + 0.008, PAD_THICKNESS / 2 + 0.005, 0.0))
    rail = solids.box((0.014, 0.062, 0.016), (-reach - 0.004, 0.0, 0.0))
    flange = solids.box((0.03, 0.03, 0.024), (-reach - 0.048, 0.0, 0.0))
    return _painted([(rail, _PALM), (flange, _FINGER)]), _painted([(pad, _PAD), (bar, _FINGER)])


def grid() -> tuple[np.ndarray, ...]:
    """Lines every 50 mm on a plane behind everything: they show how the wrist moves."""
    y, far, thick = 0.12, 0.45, 5e-4
    lines = []
    for k in range(-9, 10):
        at = 0.05 * k
        lines.append(solids.patch((at - thick, at + thick), (-far, far), y))
        lines.append(solids.patch((-far, far), (at - thick, at + thick), y))
    return _painted([(line, _GRID) for line in lines])
