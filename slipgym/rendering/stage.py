"""Builds the scene: gripper, object, and a grid behind them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from slipgym.rendering import bodies
from slipgym.rendering.look import AT_THE_GRASP, Pose, View
from slipgym.world.scene import PAD_THICKNESS, Box

REACH = 0.12
"""Length of a finger [m]."""
SEE_THROUGH = 0.35
"""Opacity of the finger between camera and object."""
_PAD, _FINGER, _PALM = (0.17, 0.19, 0.23), (0.50, 0.55, 0.62), (0.33, 0.37, 0.43)
_INK, _MARK, _GRID = (0.13, 0.12, 0.12), (0.97, 0.97, 0.95), (0.83, 0.85, 0.88)
_LIFT = 2e-4  # [m] of what is printed on a face, so that it is seen


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


def footprint(view: View, start: Pose, target: Pose | None, turns: Sequence[float]) -> np.ndarray:
    """Points around the object, where it is held and where it is to be, and around the gripper, (n, 3) [m].

    The start is the wrist's, (x, z) and pitch; the target belongs to the present poses; the wrist is going to
    pitch by the turns [rad].
    """
    asked = [
        view.front((share * x, share * y, share * theta))
        for share in (0.5, 1.0)
        for x, y, theta in [target or AT_THE_GRASP]
    ]
    rail = [(view.side * (REACH + 0.018), y, z) for y in (-0.062, 0.062) for z in (-0.016, 0.016)]
    held = np.concatenate([view.front(AT_THE_GRASP), rail])
    places = [(held, start[2] + turn) for turn in (0.0, *turns)]
    places += [(np.concatenate(asked), view.wrist[2] if target else start[2])]
    points = [replace(view, wrist=(*start[:2], pitch)).place(each) for each, pitch in places]
    return np.concatenate([*points, *(each * (1.0, -1.0, 1.0) for each in points)])


def grid(around: tuple[float, float], reach: float) -> tuple[np.ndarray, np.ndarray]:
    """Grid lines every 50 mm around a point (x, z) of the background, seen that far to each side [m]."""
    count = min(round(reach / 0.05) + 1, 40)
    y, far, thick = 0.12, 0.05 * count, 5e-4
    x, z = (0.05 * round(at / 0.05) for at in around)
    parts: list[bodies.Part] = []
    for at in (0.05 * k for k in range(-count, count + 1)):
        parts.append((bodies.patch((x + at - thick, x + at + thick), (z - far, z + far), y), _GRID))
        parts.append((bodies.patch((x - far, x + far), (z + at - thick, z + at + thick), y), _GRID))
    return _painted(parts)


def _painted(parts: list[bodies.Part]) -> tuple[np.ndarray, np.ndarray]:
    colours = [np.broadcast_to((*colour, 1.0), (len(part), 4)) for part, colour in parts]
    return np.concatenate([part for part, _ in parts]), np.concatenate(colours)


@lru_cache(maxsize=64)
def object_triangles(box: Box, material: str, body: str = "box") -> tuple[np.ndarray, np.ndarray]:
    """The body, a box with a ruler of 10 mm, and a dot where it was grasped; from its geometric centre."""
    half, depth, height = (length / 2 for length in box.size)
    parts = bodies.draw_body(body, box, material, -depth - _LIFT)
    face = -depth - _LIFT - _LIFT
    last = int(min(height - 0.005, 0.5) / 0.01) if body == "box" else -1
    for k in range(-last, last + 1):
        length, thick = (0.011, 4e-4) if k % 5 == 0 else (0.006, 2.5e-4)
        z = 0.01 * k
        parts.append((bodies.patch((half - length, half), (z - thick, z + thick), face), _INK))
    grasp = np.array([box.grasp_offset[0], 0.0, box.grasp_offset[1]])
    parts.append((bodies.disc(0.005, face) + grasp, _MARK))
    parts.append((bodies.disc(0.0033, face - _LIFT) + grasp, _INK))
    return _painted(parts)


@lru_cache(maxsize=8)
def gripper_triangles(pad_radius: float, side: float) -> tuple[tuple[np.ndarray, ...], ...]:
    """Palm around the wrist's axis, finger 1 around its pad: triangles (n, 3, 3) [m] and colours (n, 4).

    The gripper reaches in from the left, side -1, or the right, 1.
    """
    pad = bodies.cylinder(pad_radius, PAD_THICKNESS)
    bar = bodies.box((REACH / 2, 0.005, 0.009), (-REACH / 2 + 0.008, PAD_THICKNESS / 2 + 0.005, 0.0))
    rail = bodies.box((0.014, 0.062, 0.016), (-REACH - 0.004, 0.0, 0.0))
    flange = bodies.box((0.03, 0.03, 0.024), (-REACH - 0.048, 0.0, 0.0))
    parts = _painted([(rail, _PALM), (flange, _FINGER)]), _painted([(pad, _PAD), (bar, _FINGER)])
    return parts if side < 0.0 else tuple((mirrored(part, 0), colours) for part, colours in parts)


def mirrored(corners: np.ndarray, axis: int) -> np.ndarray:
    """Mirror triangles (n, 3, 3) along an axis, and turn them so that they still face outside."""
    return (corners * (1.0 - 2.0 * np.eye(3)[axis]))[:, ::-1]
