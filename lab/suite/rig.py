"""`Rig`, one grasp in one engine, as the scenes of the suite drive and read it."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

MU = 0.5
"""Static and Coulomb friction coefficient of pads on object [-]."""
PATCH_RADIUS = 0.015
"""Radius R of the uniformly loaded disc that a pad presses with [m]."""
R = 2.0 / 3.0 * PATCH_RADIUS
"""Radius of the equivalent rim contact: torque in pure spin over mu f_n [m]."""
SIZE = 0.3, 0.03, 0.3
"""Extent of the box along x, the grip axis and z [m]; the pads stay on it in every scene."""
FINGER_MASS = 0.1
"""Mass of a finger [kg]."""
SETTLE_TIME = 0.5
"""Time without load in which the pads come to rest on the object [s]."""


@dataclass(frozen=True)
class Grasp:
    """Object and grip of a scene."""

    mass: float = 0.2
    """Mass of the object [kg]."""
    inertia: float = 1e-4
    """Moment of inertia about the grip axis [kg m^2]."""
    force: float = 5.0
    """Grip force per finger, constant [N]."""

    @property
    def limit(self) -> float:
        """Friction limit mu sum f_n of both pads [N]."""
        return 2.0 * MU * self.force


class Rig(Protocol):
    """An object between two pads on a wrist that moves as prescribed, without gravity.

    Vectors in the contact plane are (x, z, angle) in world axes, right-handed about the grip axis -y.
    The object's centre of mass starts at the pad centre, which is the origin.
    """

    step_time: float
    """Time that a step takes [s]."""

    def step(self, load: np.ndarray, wrist: np.ndarray) -> None:
        """Advance by one step.

        Args:
            load: On the centre of mass, (3,) [N, N, N m].
            wrist: Velocity (x, z) of the wrist at the end of the step, (2,) [m/s].
        """
        ...

    def throw(self, velocity: np.ndarray) -> None:
        """Give the object a velocity, (3,) [m/s, m/s, rad/s]."""
        ...

    @property
    def position(self) -> np.ndarray:
        """Centre of mass and angle of the object, (3,) [m, m, rad]."""
        ...

    @property
    def velocity(self) -> np.ndarray:
        """Velocity of them, (3,) [m/s, m/s, rad/s]."""
        ...

    @property
    def wrist(self) -> np.ndarray:
        """Pad centre (x, z), (2,) [m]."""
        ...

    def close(self) -> None:
        """Release the engine."""
        ...


@dataclass(frozen=True)
class Variant:
    """An engine with settings, a row of the table."""

    engine: str
    """Name of the engine, as on the command line."""
    settings: str
    """Its settings in a few words."""
    make: Callable[[Grasp], Rig]
    """Return a rig at rest; its pads may still have to settle."""
    drawn: bool = False
    """Whether the figure shows it."""


def library(name: str, package: str, purpose: str) -> Any:
    """Import a module of an optional library.

    Args:
        name: Of the module.
        package: What installs it.
        purpose: What it is for.

    Raises:
        RuntimeError: It is not installed.
    """
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        text = f"{purpose} needs {error.name}, which is not installed: pip install {package}"
        raise RuntimeError(text) from error
