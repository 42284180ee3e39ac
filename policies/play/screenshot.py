"""Takes a screenshot of an environment while its own controller acts."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np

import policies
from policies.stepping import steps
from slipgym.tasks import find

_FRACTION = 0.62  # of the episode, after which the picture is taken


def own_policy(task: str) -> str:
    """The policy named like a task's group in the configuration; a constant force if there is none.

    Args:
        task: As `slipgym.tasks.find` takes it.
    """
    key = find(task).key
    return key if key in policies.names() else "constant_force"


def take_screenshot(env_id: str, material: str, seed: int = 0) -> np.ndarray:
    """A picture from the middle of an episode.

    Args:
        env_id: Id of an environment.
        material: Name of a material.
        seed: Of the environment.

    Returns:
        (480, 720, 3) uint8.
    """
    policy = policies.make(own_policy(env_id))
    modes = policies.modes(policy)
    env: Any = gym.make(env_id, render_mode="rgb_array", material=material, **modes).unwrapped
    try:
        observation, _ = env.reset(seed=seed)
        episode = env.simulation.episode[0]
        for _ in steps(env, policy, observation):
            if episode["step"] >= _FRACTION * episode["steps"]:
                break
        return env.render()
    finally:
        env.close()
