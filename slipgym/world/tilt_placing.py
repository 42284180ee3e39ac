"""Places TILT, the motion out of the contact plane."""

from __future__ import annotations

import math

from slipgym.config.hardware import box_inertia
from slipgym.world.plant import Plant
from slipgym.world.scene import Box


def gyration(box: Box) -> tuple[float, float, float]:
    """Squared radii of gyration about the box's axes (x, grip axis, z) [m^2].

    Those of a uniform box, all in the proportion that gives its inertia about the grip axis.
    """
    x, y, z = box.size
    scale = box.inertia / box_inertia(box.mass, x, z) / box.mass
    unit = scale * box.mass
    return box_inertia(unit, y, z), box_inertia(unit, x, z), box_inertia(unit, x, y)


def place_tilt(plant: Plant, i: int, box: Box, force: float, roll: float) -> None:
    """Bring a world to rest at a roll of the wrist, the box in balance with its weight along the grip axis.

    `slipgym.world.placing.place` comes first.

    Args:
        plant: Arrays of n worlds with `tilt`.
        i: Which of them.
        box: The box.
        force: Grip force per finger [N].
        roll: Of the wrist [rad].
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
