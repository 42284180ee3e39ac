"""`Trace`, the signals of a bench run with one row per control step."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np


@dataclass(frozen=True)
class Trace:
    """Signals of a run in world coordinates (x, z, angle) unless they say otherwise."""

    time: np.ndarray
    """Since the reset (n,) [s]."""
    position: np.ndarray
    """Engine's pose of the object's centre of mass (n, 3) [m, m, rad]."""
    velocity: np.ndarray
    """Engine's velocity of it, mean over the last engine step (n, 3) [m/s, m/s, rad/s]."""
    slip: np.ndarray
    """Slip displacement at the pad centre, pad frame (n, 3) [m, m, rad]."""
    twist: np.ndarray
    """Slip twist at the pad centre over the last sub-step, pad frame (n, 3) [m/s, m/s, rad/s]."""
    wrist: np.ndarray
    """Engine's wrist joints (n, 3) [m, m, rad]."""
    wrist_plan: np.ndarray
    """Wrist as commanded (n, 3) [m, m, rad]."""
    normal: np.ndarray
    """Engine's normal force of either finger (n, 2) [N]."""
    force: np.ndarray
    """Actuator force of either finger (n, 2) [N]."""
    load: np.ndarray
    """Load on the centre of mass during the step (n, 3) [N, N, N m]."""

    @classmethod
    def of(cls, rows: Sequence[tuple[Any, ...]]) -> Self:
        """Stack rows that hold the fields in order."""
        return cls(*(np.array(column) for column in zip(*rows, strict=True)))
