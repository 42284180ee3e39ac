"""Runs trials, one or many."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import gymnasium as gym
import joblib
import numpy as np
from tqdm import tqdm

import policies
from policies.base import ObservationIndex
from policies.evaluation.experiment import Experiment
from policies.evaluation.metrics import MEASURES, measure
from policies.evaluation.plan import Trial
from policies.evaluation.recording import Recorder, Recording
from slipgym.tasks import TASKS


@dataclass(frozen=True)
class Result:
    """Outcome of a trial."""

    row: dict[str, Any]
    """Its row of the table of trials."""
    series: dict[str, np.ndarray] | None
    """Its steps as columns; kept of the first trial in each cell."""


def run_trials(
    experiment: Experiment, trials: Sequence[Trial], jobs: int = 1, progress: bool = True
) -> list[Result]:
    """Runs trials in parallel; the results do not depend on how many run at once.

    Args:
        experiment: What they are part of.
        trials: From `plan`.
        jobs: Processes; -1 for one per core.
        progress: Whether to show a progress bar.

    Raises:
        ValueError: A policy refuses its parameters or the observations.
    """
    parallel = joblib.Parallel(n_jobs=jobs, return_as="generator")
    results: Any = parallel(joblib.delayed(run_trial)(experiment, trial) for trial in trials)
    return list(tqdm(results, total=len(trials), desc=experiment.name, unit="trial", disable=not progress))


def run_trial(experiment: Experiment, trial: Trial) -> Result:
    """Runs one trial in an environment of its own.

    Raises:
        ValueError: The policy refuses its parameters or the observations.
    """
    try:
        recording = record(experiment, trial)
    except Exception as error:
        error.add_note(f"in trial {trial.keys}")
        raise
    options, task = TASKS[experiment.task].options.parse(trial.options), _task(experiment)
    limits = {
        limit.column: limit.scale * options.choose(limit.option, task)
        for limit in MEASURES[experiment.task].tolerances
    }
    drawn = {f"drawn_{name}": value for name, value in recording.drawn.items()}
    row = {**trial.keys, **limits, **measure(recording, experiment.task), **drawn}
    return Result(row, recording.series() if trial.number == 0 else None)


def record(experiment: Experiment, trial: Trial) -> Recording:
    """Runs an episode and keeps its steps."""
    parameters = dict(trial.policy.parameters)
    if experiment.config:
        parameters.setdefault("config", dict(experiment.config))
    policy = policies.make(trial.policy.name, **parameters)
    env = gym.make(
        f"slipgym:slipgym/{experiment.task}-v0",
        friction_source=trial.friction.source,
        estimator=dict(trial.friction.estimator),
        sensors=experiment.sensors,
        material=trial.material,
        randomization=experiment.randomization,
        action_mode=policy.action_mode,
        config=dict(experiment.config),
        disable_env_checker=True,
    )
    index = ObservationIndex(experiment.task, experiment.environment_config(), policy.action_mode)
    recorder = Recorder(index)
    try:
        observation, info = env.reset(seed=trial.seed, options=dict(trial.options))
        recorder.begin(info)
        state, over = None, False
        while not over:
            action, state = policy.predict(observation, state=state)
            observation, reward, terminated, truncated, info = env.step(action)
            recorder.add(observation, float(reward), info)
            over = terminated or truncated
    finally:
        env.close()
    return recorder.finish()


def _task(experiment: Experiment) -> Any:
    return getattr(experiment.environment_config().tasks, TASKS[experiment.task].key)
