"""Draws the marks over the scene: the pads' forces, slip, poses of the object in the grip, gravity."""

from __future__ import annotations

import math

import numpy as np
from PIL import Image

from slipgym.rendering.camera import FINE, Camera
from slipgym.rendering.look import AT_THE_GRASP, Contact, Pose, View
from slipgym.rendering.marks import Marks, arc, arrow, nothing, outline, stacked
from slipgym.rendering.palette import FRICTION, GRIP, MUTED, SLIP, TARGET, Colour
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
