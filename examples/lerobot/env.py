"""Makes the nine tasks for LeRobot: the one file that a repository of EnvHub on the Hugging Face Hub needs.

from lerobot.envs.factory import make_env
suites = make_env("OWNER/REPOSITORY", n_envs=8, trust_remote_code=True)
"""

from __future__ import annotations

from functools import partial
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import AsyncVectorEnv, AutoresetMode, SyncVectorEnv, VectorEnv

from slipgym.registration import ENVIRONMENTS

TASKS = tuple(ENVIRONMENTS)
"""Ids of the tasks; a task's place is its number in the suite."""


class AgentState(gym.ObservationWrapper):
    """Observations by LeRobot's name, `agent_pos`, and what its evaluation asks an environment for."""

    def __init__(self, env: gym.Env) -> None:
        super().__init__(env)
        self.observation_space = gym.spaces.Dict({"agent_pos": env.observation_space})
        settings: Any = env.unwrapped
        self._max_episode_steps = settings.spec.max_episode_steps
        self.task = self.task_description = str(settings.spec.id)

    def observation(self, observation: np.ndarray) -> dict[str, np.ndarray]:
        """The vector under its name."""
        return {"agent_pos": observation}


def make_one(task: str) -> gym.Env:
    """An environment of a task on the planar engine, with pictures and the estimates of friction."""
    return AgentState(gym.make(f"slipgym:{task}", engine="planar", render_mode="rgb_array"))


def make_env(
    n_envs: int = 1, use_async_envs: bool = False, cfg: Any = None
) -> dict[str, dict[int, VectorEnv]]:
    """Makes every task.

    Args:
        n_envs: Environments of each task.
        use_async_envs: Whether each has a process of its own.
        cfg: LeRobot's EnvConfig, of which nothing is used.

    Raises:
        ValueError: `n_envs` is below 1.
    """
    if n_envs < 1:
        raise ValueError(f"n_envs = {n_envs} must be at least 1")
    vector = AsyncVectorEnv if use_async_envs else SyncVectorEnv
    return {
        "slipgym": {
            number: vector([partial(make_one, task)] * n_envs, autoreset_mode=AutoresetMode.SAME_STEP)
            for number, task in enumerate(TASKS)
        }
    }
