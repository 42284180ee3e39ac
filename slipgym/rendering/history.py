"""What the strip shows of an episode so far."""

from __future__ import annotations

import math

import numpy as np

from slipgym.envs.loop import SlipLoop
from slipgym.rendering.motion import Motion

COLUMNS = ("grip_1", "grip_2", "path", "reference", "mu_c", "mu_s")


class History:
    """A row for each slip-velocity sample of an episode, from the start on; NaN where nothing was kept.

    Args:
        loop: The environment's loop, just reset.
        motion: What path and reference are.
    """

    def __init__(self, loop: SlipLoop, motion: Motion) -> None:
        self._loop, self._motion = loop, motion
        self.rows = np.full((int(loop.episode["steps"][0]) + 1, len(COLUMNS)), math.nan)
        self.step_time = float(loop.episode["step_time"][0])
        self.keep()

    @property
    def step(self) -> int:
        """Samples since the start."""
        return int(self._loop.episode["step"][0])

    @property
    def times(self) -> np.ndarray:
        """Time of each row, (n,) [s]."""
        return self.step_time * np.arange(len(self.rows))

    def column(self, name: str) -> np.ndarray:
        """One quantity up to now, (step + 1,)."""
        return self.rows[: self.step + 1, COLUMNS.index(name)]

    def keep(self) -> None:
        """Keep the present."""
        loop = self._loop
        mu_s, mu_c, _, support_s, support_c, _ = loop.estimated[0]
        slip, reference = loop.plant.world["slip"][0], loop.episode["reference"][0, self._motion.axis]
        row = self.rows[self.step]
        row[:2] = loop.plant.fingers["force"][0]
        row[2], row[3] = self._motion.path(slip), self._motion.target(reference)
        row[4] = mu_c if support_c > 0.0 else math.nan
        row[5] = mu_s if support_s > 0.0 else math.nan
