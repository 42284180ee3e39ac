"""Configuration models of the disturbances of object, wrist and friction during an episode."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping
from functools import partial
from typing import Annotated, Any, Literal

from pydantic import Field

from slipgym.config.base import number
from slipgym.config.distribution import Distribution, Drawn, Ranged, ranged, within

_when = partial(within, 0.0, 600.0)
_factor = partial(within, 0.1, 10.0)


class Disturbance(Ranged):
    """Base class of the disturbances."""

    probability: float = number(0.0, 1.0, "Fraction of the episodes that have it [-]")


class Push(Disturbance):
    """A force on the object for a short time."""

    kind: Literal["push"] = Field(description="A name")
    time: Distribution = _when("When it begins [s]")
    duration: Distribution = within(1e-3, 10.0, "How long it lasts [s]")
    impulse: Distribution = within(0.0, 10.0, "Force times duration [N s]")
    direction: Distribution = within(-math.tau, math.tau, "Angle of the force to world x, towards up [rad]")
    lever: Distribution = within(-0.5, 0.5, "Lever of the force about the centre of mass [m]")


class Shake(Disturbance):
    """The wrist swings along x, z and in pitch; each axis has a frequency and a phase of its own."""

    kind: Literal["shake"] = Field(description="A name")
    amplitude: Distribution = within(0.0, 0.05, "Along x and z [m]")
    pitch: Distribution = within(0.0, 0.5, "In pitch [rad]")
    frequency: Distribution = within(0.01, 20.0, "Of each axis [Hz]")
    roll: Drawn = ranged(0.0, 0.5, "In roll; needs `physics.tilt` [rad]")
    sway: Drawn = ranged(0.0, 0.05, "Along the grip axis; needs `physics.tilt` [m]")


class MassChange(Disturbance):
    """The object's mass and inertia change at once, in the same proportion."""

    kind: Literal["mass_change"] = Field(description="A name")
    time: Distribution = _when("When [s]")
    factor: Distribution = _factor("Mass and inertia after over before")


class FrictionJump(Disturbance):
    """Friction changes at once, for example when a pad gets wet."""

    kind: Literal["friction_jump"] = Field(description="A name")
    time: Distribution = _when("When [s]")
    factor: Distribution = _factor("mu_s and mu_c after over before")


class SurfaceRegion(Disturbance):
    """A region of the object's surface has different friction."""

    kind: Literal["surface_region"] = Field(description="A name")
    start: Distribution = within(0.0, 1.0, "Distance from the grasp at which it begins [m]")
    length: Distribution = within(0.0, 1.0, "Its length [m]")
    factor: Distribution = _factor("mu_s and mu_c on it over elsewhere")


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
