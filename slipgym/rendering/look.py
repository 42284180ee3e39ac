"""Reads what a picture shows of a simulation, without changing it: poses, forces and words."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from slipgym.world.scene import Box

if TYPE_CHECKING:
    from slipgym.envs.simulation import Simulation

Pose = tuple[float, float, float]
"""Slip displacement (x, y, theta) in the pad frame [m, m, rad]."""
AT_THE_GRASP: Pose = (0.0, 0.0, 0.0)
_SLIPPING = 5e-4, 0.05  # slip speed [m/s] and rate [rad/s] from which the object counts as slipping


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
        return points @ turning(self.wrist[2]).T + (self.wrist[0], 0.0, self.wrist[1])

    def carry(self, points: np.ndarray) -> np.ndarray:
        """Points (..., 3) from the object's geometric centre, on its axes, in the world."""
        x, z = self.box.com_offset
        return (points - (x, 0.0, z)) @ self.rotation.T + self.position

    def front(self, pose: Pose) -> np.ndarray:
        """Corners of the object's front in the pad frame at a slip displacement, (4, 3) [m]."""
        half, grasp = np.array(self.box.size) / 2, np.array(self.box.grasp_offset)
        corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * half[[0, 2]] - grasp
        cos, sin = np.cos(pose[2]), np.sin(pose[2])
        turned = corners @ np.array([[cos, sin], [-sin, cos]]) + pose[:2]
        return np.column_stack([turned[:, 0], np.full(4, -half[1]), turned[:, 1]])

    @property
    def side(self) -> float:
        """Side from which the gripper reaches in, opposite to the object: -1 the left, 1 the right."""
        return 1.0 if self.box.grasp_offset[0] > 0.0 else -1.0


class Contact(NamedTuple):
    """Forces of the pads on the object, in the pad frame."""

    friction: tuple[float, float]
    """Friction of both pads along x and y [N]."""
    torque: float
    """Friction torque of both pads about the grip axis [N m]."""
    grip: tuple[float, float]
    """Normal force of finger 1 and 2 [N]."""


def turning(pitch: float) -> np.ndarray:
    """Rotation from x towards z [rad], (3, 3)."""
    cos, sin = math.cos(pitch), math.sin(pitch)
    return np.array([[cos, 0.0, -sin], [0.0, 1.0, 0.0], [sin, 0.0, cos]])


def look(simulation: Simulation, row: int) -> View:
    """Return the poses of object and gripper of an environment."""
    world = simulation.plant.world[row]
    centre = np.array([world["com"][0], 0.0, world["com"][1]])
    x, z, pitch = world["wrist"].tolist()
    pad = simulation.config.gripper.pad_radius
    box, material, body = simulation.boxes[row], simulation.materials[row], simulation.task.motion.body
    return View(box, material, centre, turning(world["angle"]), (x, z, pitch), pad, body)


def feel(simulation: Simulation, row: int) -> Contact:
    """Return the forces in an environment."""
    x, y, torque = simulation.plant.pads["wrench"][row].sum(axis=0).tolist()
    first, second = simulation.plant.fingers["contact_force"][row].tolist()
    return Contact((x, y), torque, (first, second))


def about(simulation: Simulation, row: int) -> str:
    """Return material and mass of the object, in words."""
    return f"{simulation.materials[row]}, {1e3 * simulation.plant.world['mass'][row]:.0f} g"


def moves(simulation: Simulation, row: int) -> str:
    """Return whether the object "slips" or "sticks" in the grip."""
    twist = simulation.plant.world["slip_twist"][row]
    slips = np.hypot(twist[0], twist[1]) > _SLIPPING[0] or abs(twist[2]) > _SLIPPING[1]
    return "slips" if slips else "sticks"
