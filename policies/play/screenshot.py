"""One picture of each environment, with its own controller at work."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.envs.registration import parse_env_id
from PIL import Image

import policies
from slipgym.registration import ENVIRONMENTS
from slipgym.tasks import TASKS, find

_SHARE = 0.62  # of the episode, after which the picture is taken


def own_policy(task: str) -> str:
    """The policy named like a task's group in the configuration; a constant force if there is none.

    Args:
        task: As `slipgym.tasks.find` takes it.
    """
    key = find(task).key
    return key if key in policies.names() else "constant_force"


def portrait(env_id: str, material: str, seed: int = 0) -> np.ndarray:
    """A picture from the middle of an episode.

    Args:
        env_id: Id of an environment.
        material: Name of a material.
        seed: Of the environment.

    Returns:
        (480, 720, 3) uint8.
    """
    policy = policies.make(own_policy(parse_env_id(env_id)[1]))
    modes = policies.modes(policy)
    env: Any = gym.make(env_id, render_mode="rgb_array", material=material, **modes).unwrapped
    try:
        observation, _ = env.reset(seed=seed)
        state, over = None, False
        steps = int(env.simulation.episode["steps"][0])
        while not over and env.simulation.episode["step"][0] < _SHARE * steps:
            action, state = policy.predict(observation, state=state)
            observation, _, terminated, truncated, _ = env.step(action)
            over = terminated or truncated
        return env.render()
    finally:
        env.close()


def write_portraits(folder: Path, seed: int = 0) -> Iterator[Path]:
    """Writes <task's key>.png for every registered environment, each with another material.

    Args:
        folder: Where to.
        seed: Of the environments.
    """
    folder.mkdir(parents=True, exist_ok=True)
    materials = ("wood", "plastic", "case", "cardboard")
    for number, env_id in enumerate(ENVIRONMENTS):
        picture = portrait(env_id, materials[number % len(materials)], seed)
        key = TASKS[env_id.removeprefix("slipgym/").rpartition("-")[0]].key
        partial, path = folder / f".{key}.partial", folder / f"{key}.png"
        Image.fromarray(picture).save(partial, format="PNG", optimize=True)
        partial.replace(path)
        yield path
