"""`PlanarWorld`: the planar engine with the interface of `BulletWorld`, for figures that use both."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from slipgym.config import Config
from slipgym.world.placing import place
from slipgym.world.planar_engine import step_world
from slipgym.world.plant import Plant
from slipgym.world.scene import Box
from slipgym.world.wrist import ramp_wrist


class PlanarWorld:
    """One world of the planar engine.

    Its methods are those of `slipgym.world.bullet_engine.BulletWorld`.

    Args:
        config: Configuration; the gripper's limits are read.
        plant: Arrays of one world.
    """

    def __init__(self, config: Config, plant: Plant) -> None:
        self._gripper, self._plant, self._force = config.gripper, plant, 0.0

    def reset(self, box: Box, force: float, wrist: tuple[float, float, float]) -> None:
        """The box held still by both fingers."""
        self._force = force
        place(self._plant, 0, box, force, wrist)

    def command(self, force: float) -> None:
        """Command a grip force per finger [N]."""
        self._force = force

    def command_wrist(self, velocity: np.ndarray, duration: float) -> None:
        """Ramp the wrist velocity to a target within `duration` [s]."""
        limits = self._gripper.wrist_speed_max, self._gripper.wrist_pitch_rate_max
        x, z, pitch = velocity
        ramp_wrist(self._plant.world[0], x, z, pitch, *limits, duration)

    def disturb(self, wrench: np.ndarray) -> None:
        """Apply a load (f_x, f_z, torque) to the object's centre of mass until the next call."""
        self._plant.world["external"] = wrench

    def step(self) -> None:
        """Advance by one control step."""
        plant = self._plant
        bodies = plant.world, plant.pads, plant.cells, plant.fingers, plant.force_torque, plant.slip_sensors
        step_world(*bodies, self._force, 0)

    @property
    def reading(self) -> tuple[Any, ...]:
        """Pose, velocity, wrist joints, normal forces, in PyBullet's form."""
        world, fingers = self._plant.world[0], self._plant.fingers[0]
        (x, z), angle, (v_x, v_z, omega) = world["com"], float(world["angle"]), world["velocity"]
        pose = (x, 0.0, z), (0.0, -math.sin(angle / 2), 0.0, math.cos(angle / 2))
        return (
            pose,
            ((v_x, 0.0, v_z), (0.0, -omega, 0.0)),
            tuple(world["wrist"]),
            tuple(fingers["contact_force"]),
        )

    def close(self) -> None:
        """There is nothing to release."""
