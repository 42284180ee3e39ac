"""What the strip shows of an episode so far."""

from __future__ import annotations

import math

import numpy as np

from slipgym.envs.loop import SlipLoop
from slipgym.tasks.motion import Motion

COLUMNS = ("grip_1", "grip_2", "path", "reference", "mu_c", "mu_s")


class History:
    """A row for each slip-velocity sample of an episode, from the start on; NaN where nothing was kept.

    Args:
        loop: The environment's loop, just reset.
        row: Which of its environments.
        motion: What path and reference are.
    """

    def __init__(self, loop: SlipLoop, row: int, motion: Motion) -> None:
        self._loop, self._row, self._motion = loop, row, motion
        self.rows = np.full((int(loop.episode["steps"][row]) + 1, len(COLUMNS)), math.nan)
        self.step_time = float(loop.episode["step_time"][row])
        self.keep()

    @property
    def step(self) -> int:
        """Samples since the start."""
        return int(self._loop.episode["step"][self._row])

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
        """Keep the present."""
        loop, i = self._loop, self._row
        mu_s, mu_c, _, support_s, support_c, _ = loop.estimated[i]
        slip, reference = loop.plant.world["slip"][i], loop.episode["reference"][i, self._motion.entry]
        row = self.rows[self.step]
        row[:2] = loop.plant.fingers["force"][i]
        row[2], row[3] = self._motion.path(slip), self._motion.target(reference)
        row[4] = mu_c if support_c > 0.0 else math.nan
        row[5] = mu_s if support_s > 0.0 else math.nan
