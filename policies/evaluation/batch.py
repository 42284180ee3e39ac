"""Runs trials as rows of vector environments, on the planar engine."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import closing
from itertools import groupby
from typing import Any

import gymnasium as gym
import numpy as np

import policies
from policies.controllers.base import ForcePolicy
from policies.controllers.no_friction_info import NoFrictionInfo
from policies.controllers.slip_memory import SlipMemory
from policies.evaluation.experiment import Experiment
from policies.evaluation.plan import Trial
from policies.evaluation.recording import Recorder, Recording
from policies.learned import LearnedPolicy
from policies.stepping import batch_steps
from slipgym.tasks import find

ROWS = 256
"""Most trials in one vector environment."""


def blocks(trials: Sequence[Trial]) -> list[tuple[Trial, ...]]:
    """Trials that can run in one vector environment: of one policy and friction choice, at most ROWS."""
    alike = groupby(trials, lambda trial: (trial.policy.model_dump_json(), trial.friction.model_dump_json()))
    found = (tuple(group) for _, group in alike)
    return [group[first : first + ROWS] for group in found for first in range(0, len(group), ROWS)]


def acts_on_batches(policy: Any) -> bool:
    """Whether a policy is known to keep all its memory in its state, row by row."""
    return isinstance(policy, ForcePolicy | NoFrictionInfo | SlipMemory | LearnedPolicy)


def record_block(
    experiment: Experiment, trials: Sequence[Trial], policy: policies.Policy, keywords: Mapping[str, Any]
) -> list[Recording]:
    """Runs trials of one policy and friction choice side by side, and keeps their steps.

    Each episode is that of a single environment with the trial's seed and options on the planar engine, bit
    for bit if the policy's actions are; those of a learned policy differ by rounding. The keywords are of a
    single environment of these trials, one of `blocks`.
    """
    given = {**keywords, **policies.modes(policy)}
    given = {name: value for name, value in given.items() if name not in ("engine", "material")}
    env_id = f"slipgym:{find(experiment.task).id}"
    made: Any = gym.make_vec(env_id, len(trials), "vector_entry_point", **given)
    with closing(made.unwrapped) as envs:
        if isinstance(policy, LearnedPolicy):
            policy.check(envs)
        options = {"rows": [row_options(trial) for trial in trials]}
        observations, infos = envs.reset(seed=[trial.seed for trial in trials], options=options)
        recorder = Recorder([column.name for column in envs.columns], drawn(infos, len(trials)))
        for step in batch_steps(envs, policy, observations):
            newest = present(step.observations, len(envs.columns))
            recorder.add(newest, step.rewards, step.infos, step.running)
    return recorder.finish()


def present(observations: Any, columns: int) -> np.ndarray:
    """The newest of the observations that a policy saw, (..., columns), without privileged ones."""
    seen = observations["policy"] if isinstance(observations, Mapping) else observations
    return seen[..., -columns:]


def row_options(trial: Trial) -> dict[str, Any]:
    """Options of reset of a trial's row; a material that is drawn at random is left out."""
    return {**trial.options, **({} if trial.material == "random" else {"material": trial.material})}


def drawn(infos: Mapping[str, Any], n: int) -> list[dict[str, Any]]:
    """Values that the randomization drew for each of n environments, as in the info of a single one."""
    found = infos.get("drawn", {})
    names = [name for name in found if not name.startswith("_")]
    return [{name: _plain(found[name][i]) for name in names if found[f"_{name}"][i]} for i in range(n)]


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value
