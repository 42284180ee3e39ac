"""Configuration models of the gripper and the object in its grip."""

from typing import Annotated, Self

from pydantic import Field, model_validator

from slipgym.config.base import Factors, Frozen, Point, Size, number


def box_inertia(mass: float, a: float, b: float) -> float:
    """Moment of inertia of a uniform box about the axis across its sides a and b [kg m^2]."""
    return mass * (a * a + b * b) / 12.0


class GripperConfig(Frozen):
    """A parallel gripper with a force loop per finger, on a wrist that moves in the contact plane."""

    pad_radius: float = number(0.001, 0.2, "Radius of each disc-shaped pad; 1 mm to 20 cm [m]")
    force_min: float = number(0.001, 1000.0, "Lower end of the force action, per finger [N]")
    force_max: float = number(
        0.001, 1000.0, "Upper end of the force action, per finger; 1 kN crushes what a gripper holds [N]"
    )
    force_limit: float = number(0.001, 1000.0, "Hard limit of the force of one finger; at most 1 kN [N]")
    open_below: float = number(0.0, 1000.0, "Commands below this open the force loop: no force applied [N]")
    lag: float = number(0.0, 1.0, "Time constant of the closed force loop, first order; at most 1 s [s]")
    finger_lag: Factors = Field(description="Time constant of each finger's force loop over lag [-]")
    dead_time: float = number(0.0, 1.0, "Dead time of the force loop, before its lag [s]")
    force_gain: Factors = Field(description="Force of each finger's actuator over the commanded [-]")
    stiction: float = number(
        0.0, 100.0, "Change of the command that friction or backlash swallows, either way from the force [N]"
    )
    force_step: float = number(
        1e-6, 1000.0, "Largest change of the commanded force per control step in mode force_increment [N]"
    )
    finger_mass: float = number(0.001, 10.0, "Mass of one finger with its pad; 1 g to 10 kg [kg]")
    wrist_speed_max: float = number(1e-4, 1000.0, "Largest speed of the wrist in the contact plane [m/s]")
    wrist_pitch_rate_max: float = number(
        1e-4, 1000.0, "Largest pitch rate of the wrist, about the grip axis [rad/s]"
    )

    @model_validator(mode="after")
    def _forces_ascend(self) -> Self:
        if not self.open_below <= self.force_min < self.force_max <= self.force_limit:
            raise ValueError(
                "needs open_below <= force_min < force_max <= force_limit, got "
                f"{self.open_below:g}, {self.force_min:g}, {self.force_max:g}, {self.force_limit:g} N"
            )
        return self


class ObjectConfig(Frozen):
    """A box held by two opposite faces; x and z span the contact plane, y is the grip axis."""

    mass: float = number(0.001, 1000.0, "Mass; 1 g to 1 t [kg]")
    size: Size = Field(description="Extent along x, the grip axis and z [m]")
    com_offset: Point = Field(description="Centre of mass (x, z) from the geometric centre [m]")
    inertia: Annotated[float, Field(ge=1e-9, le=1000.0)] | None = Field(
        description="Inertia about the grip axis through the centre of mass; null: uniform box [kg m^2]"
    )
    grasp_offset: Point = Field(description="Pad centre at reset (x, z), from the geometric centre [m]")

    @property
    def grip_axis_inertia(self) -> float:
        """Moment of inertia about the grip axis through the centre of mass [kg m^2]."""
        if self.inertia is not None:
            return self.inertia
        return box_inertia(self.mass, self.size[0], self.size[2])

    @model_validator(mode="after")
    def _points_lie_inside(self) -> Self:
        for name in ("com_offset", "grasp_offset"):
            x, z = getattr(self, name)
            if abs(x) > self.size[0] / 2 or abs(z) > self.size[2] / 2:
                raise ValueError(f"{name} ({x:g}, {z:g}) m lies outside the object of size {self.size} m")
        return self
