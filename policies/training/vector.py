"""The environments of a run: the only place that knows how they are made and stepped."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
from stable_baselines3.common.vec_env import DummyVecEnv, SubprocVecEnv, VecEnv, VecMonitor

from policies.training.adapter import SlipVecEnv, make_vec_env
from policies.training.config import Training


def make(config: Training, seed: int, num_envs: int | None = None) -> VecEnv:
    """The environments of a run.

    Args:
        config: The run.
        seed: Of the first environment; environment i is seeded `seed` + i at the first reset.
        num_envs: How many; None: as many as the run trains in.
    """
    keywords = config.environment.model_dump()
    count = config.num_envs if num_envs is None else num_envs
    if config.engine == "planar":
        made = make_vec_env(_id(config), count, seed, config.engine_threads, **keywords)
        assert isinstance(made, VecMonitor)
        return made

    def one() -> gym.Env:
        return gym.make(_id(config), disable_env_checker=True, **keywords).unwrapped

    makers = [one] * count
    envs = SubprocVecEnv(makers) if config.processes else DummyVecEnv(makers)
    monitored = VecMonitor(envs)
    monitored.seed(seed)
    return monitored


def get_state(envs: VecMonitor) -> dict[str, Any]:
    """Everything that decides what the environments do next, as plain data."""
    states = envs.env_method("get_state")
    return {
        "envs": states[:1] if _is_batch(envs) else states,
        "returns": envs.episode_returns.copy(),
        "lengths": envs.episode_lengths.copy(),
    }


def set_state(envs: VecMonitor, state: dict[str, Any]) -> None:
    """Go on from a state.

    Raises:
        ValueError: It is of other environments.
    """
    for index, one in enumerate(state["envs"]):
        envs.env_method("set_state", one, indices=None if _is_batch(envs) else index)
    envs.episode_returns, envs.episode_lengths = state["returns"].copy(), state["lengths"].copy()


def _is_batch(envs: VecMonitor) -> bool:
    """Whether one state is that of all environments."""
    return isinstance(envs.venv, SlipVecEnv)


def _id(config: Training) -> str:
    return f"slipgym:slipgym/{config.task}-v0"
