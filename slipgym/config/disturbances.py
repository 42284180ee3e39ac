"""Configuration models of the disturbances of object, wrist and friction during an episode."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field

from slipgym.config.base import Frozen
from slipgym.config.distribution import Distribution, within

Time = Annotated[Distribution, within(0.0, 600.0)]
Factor = Annotated[Distribution, within(0.1, 10.0)]


class Disturbance(Frozen):
    """Base class of the disturbances."""

    probability: float = Field(ge=0.0, le=1.0, description="Fraction of the episodes that have it [-]")


class Push(Disturbance):
    """A force on the object for a short time."""

    kind: Literal["push"] = Field(description="A name")
    time: Time = Field(description="When it begins [s]")
    duration: Annotated[Distribution, within(1e-3, 10.0)] = Field(description="How long it lasts [s]")
    impulse: Annotated[Distribution, within(0.0, 10.0)] = Field(description="Force times duration [N s]")
    direction: Annotated[Distribution, within(-math.tau, math.tau)] = Field(
        description="Angle of the force to world x, towards up [rad]"
    )
    lever: Annotated[Distribution, within(-0.5, 0.5)] = Field(
        description="Lever of the force about the centre of mass [m]"
    )


class Shake(Disturbance):
    """The wrist swings along x, z and in pitch; each axis has a frequency and a phase of its own."""

    kind: Literal["shake"] = Field(description="A name")
    amplitude: Annotated[Distribution, within(0.0, 0.05)] = Field(description="Along x and z [m]")
    pitch: Annotated[Distribution, within(0.0, 0.5)] = Field(description="In pitch [rad]")
    frequency: Annotated[Distribution, within(0.01, 20.0)] = Field(description="Of each axis [Hz]")
    roll: Annotated[Distribution | None, within(0.0, 0.5)] = Field(
        default=None, description="In roll; needs `physics.tilt` [rad]"
    )
    sway: Annotated[Distribution | None, within(0.0, 0.05)] = Field(
        default=None, description="Along the grip axis; needs `physics.tilt` [m]"
    )


class MassChange(Disturbance):
    """The object's mass and inertia change at once, in the same proportion."""

    kind: Literal["mass_change"] = Field(description="A name")
    time: Time = Field(description="When [s]")
    factor: Factor = Field(description="Mass and inertia after over before")


class FrictionJump(Disturbance):
    """Friction changes at once, for example when a pad gets wet."""

    kind: Literal["friction_jump"] = Field(description="A name")
    time: Time = Field(description="When [s]")
    factor: Factor = Field(description="mu_s and mu_c after over before")


class SurfaceRegion(Disturbance):
    """A region of the object's surface has different friction."""

    kind: Literal["surface_region"] = Field(description="A name")
    start: Annotated[Distribution, within(0.0, 1.0)] = Field(
        description="Distance from the grasp at which it begins [m]"
    )
    length: Annotated[Distribution, within(0.0, 1.0)] = Field(description="Its length [m]")
    factor: Factor = Field(description="mu_s and mu_c on it over elsewhere")


AnyDisturbance = Annotated[
    Push | Shake | MassChange | FrictionJump | SurfaceRegion, Field(discriminator="kind")
]
"""A disturbance of any kind."""


def renamed(values: Any) -> Any:
    """Disturbances as given, those of kind "patch" under the kind's new name "surface_region"."""
    if not isinstance(values, list | tuple):
        return values
    return tuple(_renamed(value) for value in values)


def _renamed(value: Any) -> Any:
    if not isinstance(value, Mapping) or value.get("kind") != "patch":
        return value
    warnings.warn("disturbance kind 'patch' is now 'surface_region'", DeprecationWarning, stacklevel=2)
    return {**value, "kind": "surface_region"}
