"""Plays a vector environment with random forces, in timed blocks."""

from __future__ import annotations

from time import perf_counter
from typing import Any

import gymnasium as gym
import numpy as np

from slipgym.config.hardware import GripperConfig
from slipgym.envs.vector_env import SlipVectorEnv

SLIP_LIMIT = 1.0, 4.0
"""Commanded forces of the headline workload, about the slip limit [N]."""
STEPS = 4000
"""Steps of all environments together in a timed block, at least `TURNS` vector steps."""
TURNS = 16


def action_bounds(gripper: GripperConfig, forces: tuple[float, float]) -> tuple[float, float]:
    """Actions of the mode "grip_force" for the bounds of a range of forces [N]."""
    low, high = gripper.force_min, gripper.force_max
    least, most = (min(max(2.0 * (force - low) / (high - low) - 1.0, -1.0), 1.0) for force in forces)
    return least, most


class VectorPlayer:
    """Plays a vector environment with a random commanded force for each environment and step.

    Args:
        env_id: Id of the environment.
        n: Environments.
        forces: Bounds of the commanded forces [N], within those of the gripper.
        **arguments: Of the batch.
    """

    def __init__(
        self, env_id: str, n: int, forces: tuple[float, float] = SLIP_LIMIT, **arguments: Any
    ) -> None:
        env = gym.make_vec(env_id, num_envs=n, **arguments).unwrapped
        assert isinstance(env, SlipVectorEnv)
        self.env, self.n, self.actions = env, n, action_bounds(env.config.gripper, forces)
        self._rng = np.random.default_rng(0)
        self.env.reset(seed=0)
        self._scatter()

    def block(self, steps: int = STEPS) -> tuple[float, int]:
        """Time of some vector steps [s], with the resets in them, and the environment steps."""
        turns = max(TURNS, steps // self.n)
        actions = self._rng.uniform(*self.actions, (turns, self.n, 1)).astype(np.float32)
        start = perf_counter()
        for action in actions:
            self.env.step(action)
        return perf_counter() - start, turns * self.n

    def _scatter(self) -> None:
        """Spread the episodes' ends evenly over time, as they are after a while: their steps differ."""
        episode = self.env.simulation.episode
        episode["step"] = np.arange(self.n) * episode["steps"] // self.n
