"""slipgym's own contact models as rigs."""

from __future__ import annotations

from functools import partial

import numpy as np

from lab.suite.rig import MU, SIZE, Grasp, R, Variant
from slipgym.validation.bench import Bench, Friction
from slipgym.world.bullet_engine import BulletWorld
from slipgym.world.quiet_pybullet import p

OVERRIDES = {"physics": {"gravity": 0.0}, "contact": {"sigma_2": 0.0}}
"""Of the default configuration: loads are the scenes', and friction is Coulomb's."""


class SlipgymRig:
    """A `Bench` as a rig.

    Args:
        grasp: Object and grip.
        engine: "bullet" or "planar".
        contact: "ellipsoid" or "distributed".
    """

    def __init__(self, grasp: Grasp, engine: str, contact: str) -> None:
        friction = Friction(mu_s=MU, mu_c=MU, r=R)
        self._bench = Bench(
            OVERRIDES,
            friction,
            grasp.force,
            contact=contact,
            engine=engine,
            mass=grasp.mass,
            inertia=grasp.inertia,
            size=SIZE,
        )
        self._world, self._state = self._bench.world, self._bench.plant.world
        self._force = grasp.force
        self.step_time = self._bench.step_time

    def step(self, load: np.ndarray, wrist: np.ndarray) -> None:
        """Advance by one control step."""
        world = self._world
        world.disturb(load)
        world.command(self._force)
        world.command_wrist(np.array([wrist[0], wrist[1], 0.0]), self.step_time)
        world.step()

    def throw(self, velocity: np.ndarray) -> None:
        """Set the velocity of the planar object, and of the engine's if there is one.

        The wrist must be at rest, as it is when the scenes throw.
        """
        self._state["velocity"] = self._state["relative_velocity"] = velocity
        world = self._world
        if isinstance(world, BulletWorld):
            x, z, omega = velocity
            linear, angular = (x, 0.0, z), (0.0, -omega, 0.0)
            p.resetBaseVelocity(world.body, linear, angular, physicsClientId=world.client)
            pose, _, *rest = world.reading
            world.reading = pose, (linear, angular), *rest

    @property
    def position(self) -> np.ndarray:
        """Centre of mass and angle, (3,) [m, m, rad]."""
        pose = self._world.reading[0]
        return np.array([pose[0][0], pose[0][2], self._state["angle"][0]])

    @property
    def velocity(self) -> np.ndarray:
        """Velocity of them, (3,) [m/s, m/s, rad/s]."""
        linear, angular = self._world.reading[1]
        return np.array([linear[0], linear[2], -angular[1]])

    @property
    def wrist(self) -> np.ndarray:
        """Pad centre (x, z), (2,) [m]."""
        return np.array(self._world.reading[2][:2])

    def close(self) -> None:
        """Disconnect the engine."""
        self._world.close()


def variants() -> list[Variant]:
    """The contact models and engines."""
    rows = {
        "ellipsoid": ("bullet", "ellipsoid"),
        "ellipsoid, planar engine": ("planar", "ellipsoid"),
        "distributed": ("bullet", "distributed"),
    }
    return [
        Variant("slipgym", name, partial(SlipgymRig, engine=engine, contact=contact), engine == "bullet")
        for name, (engine, contact) in rows.items()
    ]
