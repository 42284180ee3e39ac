"""Records the quantities of an episode that the plots show."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from slipgym.tasks.motion import Motion

if TYPE_CHECKING:
    from slipgym.envs.simulation import Simulation

_FRICTIONS = "mu_c", "mu_s", "true_mu_c", "true_mu_s", "data_mu_c", "data_mu_s", "sd_mu_c", "sd_mu_s"
COLUMNS = "grip_1", "grip_2", "path", "reference", *_FRICTIONS
"""Quantities of a row [N, N, mm or degrees, mm or degrees, -, ...]; estimates without data are NaN. `data_*`
counts the samples and events behind an estimate, of both fingers; `sd_*` is its deviation."""


class History:
    """Table with a row for each control step of an episode; NaN for steps that were not recorded.

    The environment with this row of the simulation was just reset; the motion defines path and reference.
    """

    def __init__(self, simulation: Simulation, row: int, motion: Motion) -> None:
        self._simulation, self._row, self._motion = simulation, row, motion
        self.rows = np.full((int(simulation.episode["steps"][row]) + 1, len(COLUMNS)), math.nan)
        self.step_time = float(simulation.episode["step_time"][row])
        self.keep()

    @property
    def step(self) -> int:
        """Control steps since the start."""
        return int(self._simulation.episode["step"][self._row])

    @property
    def time(self) -> float:
        """Time since the start [s]."""
        return self.step * self.step_time

    @property
    def times(self) -> np.ndarray:
        """Time of each row, (n,) [s]."""
        return self.step_time * np.arange(len(self.rows))

    def column(self, name: str) -> np.ndarray:
        """One quantity up to now, (step + 1,)."""
        return self.rows[: self.step + 1, COLUMNS.index(name)]

    def keep(self) -> None:
        """Record the present values."""
        simulation, i = self._simulation, self._row
        mu_s, mu_c, _, confidence_s, confidence_c = simulation.estimated[i, :5]
        reference = simulation.episode["reference"][i, self._motion.entry]
        if self.step >= len(self.rows):  # somebody steps on beyond the end of the episode
            self.rows = np.concatenate([self.rows, np.full_like(self.rows, math.nan)])
        row = self.rows[self.step]
        row[:2] = simulation.plant.fingers["force"][i]
        row[2] = self._motion.path(simulation.plant.world["slip"][i])
        row[3] = self._motion.target(reference)
        row[4] = mu_c if confidence_c > 0.0 else math.nan
        row[5] = mu_s if confidence_s > 0.0 else math.nan
        row[7], row[6] = simulation.ground_truth[i, :2]
        if simulation.estimating:
            row[11], row[10] = simulation.estimated[i, 6:8]
            fingers = simulation.estimator.estimates[2 * i : 2 * i + 2]
            row[8], row[9] = fingers["updates_mu_c"].sum(), fingers["events_mu_s"].sum()
