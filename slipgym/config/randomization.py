"""Configuration models of the randomization: distributions that every episode is sampled from."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Annotated, Self

from pydantic import BeforeValidator, Field, ValidationError, ValidationInfo, model_validator

from slipgym.config.base import as_tuple
from slipgym.config.distribution import Drawn, ranged
from slipgym.config.disturbances import AnyDisturbance, renamed
from slipgym.config.errors import unknown
from slipgym.config.pad import LEAST, PadRanges
from slipgym.contact.pressure import PressureName

PUSHES_MAX = 16

Names = Annotated[tuple[str, ...], Field(min_length=1), BeforeValidator(as_tuple)]
Pressures = Annotated[tuple[PressureName, ...], Field(min_length=1), BeforeValidator(as_tuple)]


class OwnRanges(PadRanges):
    """Distributions that one task replaces; a field that is null or left out is not randomized."""

    materials: Names | None = Field(
        default=None, description="Materials to sample from, if no other friction is randomized"
    )
    mu_c: Drawn = ranged(0.01, 5.0, "Coulomb friction, whatever the material")
    mu_s: Drawn = ranged(0.01, 5.0, "Static friction; not below mu_c")
    friction_ratio: Drawn = ranged(1.0, 5.0, "Static over Coulomb friction, instead of mu_s")
    friction_drift: Drawn = ranged(-1.0, 1.0, "Relative rate at which both change [1/s]")
    stribeck_velocity: Drawn = ranged(1e-5, 0.1, "Slip speed at which mu_s has decayed to mu_c [m/s]")
    speed_slope: Drawn = ranged(-0.2, 0.2, "Growth of mu_c with the logarithm of the slip speed")
    sigma_0: Drawn = ranged(1e5, 1e8, "Bristle stiffness [1/m]")
    radius_scale: Drawn = ranged(0.1, 10.0, "Contact radius r over the task's")
    finger_friction: Drawn = ranged(0.1, 10.0, "Friction over that of the material, for each finger")
    finger_radius: Drawn = ranged(0.1, 10.0, "Contact radius over r, for each finger")
    cop_offset: Drawn = ranged(
        -0.05, 0.05, "Centre of pressure off the pad's centre, each finger's x and y [m]"
    )
    pressure: Pressures | None = Field(
        default=None, description="Pressure profiles of the patch to sample from"
    )
    mass_scale: Drawn = ranged(0.1, 10.0, "Object's mass over the task's")
    size_scale: Drawn = ranged(0.5, 2.0, "Object's extents along x and z, grasp included, over the task's")
    com_x: Drawn = ranged(-0.4, 0.4, "Centre of mass along x off the task's, over the extent")
    com_z: Drawn = ranged(-0.4, 0.4, "Centre of mass along z off the task's, over the extent")
    lag: Drawn = ranged(0.0, 0.2, "Time constant of the force loop [s]")
    finger_lag: Drawn = ranged(0.1, 10.0, "Time constant over lag, for each finger")
    dead_time: Drawn = ranged(0.0, 0.1, "Dead time of the force loop [s]")
    force_gain: Drawn = ranged(0.1, 10.0, "Actuator force over the commanded, for each finger")
    stiction: Drawn = ranged(0.0, 10.0, "Stiction of each finger's actuator [N]")
    noise_scale: Drawn = ranged(0.0, 10.0, "White noise of all sensors over the configured")
    bias_scale: Drawn = ranged(
        0.0, 100.0, "Spread of force and torque biases beyond the configured, over the configured noise"
    )
    slip_latency: Drawn = ranged(0.0, 6.0, "Latency of the slip velocity, rounded [samples]")
    disturbances: Annotated[tuple[AnyDisturbance, ...], BeforeValidator(renamed)] = Field(
        default=(), description="Disturbances during an episode"
    )


class Ranges(OwnRanges):
    """Distributions of one task."""

    @model_validator(mode="after")
    def _friction_is_told_once(self) -> Self:
        if self.mu_s is not None and self.friction_ratio is not None:
            raise ValueError("mu_s and friction_ratio exclude each other")
        if self.mu_s is not None and (self.mu_c is None or self.mu_s.ends[0] < self.mu_c.ends[1]):
            raise ValueError("mu_s needs a mu_c that never lies above it")
        if self.materials is not None and (self.mu_c is not None or self.friction_ratio is not None):
            raise ValueError("materials are drawn only where mu_c and friction_ratio are not")
        return self

    @model_validator(mode="after")
    def _exponents_are_told_once(self) -> Self:
        radius = self.radius_exponent
        if self.friction_by_area and self.load_exponent is not None:
            raise ValueError("load_exponent and friction_by_area exclude each other")
        if self.friction_by_area and (radius is None or radius.ends[0] < LEAST):
            raise ValueError(f"friction_by_area needs a radius_exponent from {LEAST:g} to 0.333333")
        return self

    @model_validator(mode="after")
    def _happens_once(self) -> Self:
        for kind, count in Counter(disturbance.kind for disturbance in self.disturbances).items():
            most = PUSHES_MAX if kind == "push" else 1
            if count > most:
                raise ValueError(f"disturbances hold {count} of kind {kind}; at most {most}")
        return self


class Randomization(Ranges):
    """Ranges for all tasks, and the fields that single tasks replace."""

    tasks: Mapping[str, OwnRanges] = Field(default={}, description="Fields that differ, by task")

    @model_validator(mode="after")
    def _tasks_exist(self, info: ValidationInfo) -> Self:
        known = (info.context or {}).get("tasks")
        for name in self.tasks:
            if known is not None and name not in known:
                raise ValueError(unknown("task", name, known))
            try:
                self.of(name)
            except ValidationError as error:
                message = error.errors()[0]["msg"].removeprefix("Value error, ")
                raise ValueError(f"tasks.{name}: {message}") from None
        return self

    def of(self, task: str) -> Ranges:
        """The ranges of a task.

        Args:
            task: Its key in the configuration.

        Raises:
            ValueError: The task's fields contradict the common ones.
        """
        values = {name: getattr(self, name) for name in Ranges.model_fields}
        own = self.tasks.get(task, OwnRanges())
        return Ranges(**values | {name: getattr(own, name) for name in own.model_fields_set})
