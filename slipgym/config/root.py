"""`Config`, the configuration of an environment without its task's settings."""

import math
from collections.abc import Mapping, Sequence
from typing import Self

from pydantic import Field, model_validator

from slipgym.config.base import Frozen
from slipgym.config.hardware import GripperConfig, ObjectConfig
from slipgym.config.physics import ContactConfig, Material, NominalConfig, PhysicsConfig
from slipgym.config.sensors import SensorsConfig
from slipgym.contact.pressure import OUTER_RADII


class Config(Frozen):
    """Gripper, object, friction, sensors and rates of an environment; defaults are in ``configs/``.

    `slipgym.tasks.configure` returns it together with the settings of a task.
    """

    gripper: GripperConfig = Field(description="The gripper")
    object: ObjectConfig = Field(description="The object in the grip")
    contact: ContactConfig = Field(description="The friction model")
    materials: Mapping[str, Material] = Field(description="Friction coefficients, by the material's name")
    nominal: NominalConfig = Field(description="The friction that controllers may assume")
    physics: PhysicsConfig = Field(description="Gravity and rates")
    sensors: SensorsConfig = Field(description="The sensors of each finger")

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
        """Raise ValueError if a distributed patch with this r [m] does not fit on the pad."""
        pressure, pad = self.contact.pressure, self.gripper.pad_radius
        outer = OUTER_RADII[pressure] * r
        if self.contact.model == "distributed" and outer > pad * (1.0 + 1e-9):
            raise ValueError(
                f"{name} = {r:g} m needs a {pressure} patch of {outer:g} m on a pad of {pad:g} m; "
                f"must be at most {pad / OUTER_RADII[pressure]:g} m"
            )

    def check_radius(self, name: str, r: float) -> None:
        """Raise ValueError if a contact with radius r [m] does not fit on the pad; `name` is its key."""
        if r > self.gripper.pad_radius:
            raise ValueError(
                f"{name} must not exceed gripper.pad_radius, got {r:g} and {self.gripper.pad_radius:g} m"
            )
        self.check_patch(name, r)

    def check_cop_offset(self, name: str, points: Sequence[tuple[float, float]]) -> None:
        """Raise ValueError if a finger's centre of pressure lies outside its pad; `name` is its key."""
        pad = self.gripper.pad_radius
        for f, (x, y) in enumerate(points, 1):
            if math.hypot(x, y) > pad:
                raise ValueError(
                    f"{name}: ({x:g}, {y:g}) m of finger {f} must lie on the pad, whose radius is {pad:g} m"
                )

    @model_validator(mode="after")
    def _contact_fits_pad(self) -> Self:
        self.check_radius("contact.radius", self.contact_radius)
        largest = self.contact_radius * max(self.contact.finger_radius)
        self.check_radius("contact.finger_radius: the larger radius r", largest)
        self.check_cop_offset("contact.cop_offset", self.contact.cop_offset)
        return self
