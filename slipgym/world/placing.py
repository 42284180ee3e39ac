"""Places box and gripper at the start of an episode."""

from __future__ import annotations

import math

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.contact.kinds import PATCHES
from slipgym.contact.records import Vector, rest, rest_cells
from slipgym.world.actuator import actuator_force, mean_force
from slipgym.world.plant import Plant
from slipgym.world.scene import Box

PATCHES_OF_WORLDS = PATCHES + 1
"""Dimensions of `Plant.cells` if they are patches."""


def place(plant: Plant, i: int, box: Box, force: float, wrist: tuple[float, float, float]) -> None:
    """Bring a world to rest at time 0, the box in the grip.

    Args:
        plant: Arrays of n worlds.
        i: Which of them.
        box: The box.
        force: Commanded grip force per finger, established [N].
        wrist: Pad centre (x, z) and pitch [m, m, rad].
    """
    body = box.mass, box.inertia, box.size[1] / 2, *box.grasp_from_com
    place_world(plant.world, plant.pads, plant.cells, plant.fingers, i, body, force, wrist)


@compiled
def place_world(
    worlds: np.ndarray,
    pads: np.ndarray,
    cells: np.ndarray | None,
    fingers: np.ndarray,
    i: int,
    body: tuple[float, float, float, float, float],
    force: float,
    wrist: Vector,
) -> None:
    """`place`, compiled; body is (mass, inertia, half thickness, pad centre from the centre of mass)."""
    world = worlds[i]
    mass, inertia, half_thickness, x, z = body
    cos, sin = math.cos(wrist[2]), math.sin(wrist[2])
    world.tick = 0
    world.velocity[:] = 0.0
    world.external[:] = 0.0
    world.wrist_velocity[:] = 0.0
    world.wrist_acceleration[:] = 0.0
    world.relative_velocity[:] = 0.0
    world.slip[:] = 0.0
    world.slip_twist[:] = 0.0
    world.mass, world.inertia, world.half_thickness = mass, inertia, half_thickness
    for a in range(3):
        world.wrist[a] = world.wrist_plan[a] = wrist[a]
    world.relative[0], world.relative[1], world.relative[2] = -x, -z, 0.0
    world.grasp_point[0], world.grasp_point[1] = x, z
    world.com[0], world.com[1] = wrist[0] - cos * x + sin * z, wrist[1] - sin * x - cos * z
    world.angle = wrist[2]
    for f in range(2):
        finger = fingers[i, f]
        finger.queued = finger.served = 0
        finger.settled = finger.command = finger.force = actuator_force(finger, force)
    normal = mean_force(fingers[i])
    for f in range(2):
        finger = fingers[i, f]
        finger.mean_force = finger.contact_mean_force = finger.contact_force = normal
    rest(pads[i])
    for f in range(2):
        pads[i, f].normal = force
    if cells is None:
        return
    if cells.ndim == PATCHES_OF_WORLDS:
        rest_cells(cells[i])
