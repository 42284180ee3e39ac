"""Makes the environment that a policy is for, and steps it until the episode ends."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from typing import Any, NamedTuple

import gymnasium as gym
import numpy as np

from estimator.reference import is_reference
from estimator.suggestions import brief
from policies.learned import LearnedPolicy
from policies.registry import Policy, modes


def own_arguments(policy: Any, env_id: str, changes: Mapping[str, Any]) -> dict[str, Any]:
    """Keyword arguments of the environment that a policy is for, with changes in their place.

    Those of a learned policy are those of its training, if that was in this environment; of any other one,
    what it needs to act.

    Raises:
        ValueError: The training had an estimator that has to be imported, and the changes have none.
    """
    own = modes(policy)
    if isinstance(policy, LearnedPolicy) and policy.description.environment.id == env_id:
        own = dict(policy.description.environment.arguments)
    if "estimator" not in changes:
        _check_estimator(own.get("estimator"))
    return {**own, **changes}


def _check_estimator(choice: Any) -> None:
    """Refuse what a file has to be imported for: only who runs it may ask for that."""
    name = choice.get("name") if isinstance(choice, Mapping) else choice
    if is_reference(name):
        raise ValueError(
            f"the estimator {name!r} of its policy.json is not imported unasked; give an estimator as an "
            "argument of the environment"
        )


def make_for(policy: Any, env_id: str, **arguments: Any) -> gym.Env:
    """Makes an environment that a policy, or a class of policies, can act in.

    Args:
        policy: Who acts.
        env_id: Id of the environment.
        **arguments: Of the environment.

    Raises:
        ValueError: An argument is wrong, or a learned policy was trained for another environment.
    """
    env = gym.make(f"slipgym:{env_id}", disable_env_checker=True, **arguments)
    try:
        if isinstance(policy, LearnedPolicy):
            policy.check(env)
    except BaseException:
        env.close()
        raise
    return env


@contextmanager
def environment_for(policy: Policy, env_id: str, **arguments: Any) -> Iterator[gym.Env]:
    """Makes an environment as `make_for` does, and closes it at the end of the `with` block."""
    with closing(make_for(policy, env_id, **arguments)) as env:
        yield env


class Step(NamedTuple):
    """Values that `env.step` returned."""

    observation: Any  # that after the step: an array, or a mapping of groups
    reward: float  # reward of the step
    terminated: bool  # whether the task ended the episode
    truncated: bool  # whether its time was over
    info: Mapping[str, Any]  # see `slipgym.envs.infos`

    @property
    def over(self) -> bool:
        """Whether the episode ended."""
        return self.terminated or self.truncated


def steps(env: Any, policy: Policy, observation: Any) -> Iterator[Step]:
    """Acts with a policy, without exploration, until the episode ends.

    Each step is yielded before the policy acts on it; who stops asking stops the episode.

    Args:
        env: A Gymnasium environment that was just reset.
        policy: Who acts; its memory starts fresh.
        observation: What `reset` returned.
    """
    state, over = None, False
    while not over:
        action, state = _acted(policy, policy.predict(observation, state=state))
        step = Step(*env.step(action))
        observation, over = step.observation, step.over
        yield step


def _acted(policy: Policy, given: Any) -> tuple[Any, Any]:
    """What `predict` returned, checked."""
    if isinstance(given, tuple) and len(given) == 2:
        return given
    raise TypeError(
        f"{type(policy).__name__}.predict must return the action and the next state, got {brief(repr(given))}"
    )


class BatchStep(NamedTuple):
    """Values that the `step` of a vector environment returned; arrays have a leading axis of n."""

    observations: Any  # those after the step: an array, or a mapping of groups
    rewards: np.ndarray  # rewards of the step, (n,)
    infos: Mapping[str, Any]  # see `slipgym.envs.infos`
    running: np.ndarray  # whether the first episode of each was running before the step, (n,) bool
    ended: np.ndarray  # whether it ended with the step, (n,) bool


def batch_steps(envs: Any, policy: Policy, observations: Any) -> Iterator[BatchStep]:
    """Acts with a policy, without exploration, until the first episode of every environment has ended.

    Args:
        envs: A `SlipVectorEnv` that was just reset, which begins the next episodes by itself.
        policy: Who acts; its memory starts fresh.
        observations: What `reset` returned.
    """
    state, begun = None, np.ones(envs.num_envs, dtype=bool)
    running = np.ones(envs.num_envs, dtype=bool)
    while running.any():
        actions, state = _acted(policy, policy.predict(observations, state, begun))
        observations, rewards, terminated, truncated, infos = envs.step(actions)
        ended = running & (terminated | truncated)
        yield BatchStep(observations, rewards, infos, running, ended)
        running = running & ~ended
        begun = np.zeros(envs.num_envs, dtype=bool)
