"""Draws forces and slip: the pads' forces on the object, its slip displacement and the one asked for."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from slipgym.rendering.camera import Camera
from slipgym.rendering.marks import Marks, arc, arrow, stacked
from slipgym.rendering.palette import FRICTION, GRIP, SLIP, TARGET
from slipgym.rendering.poses import AT_THE_GRASP, Pose, gravity, held_at
from slipgym.rendering.stage import View
from slipgym.world.scene import PAD_THICKNESS

FRICTION_LENGTH, GRIP_LENGTH = 0.14, 0.075
"""Length of an arrow for 1 N, in half widths of the view."""
TORQUE_SWEEP = math.radians(1800.0)
"""Angle of the arc for 1 N m [rad]."""
_LONGEST, _WIDEST = 0.9, math.radians(300.0)
_BAR = 0.01  # [m] thickness of a finger behind its pad
_WIDTH = 3.0  # [pixels]


@dataclass(frozen=True)
class Contact:
    """Forces of the pads on the object, in the pad frame."""

    friction: tuple[float, float]
    """Friction of both pads along x and y [N]."""
    torque: float
    """Friction torque of both pads about the grip axis [N m]."""
    grip: tuple[float, float]
    """Normal force of finger 1 and 2 [N]."""


def before(view: View, contact: Contact, camera: Camera) -> Marks:
    """Marks that nearer bodies hide: the normal force of the finger behind the object."""
    return _push(view, contact.grip[0], camera, 1.0, 1.0, cased=False)


def above(view: View, contact: Contact, camera: Camera, target: Pose | None = None) -> Marks:
    """Marks that nothing hides.

    Args:
        view: Poses of object and gripper.
        contact: Forces of the pads on the object.
        camera: The camera.
        target: Slip displacement that the task asks for; None: none is drawn.
    """
    face = -view.box.size[1] / 2
    grasp = np.array([view.box.grasp_offset[0], face, view.box.grasp_offset[1]])
    centre = np.array([0.0, face, 0.0])
    slip = np.stack([view.place(centre), view.carry(grasp)])
    parts = [gravity(camera), held_at(view, AT_THE_GRASP, camera, SLIP)]
    if target is not None:
        parts.append(held_at(view, target, camera, TARGET))
    parts.append(arrow(camera, slip, SLIP, _WIDTH))
    if math.hypot(*contact.friction) > 0.0:
        force = _limited(np.array([contact.friction[0], 0.0, contact.friction[1]]), FRICTION_LENGTH)
        path = view.place(np.stack([centre, centre + camera.span * force]))
        parts.append(arrow(camera, path, FRICTION, _WIDTH))
    sweep = max(-_WIDEST, min(TORQUE_SWEEP * contact.torque, _WIDEST))
    turn = arc(centre, 1.7 * view.pad_radius, math.pi * (view.side > 0.0), sweep)
    parts.append(arrow(camera, view.place(turn), FRICTION, _WIDTH))
    parts.append(_push(view, contact.grip[0], camera, 1.0, 0.3, cased=False))
    parts.append(_push(view, contact.grip[1], camera, -1.0, 1.0, cased=True))
    return stacked(parts)


def _push(view: View, force: float, camera: Camera, side: float, opacity: float, cased: bool) -> Marks:
    """The normal force of the finger on one side of the object, its tip at the finger's back."""
    back = view.box.size[1] / 2 + PAD_THICKNESS + _BAR
    length = camera.span * min(GRIP_LENGTH * force, _LONGEST)
    path = view.place(np.array([(0.0, side * (back + length), 0.0), (0.0, side * back, 0.0)]))
    return arrow(camera, path, GRIP, _WIDTH, opacity, cased)


def _limited(force: np.ndarray, scale: float) -> np.ndarray:
    length = scale * np.linalg.norm(force)
    return force * scale * min(1.0, _LONGEST / length)
