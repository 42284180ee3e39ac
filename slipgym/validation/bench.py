"""Runs the full world of either engine under prescribed loads, grip forces and wrist motion, for figures."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from slipgym.config import Config, load
from slipgym.world.bullet_engine import BulletWorld, DrivenWorld
from slipgym.world.placing import place
from slipgym.world.planar_engine import step_world
from slipgym.world.plant import build
from slipgym.world.scene import Box

Signal = Callable[[float], Any]
SETTLE_TIME = 0.25  # [s]; twenty time constants of the force loop


@dataclass(frozen=True)
class Figure:
    """A measured size that must not exceed a bound."""

    name: str
    """Name of the figure."""
    bound: float
    """Largest value allowed."""
    measured: float
    """Value found."""
    unit: str
    """Unit of both."""

    @property
    def ok(self) -> bool:
        """Whether the bound holds; not so for NaN."""
        return self.measured <= self.bound


@dataclass(frozen=True)
class Friction:
    """Friction of both pads, to which each finger's factors of the configuration apply."""

    mu_s: float = 0.5155
    """Static friction [-]; wood."""
    mu_c: float = 0.3623
    """Coulomb friction [-]; wood."""
    r: float = 0.010
    """Radius of the equivalent rim contact [m]."""


def uniform_box(config: Config, **changes: Any) -> Box:
    """The configured object as a box, with other fields of `Box` if given."""
    default = config.object
    mass = changes.pop("mass", default.mass)
    size = changes.pop("size", default.size)
    inertia = changes.pop("inertia", mass * (size[0] ** 2 + size[2] ** 2) / 12.0)
    values = {"com_offset": default.com_offset, "grasp_offset": default.grasp_offset, **changes}
    return Box(size=size, mass=mass, inertia=inertia, **values)


@dataclass(frozen=True)
class Trace:
    """Signals of a run in world coordinates (x, z, angle) unless they say otherwise."""

    time: np.ndarray
    """Since the reset (n,) [s]."""
    position: np.ndarray
    """Engine's pose of the object's centre of mass (n, 3) [m, m, rad]."""
    velocity: np.ndarray
    """Engine's velocity of it, mean over the last engine step (n, 3) [m/s, m/s, rad/s]."""
    slip: np.ndarray
    """Slip displacement at the pad centre, pad frame (n, 3) [m, m, rad]."""
    twist: np.ndarray
    """Slip twist at the pad centre over the last sub-step, pad frame (n, 3) [m/s, m/s, rad/s]."""
    wrist: np.ndarray
    """Engine's wrist joints (n, 3) [m, m, rad]."""
    wrist_plan: np.ndarray
    """Wrist as commanded (n, 3) [m, m, rad]."""
    normal: np.ndarray
    """Engine's normal force of either finger (n, 2) [N]."""
    force: np.ndarray
    """Actuator force of either finger (n, 2) [N]."""
    load: np.ndarray
    """Load on the centre of mass during the step (n, 3) [N, N, N m]."""

    @classmethod
    def of(cls, rows: Sequence[tuple[Any, ...]]) -> Self:
        """Stack rows that hold the fields in order."""
        return cls(*(np.array(column) for column in zip(*rows, strict=True)))


class PlanarWorld(DrivenWorld):
    """The planar engine with the interface of `BulletWorld`."""

    _force = 0.0

    def reset(self, box: Box, force: float, wrist: tuple[float, float, float]) -> None:
        """The box held still by both fingers."""
        self._force = force
        place(self._plant, 0, box, force, wrist)

    def command(self, force: float) -> None:
        """Command a grip force per finger [N]."""
        self._force = force

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


class Bench:
    """One gripper and one box, driven open loop; a context manager.

    Args:
        overrides: Overrides of the default configuration; the sensors are ideal.
        friction: Friction of both pads.
        force: Grip force per finger at the start [N].
        wrist: Pad centre (x, z) and pitch at the start [m, m, rad].
        contact: Friction model of the pads.
        engine: What moves the bodies: "bullet" or "planar".
        roll: Of the wrist at the start, with `physics.tilt` [rad].
        **box: Fields of `Box` that differ from the configured object.
    """

    bullet: type[BulletWorld] = BulletWorld
    """The world of the engine "bullet"."""

    def __init__(
        self,
        overrides: Mapping[str, Any] | None = None,
        friction: Friction | None = None,
        force: float = 5.0,
        wrist: tuple[float, float, float] = (0.0, 0.0, 0.0),
        contact: str = "ellipsoid",
        engine: str = "bullet",
        roll: float = 0.0,
        **box: Any,
    ) -> None:
        self.config = load(overrides, "ideal", contact)
        self.friction = friction or Friction()
        self.box = uniform_box(self.config, **box)
        self.plant = build(self.config)
        own = self.config.contact
        for field in ("mu_s", "mu_c", "r"):
            factors = own.finger_radius if field == "r" else own.finger_friction
            self.plant.pads[field] = getattr(self.friction, field) * np.array(factors)
        self._alone = engine == "planar"
        make = PlanarWorld if self._alone else self.bullet
        self.world: PlanarWorld | BulletWorld = make(self.config, self.plant)
        self.world.reset(self.box, force, wrist, **({"roll": roll} if roll else {}))
        self.time = 0.0
        self._force: float = force
        self._steps = 0

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.world.close()

    @property
    def step_time(self) -> float:
        """Control step [s]."""
        return 1.0 / self.config.physics.control_rate

    @property
    def engine_time(self) -> float:
        """Engine step [s]."""
        return 1.0 / self.config.physics.engine_rate

    @property
    def velocity_age(self) -> float:
        """Age of the velocity in a row of the trace [s]: PyBullet's is the mean over a step."""
        return 0.0 if self._alone else 0.5 * self.engine_time

    def limit(self) -> float:
        """Static friction limit mu_s sum f_n of both pads at the engine's normal forces [N]."""
        return self.friction.mu_s * float(self.plant.fingers["contact_force"].sum())

    def run(
        self,
        duration: float,
        load: Signal | None = None,
        force: Signal | None = None,
        wrist: Signal | None = None,
        until: Callable[[Bench], bool] | None = None,
    ) -> Trace:
        """Run for a time; signals are functions of the time since the start of this run [s].

        Args:
            duration: [s].
            load: Load (f_x, f_z, torque) on the centre of mass [N, N, N m], held over a step.
            force: Grip force command per finger [N].
            wrist: Wrist velocity (x, z, pitch) at the end of the step [m/s, m/s, rad/s].
            until: Stops the run after the step in which it turns true.

        Returns:
            Signals of the run, one row per control step.
        """
        rows = []
        for i in range(round(duration / self.step_time)):
            t = i * self.step_time
            wrench = np.zeros(3) if load is None else np.asarray(load(t), dtype=float)
            self.world.disturb(wrench)
            if force is not None:
                self._force = force(t)
            self.world.command(self._force)
            if wrist is not None:
                velocity = np.asarray(wrist(t + self.step_time), dtype=float)
                self.world.command_wrist(velocity, self.step_time)
            self.world.step()
            self._steps += 1
            self.time = self._steps * self.step_time
            rows.append(self._row(wrench))
            if until is not None and until(self):
                break
        return Trace.of(rows)

    def settle(self, force: Signal | None = None) -> Trace:
        """Run until grip and bristles rest."""
        return self.run(SETTLE_TIME, force=force)

    def _row(self, wrench: np.ndarray) -> tuple[Any, ...]:
        pose, velocity, wrist, normals = self.world.reading[:4]
        plant = self.plant
        return (
            self.time,
            (pose[0][0], pose[0][2], float(plant.world["angle"][0])),
            (velocity[0][0], velocity[0][2], -velocity[1][1]),
            plant.world["slip"][0].copy(),
            plant.world["slip_twist"][0].copy(),
            wrist,
            plant.world["wrist_plan"][0].copy(),
            normals,
            plant.fingers["force"][0].copy(),
            wrench,
        )
