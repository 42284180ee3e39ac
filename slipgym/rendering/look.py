"""Reads the poses that a picture shows from a simulation, without changing it."""

from __future__ import annotations

import math

import numpy as np

from slipgym.rendering.source import Source
from slipgym.rendering.stage import View


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
