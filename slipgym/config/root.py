"""The whole configuration of an environment."""

from collections.abc import Mapping
from typing import Any, Self

from pydantic import Field, model_validator

from slipgym.config.base import Frozen
from slipgym.config.hardware import GripperConfig, ObjectConfig
from slipgym.config.physics import ContactConfig, Material, NominalConfig, PhysicsConfig
from slipgym.config.sensors import SensorsConfig
from slipgym.config.tasks import TasksConfig
from slipgym.contact.pressure import OUTER_RADII


class Config(Frozen):
    """Everything that an environment can be told.

    The defaults live in ``configs/``, those of a task in its file. `config_model` adds the tasks' settings.
    """

    gripper: GripperConfig = Field(description="The gripper [-]")
    object: ObjectConfig = Field(description="The object in the grip [-]")
    contact: ContactConfig = Field(description="The friction model [-]")
    materials: Mapping[str, Material] = Field(description="Friction coefficients, by the material's name [-]")
    nominal: NominalConfig = Field(description="The friction that controllers may assume [-]")
    physics: PhysicsConfig = Field(description="Gravity and rates [-]")
    sensors: SensorsConfig = Field(description="The sensors of each finger [-]")
    tasks: TasksConfig = Field(description="Parameters of the tasks [-]")

    def __reduce__(self) -> tuple[Any, ...]:
        from slipgym.config.assembly import restored  # which imports this file

        return restored, (self.model_dump(mode="json"),)

    @model_validator(mode="after")
    def _rates_fit(self) -> Self:
        slip = self.sensors.slip.rate
        if slip != self.physics.control_rate:
            raise ValueError(
                "one control step is one slip sample: sensors.slip.rate must equal physics.control_rate, "
                f"got {slip} and {self.physics.control_rate} Hz"
            )
        return self

    @property
    def contact_radius(self) -> float:
        """Radius r of the equivalent rim contact [m]."""
        if self.contact.radius is not None:
            return self.contact.radius
        return self.gripper.pad_radius / OUTER_RADII[self.contact.pressure]

    def check_patch(self, name: str, r: float) -> None:
        """Raise ValueError if the pad has no room for a distributed patch with this r [m]."""
        pressure, pad = self.contact.pressure, self.gripper.pad_radius
        outer = OUTER_RADII[pressure] * r
        if self.contact.model == "distributed" and outer > pad * (1.0 + 1e-9):
            raise ValueError(
                f"{name} = {r:g} m needs a {pressure} patch of {outer:g} m on a pad of {pad:g} m; "
                f"must be at most {pad / OUTER_RADII[pressure]:g} m"
            )

    @model_validator(mode="after")
    def _contact_fits_pad(self) -> Self:
        radii = {f"tasks.{name}.radius": task.radius for name, task in self.tasks}
        for name, radius in {"contact.radius": self.contact_radius, **radii}.items():
            if radius is None:
                continue
            if radius > self.gripper.pad_radius:
                raise ValueError(
                    f"{name} must not exceed gripper.pad_radius, "
                    f"got {radius:g} and {self.gripper.pad_radius:g} m"
                )
            self.check_patch(name, radius)
        return self

    @model_validator(mode="after")
    def _initial_forces_in_range(self) -> Self:
        low, high = self.gripper.force_min, self.gripper.force_max
        for name, task in self.tasks:
            force = task.initial_force
            if not low <= force <= high:
                raise ValueError(
                    f"tasks.{name}.initial_force must lie within the gripper's {low:g} to {high:g} N, "
                    f"got {force:g} N"
                )
        return self
