"""A policy that knows what no robot does: an upper bound of what others could solve."""

from __future__ import annotations

from typing import Any

import numpy as np

from slipgym.config import load
from slipgym.envs.privileged import PRIVILEGED

TASKS = ("hold", "fragile_hold")
"""Keys of the tasks that a constant grip solves, if it is the right one of the episode."""
MODES = {"observation_mode": "dict", "action_mode": "grip_force"}
_LEAST, _LIMIT = (
    [reading.name for reading in PRIVILEGED].index(name) for name in ("least_grip", "grip_limit")
)


class Oracle:
    """Grips with the geometric mean of the episode's least grip and its limit, firmly if it has none.

    Its observations are dicts.
    """

    def predict(
        self,
        observation: Any,
        state: None = None,
        episode_start: np.ndarray | None = None,
        deterministic: bool = True,
    ) -> tuple[np.ndarray, None]:
        """Actions (n, 1) for observations with the group "privileged", (n, m); the rest has no effect."""
        gripper = load().gripper
        least, limit = observation["privileged"][:, [_LEAST, _LIMIT]].T
        force = np.where(limit > 0.0, np.sqrt(least * limit), gripper.force_max)
        force = np.clip(force, gripper.force_min, gripper.force_max)
        share = (force - gripper.force_min) / (gripper.force_max - gripper.force_min)
        return (2.0 * share - 1.0)[:, None].astype(np.float32), None
