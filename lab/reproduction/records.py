"""Keeps what the sensors of both fingers say in a trial, so that every estimator sees the same data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from slipgym.envs.simulation import Simulation


@dataclass(frozen=True)
class Record:
    """T slip-velocity samples of a trial, each with the newest force."""

    keys: Mapping[str, Any]
    """What distinguishes the trial from the others, for tables; with "material"."""
    truth: np.ndarray
    """True mu_s, mu_c, r at the end, (3,) [-, -, m]."""
    time: np.ndarray
    """(T,) [s]."""
    wrenches: np.ndarray
    """Measured f_x, f_y, f_n, tau at the centre of pressure, (T, 2, 4) [N, N, N, N m]."""
    twists: np.ndarray
    """Measured v_x, v_y, omega there, (T, 2, 3) [m/s, m/s, rad/s]."""
    slip: np.ndarray
    """True slip displacement x, y, theta, (T, 3) [m, m, rad]."""
    slip_twist: np.ndarray
    """True slip velocity at the pad centre at the sample's instant, (T, 3) [m/s, m/s, rad/s]."""
    dropped: bool
    """Whether the object was lost."""
    friction: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    """True mu_s, mu_c, r at the sample's instant, (T, 3) [-, -, m]."""
    centres: np.ndarray = field(default_factory=lambda: np.zeros((0, 2, 2)))
    """True centres of pressure then, from the pad's centre, (T, 2, 2) [m]."""


class RecordKeeper:
    """Collects a record from a simulation, sample by sample.

    Args:
        simulation: Just reset.
    """

    def __init__(self, simulation: Simulation) -> None:
        self.simulation = simulation
        self._samples: list[tuple[Any, ...]] = []

    def take(self) -> None:
        """Keeps the newest sample."""
        simulation, world = self.simulation, self.simulation.plant.world[0]
        arrays = simulation.wrenches[0], simulation.twists[0], world["slip"], world["slip_twist"]
        truth = simulation.true_friction[0], simulation.plant.pads["pressure_centre"][0]
        self._samples.append((simulation.time, *(array.copy() for array in (*arrays, *truth))))

    def finish(self, keys: Mapping[str, Any]) -> Record:
        """The whole record.

        Args:
            keys: What distinguishes the trial from the others.
        """
        *columns, friction, centres = map(np.array, zip(*self._samples, strict=True))
        dropped = bool(self.simulation.episode["dropped"][0])
        truth = self.simulation.true_friction[0].copy()
        return Record(keys, truth, *columns, dropped=dropped, friction=friction, centres=centres)
