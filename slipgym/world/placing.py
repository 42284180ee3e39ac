"""Box and gripper at the start of an episode."""

from __future__ import annotations

import math

from slipgym.world.plant import Plant
from slipgym.world.scene import Box


def place(plant: Plant, i: int, box: Box, force: float, wrist: tuple[float, float, float]) -> None:
    """Bring a world to rest at time 0, the box in the grip.

    Args:
        plant: Arrays of n worlds.
        i: Which of them.
        box: The box.
        force: Grip force per finger [N].
        wrist: Pad centre (x, z) and pitch [m, m, rad].
    """
    world, fingers = plant.world[i], plant.fingers[i]
    cos, sin = math.cos(wrist[2]), math.sin(wrist[2])
    x, z = box.grasp_from_com
    for field in ("tick", "velocity", "external", "wrist_velocity", "wrist_acceleration"):
        world[field] = 0
    for field in ("relative_velocity", "slip", "slip_twist"):
        world[field] = 0.0
    world["mass"], world["inertia"] = box.mass, box.inertia
    world["half_thickness"] = box.size[1] / 2
    world["wrist"] = world["wrist_plan"] = wrist
    world["relative"] = -x, -z, 0.0
    world["grasp_point"] = x, z
    world["com"] = wrist[0] - cos * x + sin * z, wrist[1] - sin * x - cos * z
    world["angle"] = wrist[2]
    for field in ("queued", "served"):
        fingers[field] = 0
    for field in ("command", "force", "mean_force", "contact_mean_force", "contact_force"):
        fingers[field] = force
    plant.relax(i)
