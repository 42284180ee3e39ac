"""Runs episodes of one policy in the environment that it is for, and stores them as a Minari dataset."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing, contextmanager
from importlib import import_module
from typing import Any, NamedTuple

import gymnasium as gym
from tqdm import tqdm

import policies
from policies.learned import LearnedPolicy
from policies.registry import Policy
from policies.stepping import environment_for, own_arguments, steps
from policies.training import seeds
from slipgym.tasks import find

FRESH = 1_000_000
"""Number of the first held-out seed here."""


class Outcome(NamedTuple):
    """Outcome of an episode, with the sum of its rewards and the time of its end [s]."""

    success: bool
    dropped: bool
    reward: float
    time: float


def environment_of(which: str, policy: Policy, task: str | None) -> tuple[str, dict[str, Any]]:
    """The environment that a policy is for; `which` it was loaded by is for the message of an error.

    Returns:
        Id and keyword arguments: those of its training, or what a controller of a task asks for.

    Raises:
        ValueError: No task is known, or another one is asked for.
    """
    own: str | None = getattr(policy, "task", None)
    if isinstance(policy, LearnedPolicy):
        trained = policy.description.environment
        if task is not None and find(task).id != trained.id:
            raise ValueError(f"task = {task!r}: the policy {which!r} was trained in {trained.id}")
        return trained.id, dict(trained.arguments)
    if task is None and own is None:
        raise ValueError(f"the policy {which!r} serves every task: name a task")
    env_id = find(task or own or "").id
    if own is not None and env_id != find(own).id:
        raise ValueError(f"task = {task!r}: the policy {which!r} is for {own}")
    return env_id, policies.modes(policy)


@contextmanager
def opened(
    which: str | os.PathLike[str], task: str | None = None, changes: Mapping[str, Any] | None = None
) -> Iterator[tuple[Policy, gym.Env]]:
    """Opens a policy and the environment that it is for; arguments and errors as for `episodes`."""
    if task is not None:
        find(task)  # first of all: one of your own registers itself
    policy = policies.load(which)
    env_id, _ = environment_of(os.fspath(which), policy, task)
    arguments = own_arguments(policy, env_id, changes or {})
    policies.check_estimates(os.fspath(which), policy, arguments)
    with environment_for(policy, env_id, **arguments) as env:
        yield policy, env


def episodes(
    which: str | os.PathLike[str],
    count: int,
    first: int = FRESH,
    task: str | None = None,
    changes: Mapping[str, Any] | None = None,
) -> Iterator[Outcome]:
    """Runs episodes of a policy without exploration.

    Args:
        which: As `policies.load` takes it.
        count: How many.
        first: Number of the first held-out seed; see `policies.training.seeds`. The default is beyond those
            that a training chooses its best policy by.
        task: Needed for a controller that serves every task.
        changes: Keyword arguments of the environment instead of those of the training.

    Raises:
        FileNotFoundError: There is no policy at the path.
        ValueError: A name or value is wrong, or the environment is not one the policy can act in.
    """
    with opened(which, task, changes) as (policy, env):
        yield from played(policy, env, count, first)


def played(policy: Policy, env: gym.Env, count: int, first: int = FRESH) -> Iterator[Outcome]:
    """Runs episodes of what `opened` gives, as `episodes` does."""
    for number in range(first, first + count):
        observation, info = env.reset(seed=seeds.held_out(number))
        total = 0.0
        for step in steps(env, policy, observation):
            total, info = total + float(step.reward), step.info
        yield Outcome(info["is_success"], info["dropped"], total, info["time"])


def outcome(which: str, found: Sequence[Outcome]) -> str:
    """Outcome of episodes from `episodes`, at least one, in a line that begins with the policy's name."""
    n = len(found)
    solved, dropped = sum(one.success for one in found), sum(one.dropped for one in found)
    reward, time = (sum(getattr(one, name) for one in found) / n for name in ("reward", "time"))
    return (
        f"{which}: solved {solved} of {n}, dropped {dropped}; means: reward {reward:.2f}, time {time:.2f} s"
    )


class Stored(NamedTuple):
    """Content of a dataset."""

    episodes: int
    steps: int
    solved: int


def demonstrate(
    which: str | os.PathLike[str],
    dataset: str,
    count: int,
    first: int = 0,
    task: str | None = None,
    changes: Mapping[str, Any] | None = None,
) -> Stored:
    """Plays episodes of a policy and stores them as a dataset; nothing is stored before the last one is over.

    Policy, task and changes are as for `policies.evaluation.one_policy.episodes`; the dataset has a name
    such as "hold/controller-v0"; of the `count` episodes, at least 1, number i has the seed `first` + i.

    Raises:
        ModuleNotFoundError: Minari is not installed.
        FileExistsError: There is a dataset of that name.
        FileNotFoundError, ValueError: As for `episodes`.
    """
    minari: Any = import_module("minari")
    import_module("minari.dataset.minari_dataset").parse_dataset_id(dataset)
    if dataset in minari.list_local_datasets():
        raise FileExistsError(f"there is a dataset {dataset!r}: minari delete {dataset} removes it")
    solved, collector = 0, minari.DataCollector
    with (
        opened(which, task, changes) as (policy, inner),
        closing(collector(inner, record_infos=False)) as env,
    ):
        for seed in tqdm(range(first, first + count), disable=None, leave=False):
            observation, info = env.reset(seed=seed)
            for step in steps(env, policy, observation):
                info = step.info
            solved += bool(info["is_success"])
        made = env.create_dataset(
            dataset,
            eval_env=inner.spec,
            algorithm_name=os.fspath(which),
            author="slipgym",
            author_email="none",
            code_permalink="none",
            description=f"{solved} of {count} episodes solved, seeds from {first} on",
        )
    return Stored(int(made.total_episodes), int(made.total_steps), solved)
