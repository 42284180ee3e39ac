"""Configuration models of friction, gravity and the simulation's rates."""

from typing import Annotated, Literal, Self, TypeAlias

from pydantic import Field, model_validator

from slipgym.config.base import Factors, Frozen, Points, number
from slipgym.config.pad import PadConfig
from slipgym.contact.pressure import PressureName

ContactModel: TypeAlias = Literal["ellipsoid", "disc", "distributed"]
"""Names of the friction models."""


class Material(Frozen):
    """Friction coefficients of a material against the pads."""

    mu_c: float = number(
        0.001, 10.0, "Coulomb friction coefficient; from 0.001 to 10, as rubber on anything [-]"
    )
    mu_s: float = number(0.001, 10.0, "Static friction coefficient, at least mu_c [-]")

    @model_validator(mode="after")
    def _static_is_larger(self) -> Self:
        if self.mu_s < self.mu_c:
            raise ValueError(f"needs mu_s >= mu_c, got mu_s {self.mu_s:g} < mu_c {self.mu_c:g}")
        return self


class NominalConfig(Material):
    """Contact properties that a controller assumes when it has no other friction information."""

    r: float = number(1e-4, 0.2, "Radius of the equivalent rim contact; at most that of the largest pad [m]")


class ContactConfig(Frozen):
    """The friction model of a pad, apart from the material's coefficients.

    "ellipsoid" is one bristle with an ellipsoidal limit surface, "disc" one with the limit surface of
    a uniform disc. "distributed" is a round patch of cells, each a bristle; its limit surface follows
    from its pressure profile, and it breaks away in parts. Estimators and controllers describe all of
    them by r, the torque in pure spin over mu_c times the normal force. A patch whose r differs from
    that of the whole pad is scaled in proportion.
    """

    model: ContactModel = Field(description="Friction model of the pads: a name")
    pressure: PressureName = Field(
        description="Pressure over the patch: constant, Hertz's, on its edge alone, or of a flat punch"
    )
    cells: int = number(2, 101, "Cells along each side of a distributed patch; 11 are four times as fast [-]")
    sigma_0: float = number(1e5, 1e8, "Bristle stiffness; soft ones appear as slip in stick [1/m]")
    sigma_1: float = number(0.0, 1e5, "Bristle damping; more than 1e5 is overdamped beyond any use [s/m]")
    sigma_2: float = number(0.0, 1000.0, "Viscous friction; at 1e3 friction grows by 1 for each mm/s [s/m]")
    stribeck_velocity: float = number(
        1e-5, 0.1, "Slip speed v_s at which mu_s has decayed to mu_c; as of a randomization [m/s]"
    )
    stribeck_exponent: float = number(0.1, 10.0, "Exponent of that decay; published ones are 0.5 to 2 [-]")
    speed_slope: float = number(
        -0.2, 0.2, "Growth of mu_c with the logarithm of the slip speed over 10 mm/s [-]"
    )
    radius: Annotated[float, Field(ge=1e-4, le=0.2)] | None = Field(
        description="Radius r of the equivalent rim contact; null: that of the pressure on the whole pad [m]"
    )
    finger_friction: Factors = Field(description="Friction of each finger over the material's [-]")
    finger_radius: Factors = Field(description="Contact radius of each finger over r [-]")
    normal_stiffness: float = Field(
        gt=0, le=1e7, description="Stiffness of a pad along the grip axis, with physics.tilt [N/m]"
    )
    normal_damping: float = number(0, 1e4, "Damping of a pad along the grip axis, with physics.tilt [N s/m]")
    cop_offset: Points = Field(description="Centre of pressure (x, y) from the pad's centre, per finger [m]")
    pad: PadConfig = Field(description="What the pads' rubber adds")


class PhysicsConfig(Frozen):
    """Gravity and the three nested rates: control step, engine step, friction sub-step."""

    gravity: float = number(0.0, 100.0, "Gravitational acceleration; Jupiter's is 25 [m/s^2]")
    control_rate: int = number(10, 2000, "Environment steps per second; slower ones miss slips [Hz]")
    engine_steps: int = number(1, 100, "Rigid-body engine steps per control step; 4 suffice [-]")
    substep_max: float = number(1e-5, 0.01, "Longest friction sub-step; longer ones miss a break-away [s]")
    patch_substep_max: float = number(
        1e-5, 0.01, "Longest friction sub-step of a distributed contact, which turns in parts [s]"
    )
    planar_substep_max: float = number(
        1e-5, 0.01, "Longest friction sub-step without an engine near the friction limit [s]"
    )
    solver_iterations: int = number(
        1, 1000, "Iterations of the engine's contact solver per step; 25 suffice [-]"
    )

    tilt: bool = Field(
        description="Whether the object may tilt and move along the grip axis, with PyBullet alone"
    )

    @property
    def engine_rate(self) -> int:
        """Rigid-body engine steps per second [Hz]."""
        return self.control_rate * self.engine_steps
