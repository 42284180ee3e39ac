"""The environments of a run: the only place that knows how they are made and stepped."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import gymnasium as gym
from stable_baselines3.common.vec_env import DummyVecEnv, SubprocVecEnv, VecEnv, VecMonitor

from estimator.reference import is_reference
from policies.training.adapter import SlipVecEnv, TaskEnd, make_vec_env
from policies.training.config import Training
from policies.training.derived import DerivedVecEnv
from policies.training.state_checks import check_like
from slipgym.tasks import find


class Scenario(TaskEnd):
    """An environment whose episodes all have some options, and terminate at their full length.

    Options of a single reset come on top.
    """

    def __init__(self, env: gym.Env, options: Mapping[str, Any]) -> None:
        super().__init__(env)
        self._fixed = dict(options)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """See `gymnasium.Env.reset`."""
        return self.env.reset(seed=seed, options={**self._fixed, **(options or {})})


def make(config: Training, seed: int, num_envs: int | None = None, shaped: bool = False) -> VecEnv:
    """The environments of a run, or those it learns in (`shaped`); at first environment i has `seed` + i."""
    keywords = (config.shaped if shaped else config.environment).model_dump()
    privileged = config.algorithm == "privileged_ppo"
    if privileged:
        shown = config.environment.observation_mode
        keywords["observation_mode"] = "dict" if shown == "flat" else f"{shown}_dict"
    count = config.num_envs if num_envs is None else num_envs
    combinations = config.combinations()
    envs: VecEnv
    if config.engine == "planar":
        envs = make_vec_env(
            config.task,
            count,
            seed,
            config.engine_threads,
            scenarios=[combinations[i % len(combinations)] for i in range(count)] if config.vary else None,
            spread=config.spread and shaped,
            privileged=privileged,
            **keywords,
        )
    else:
        envs = scalar(config.task, count, combinations, config.processes, **keywords)
        envs.seed(seed)
    if config.derived and not privileged:
        envs = DerivedVecEnv(envs, config.derived, config.environment.history)
    return envs


def scalar(
    task: str, count: int, combinations: Sequence[Mapping[str, Any]], processes: bool, **keywords: Any
) -> VecMonitor:
    """Scalar environments side by side, maybe each in its own process.

    Environment i has combination i modulo their number of options of reset.
    """
    env_id = _id(task)

    def one(options: Mapping[str, Any]) -> gym.Env:
        return Scenario(gym.make(env_id, disable_env_checker=True, **keywords).unwrapped, options)

    makers = [partial(one, combinations[i % len(combinations)]) for i in range(count)]
    return VecMonitor(SubprocVecEnv(makers) if processes else DummyVecEnv(makers))


def get_state(envs: Any) -> dict[str, Any]:
    """Everything that decides what the environments do next, as plain data."""
    return {
        "envs": envs.env_method("get_state")[: _states(envs)],
        "returns": envs.episode_returns.copy(),
        "lengths": envs.episode_lengths.copy(),
    }


def set_state(envs: Any, state: dict[str, Any]) -> None:
    """Go on from a state.

    Raises:
        ValueError: It is of other environments.
    """
    envs = envs.venv if isinstance(envs, DerivedVecEnv) else envs
    own = {"returns": envs.episode_returns, "lengths": envs.episode_lengths}
    check_like("environments", {name: state[name] for name in own}, own)
    if len(state["envs"]) != _states(envs):
        raise ValueError(f"environments.envs holds {len(state['envs'])} states")
    for index, one in enumerate(state["envs"]):
        envs.env_method("set_state", one, indices=index if _states(envs) == envs.num_envs else None)
    envs.episode_returns, envs.episode_lengths = state["returns"].copy(), state["lengths"].copy()


def _states(envs: VecEnv) -> int:
    """How many states environments have: a batch has one."""
    return 1 if isinstance(envs.unwrapped, SlipVecEnv) else envs.num_envs


def _id(task: str) -> str:
    """The id of a task's environment, with the module that registers it."""
    return f"{task.partition(':')[0] if is_reference(task) else 'slipgym'}:{find(task).id}"
