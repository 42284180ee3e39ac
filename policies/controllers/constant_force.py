"""A policy that always grips with the same force."""

from __future__ import annotations

import numpy as np

from policies.controllers.base import Columns, ForcePolicy, State
from slipgym.config import Overrides


class ConstantForcePolicy(ForcePolicy):
    """Always the same grip force, in every task and whatever the observation says.

    Args:
        force: Grip force per finger [N]; None for the gripper's largest.
        config: Overrides of the environment's configuration.

    Raises:
        ValueError: The gripper cannot exert the force, or the configuration is not valid.
    """

    def __init__(self, force: float | None = None, config: Overrides | None = None) -> None:
        super().__init__(config)
        low, high = self.config.gripper.force_min, self.config.gripper.force_max
        self.force = high if force is None else float(force)
        if not low <= self.force <= high:
            raise ValueError(f"force = {force!r} must lie within the gripper's {low:g} to {high:g} N")

    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """The same force for each row, (n,) [N]."""
        return np.full(len(columns), self.force), state
