"""Records what the plots of the viewer show: a row for every few control steps of an episode."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

RATE = 30
"""Rows per second of simulation."""
COLUMNS = (
    "time",
    "mu_c",
    "mu_c_low",
    "mu_c_high",
    "mu_s",
    "mu_s_low",
    "mu_s_high",
    "true_mu_c",
    "true_mu_s",
    "grip_1",
    "grip_2",
    "path",
    "reference",
)
"""Quantities of a row [s, -, ..., N, N, mm or degrees, mm or degrees]; estimates without data are NaN."""
_KNOWN = 10.0  # deviations from here on mean that nothing is known


class History:
    """Rows of an episode.

    Args:
        env: An environment that was just reset.
    """

    def __init__(self, env: Any) -> None:
        self._env, self._motion = env, env.task.motion
        self._rows: list[list[float]] = []
        self._every = max(1, round(env.config.physics.control_rate / RATE))
        self.keep()

    def keep(self) -> None:
        """Append the present values, if a row is due."""
        simulation = self._env.simulation
        episode = simulation.episode[0]
        if int(episode["step"]) < len(self._rows) * self._every:
            return
        mu_s, mu_c, _, confidence_s, confidence_c, _, sd_s, sd_c = simulation.estimated[0, :8].tolist()
        mu_c = mu_c if confidence_c > 0.0 else math.nan
        mu_s = mu_s if confidence_s > 0.0 else math.nan
        sd_c, sd_s = (sd if sd < _KNOWN else math.nan for sd in (sd_c, sd_s))
        true_s, true_c = simulation.ground_truth[0, :2].tolist()
        grips = simulation.plant.fingers["force"][0].tolist()
        path = float(self._motion.path(simulation.plant.world["slip"][0]))
        target = float(self._motion.target(episode["reference"][self._motion.entry]))
        low_c, low_s = max(mu_c - sd_c, 0.0), max(mu_s - sd_s, 0.0)
        estimates = mu_c, low_c, mu_c + sd_c, mu_s, low_s, mu_s + sd_s
        self._rows.append([simulation.time, *estimates, true_c, true_s, *grips, path, target])

    def columns(self, *names: str) -> tuple[np.ndarray, ...]:
        """Some quantities, each (n,).

        Args:
            *names: Of `COLUMNS`.
        """
        table = np.array(self._rows)
        return tuple(table[:, COLUMNS.index(name)].copy() for name in names)
