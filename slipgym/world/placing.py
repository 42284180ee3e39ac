"""Places box and gripper at the start of an episode."""

from __future__ import annotations

import math

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.config.hardware import box_inertia
from slipgym.contact.kinds import PATCHES
from slipgym.contact.records import Vector, rest, rest_cells
from slipgym.world.actuator import actuator_force, mean_force
from slipgym.world.plant import Plant
from slipgym.world.scene import Box

PATCHES_OF_WORLDS = PATCHES + 1
"""Dimensions of `Plant.cells` if they are patches."""


def place(plant: Plant, i: int, box: Box, force: float, wrist: tuple[float, float, float]) -> None:
    """Bring world i to rest at time 0, the box in the grip.

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


def gyration(box: Box) -> tuple[float, float, float]:
    """Squared radii of gyration about the box's axes (x, grip axis, z) [m^2].

    Those of a uniform box, all in the proportion that gives its inertia about the grip axis.
    """
    x, y, z = box.size
    scale = box.inertia / box_inertia(box.mass, x, z) / box.mass
    unit = scale * box.mass
    return box_inertia(unit, y, z), box_inertia(unit, x, z), box_inertia(unit, x, y)


def place_tilt(plant: Plant, i: int, box: Box, force: float, roll: float) -> None:
    """After `place`, bring world i, which has `tilt`, to rest at a roll of the wrist [rad].

    The box is in balance with its weight along the grip axis under a grip force per finger [N].
    """
    assert plant.tilt is not None
    tilt, world, pads = plant.tilt[i], plant.world[i], plant.pads[i]
    for f in range(2):
        changed = (pads["cop"][f] != tilt["cop"][f]).any()
        tilt["cop_rest"][f] = pads["cop"][f] if changed else tilt["cop_rest"][f]
        pads["cop"][f] = tilt["cop"][f] = tilt["cop_rest"][f]
    stiffness = float(tilt["stiffness"])
    along = box.mass * float(tilt["gravity"]) * math.sin(roll)
    tilt["gyration"] = gyration(box)
    tilt["roll"], tilt["sway"] = (roll, 0.0, 0.0), 0.0
    x, z = world["wrist"][:2] - world["com"]
    turning = 2.0 * stiffness * float(tilt["pad_radius"]) ** 2 / 4.0
    about_x, about_z = (-z * along / turning, x * along / turning) if force > 0.0 else (0.0, 0.0)
    sagging = 0.5 * along / stiffness if force > 0.0 else 0.0
    tilt["height"] = -sagging - (about_z * x - about_x * z)
    tilt["closure"] = force / stiffness
    tilt["speed"] = tilt["closing"] = 0.0
    tilt["momentum"] = tilt["spin"] = tilt["moment"] = 0.0
    tilt["attitude"] = _attitude(about_x, about_z, float(world["angle"]))
    tilt["normal"] = force
    world["gravity"] = tilt["gravity"] * math.cos(roll)


def _attitude(about_x: float, about_z: float, angle: float) -> tuple[float, float, float, float]:
    """Quaternion of a small tilt after an angle about -y."""
    cos, sin = math.cos(0.5 * angle), -math.sin(0.5 * angle)
    x, z, w = 0.5 * about_x, 0.5 * about_z, 1.0
    scale = 1.0 / math.sqrt(x * x + z * z + w * w)
    x, z, w = scale * x, scale * z, scale * w
    return x * cos - z * sin, w * sin, z * cos + x * sin, w * cos
