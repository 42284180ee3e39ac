"""Reads the poses that a picture shows from a simulation, without changing it."""

from __future__ import annotations

import math

import numpy as np

from slipgym.rendering.source import Source
from slipgym.rendering.stage import View

_SLIPPING = 5e-4, 0.05  # slip speed [m/s] and rate [rad/s] from which the object counts as slipping


def slips(twist: np.ndarray) -> bool:
    """Whether an object with a slip twist (3,) [m/s, m/s, rad/s] counts as slipping in a picture."""
    return bool(np.hypot(twist[0], twist[1]) > _SLIPPING[0] or abs(twist[2]) > _SLIPPING[1])


def look(simulation: Source, row: int) -> View:
    """Return the poses of object and gripper.

    Args:
        simulation: The environments' simulation.
        row: Index of the environment.
    """
    world = simulation.plant.world[row]
    cos, sin = math.cos(world["angle"]), math.sin(world["angle"])
    rotation = np.array([[cos, 0.0, -sin], [0.0, 1.0, 0.0], [sin, 0.0, cos]])
    x, z, pitch = world["wrist"].tolist()
    centre = np.array([world["com"][0], 0.0, world["com"][1]])
    pad = simulation.config.gripper.pad_radius
    box, material, body = simulation.boxes[row], simulation.materials[row], simulation.task.motion.body
    return View(box, material, centre, rotation, (x, z, pitch), pad, body)
