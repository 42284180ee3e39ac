"""Runs trials: each alone, or on the planar engine as rows of a vector environment."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager
from typing import Any, NamedTuple

import gymnasium as gym
import numpy as np
from tqdm import tqdm

import policies
from policies import parallel
from policies.controllers.base import ForcePolicy
from policies.controllers.no_friction_info import NoFrictionInfo
from policies.controllers.rate import at_rate
from policies.controllers.slip_memory import SlipMemory
from policies.evaluation.experiment import Experiment
from policies.evaluation.metrics import measure, measures
from policies.evaluation.plan import Trial, pieces, plan
from policies.evaluation.recording import INFOS, Recorder, Recording
from policies.learned import LearnedPolicy
from policies.stepping import batch_steps, environment_for, steps
from slipgym.tasks import find


class Result(NamedTuple):
    """Outcome of a trial."""

    row: dict[str, Any]
    """Its row of the table of trials."""
    series: dict[str, np.ndarray] | None
    """Its steps as columns; kept of the first trial in each cell."""


def check(experiment: Experiment) -> None:
    """Begins the first trial of every cell: what cannot run is refused before any trial has.

    A policy that comes with slipgym acts once. One of your own does not: its errors need their traceback.

    Raises:
        ValueError: A policy refuses its parameters or the observations, or options contradict each other.
    """
    task = find(experiment.task)
    for trial in (trial for trial in plan(experiment) if not trial.number):
        try:
            policy = make_policy(experiment, trial)
            keywords = {**environment(experiment, trial), **policies.modes(policy)}
            with environment_for(policy, task.id, **keywords) as env:
                observation, _ = env.reset(seed=trial.seed, options=dict(trial.options))
                if type(policy).__module__.startswith("policies."):
                    policy.predict(observation)
        except ValueError as error:
            raise ValueError(f"{trial.policy.title}, {trial.friction.title}: {error}") from error


def run_trials(
    experiment: Experiment,
    trials: Sequence[Trial],
    jobs: int = 1,
    progress: bool = True,
    keep: Callable[[list[Result]], None] | None = None,
    ray: str = "",
) -> list[Result]:
    """Runs trials in parallel; the results do not depend on how many run at once.

    On the planar engine, trials of one policy run as rows of a vector environment, unless the policy is one
    of your own. Each episode is that of a single environment with the trial's seed and options, bit for bit
    if the policy's actions are; those of a learned policy differ by rounding.

    Args:
        experiment: What they are part of.
        trials: From `plan`.
        jobs: Processes; -1 for one per core.
        progress: Whether to show a progress bar.
        keep: Called with all results so far whenever a cell of the experiment is complete.
        ray: See `policies.parallel.results`.

    Raises:
        ValueError: A policy refuses its parameters or the observations.
    """
    work = pieces(experiment, trials)
    results: list[Result] = []
    with tqdm(total=len(trials), desc=experiment.name, unit="trial", disable=not progress) as bar:
        for some in parallel.results(run_block, [(experiment, block) for block in work], jobs, ray):
            results += some
            bar.update(len(some))
            if keep is not None and some[-1].row["trial"] == experiment.trials - 1:
                keep(results)
    return results


def run_block(experiment: Experiment, trials: Sequence[Trial]) -> list[Result]:
    """Runs trials of one policy and friction choice, one of `pieces`.

    Raises:
        ValueError: The policy refuses its parameters or the observations.
    """
    pairs = zip(trials, recordings(experiment, trials), strict=True)
    return [_result(experiment, trial, recording) for trial, recording in pairs]


def run_trial(experiment: Experiment, trial: Trial) -> Result:
    """Runs one trial in an environment of its own; errors as for `run_block`."""
    return _result(experiment, trial, record(experiment, trial))


def recordings(experiment: Experiment, trials: Sequence[Trial]) -> list[Recording]:
    """Runs trials as `run_block` does, and keeps their steps."""
    with _named(trials[0]):
        policy = make_policy(experiment, trials[0])
        keeps_all_in_its_state = isinstance(policy, ForcePolicy | NoFrictionInfo | SlipMemory | LearnedPolicy)
        if experiment.engine == "planar" and keeps_all_in_its_state:
            return _record_block(experiment, trials, policy)
    return [record(experiment, trial) for trial in trials]


@contextmanager
def _named(trial: Trial) -> Iterator[None]:
    """Adds the trial to an error."""
    try:
        yield
    except Exception as error:
        error.add_note(f"in trial {trial.keys}")
        raise


def _result(experiment: Experiment, trial: Trial, recording: Recording) -> Result:
    """The row of a trial in the table, and its steps."""
    settings = experiment.configured()[1]
    settings = find(experiment.task).options.parse(trial.options).applied_to(settings)
    limits = {
        limit.column: limit.scale * getattr(settings, limit.option)
        for limit in measures(experiment.task).tolerances
    }
    drawn = {f"drawn_{name}": value for name, value in recording.drawn.items()}
    row = {**trial.keys, **limits, **measure(recording, experiment.task), **drawn}
    return Result(row, recording.series() if trial.number == 0 else None)


def _record_block(
    experiment: Experiment, trials: Sequence[Trial], policy: policies.Policy
) -> list[Recording]:
    """Runs trials of one policy and friction choice side by side, and keeps their steps."""
    arguments = {**environment(experiment, trials[0]), **policies.modes(policy)}
    given = {name: value for name, value in arguments.items() if name not in ("engine", "material")}
    env_id = f"slipgym:{find(experiment.task).id}"
    made: Any = gym.make_vec(env_id, len(trials), "vector_entry_point", **given)
    with closing(made.unwrapped) as envs:
        if isinstance(policy, LearnedPolicy):
            policy.check(envs)
        materials = ({} if each.material == "random" else {"material": each.material} for each in trials)
        rows = [{**trial.options, **material} for trial, material in zip(trials, materials, strict=True)]
        observations, infos = envs.reset(seed=[trial.seed for trial in trials], options={"rows": rows})
        recorder = Recorder([column.name for column in envs.columns], _drawn(infos, len(trials)))
        for step in batch_steps(envs, policy, observations):
            newest = _present(step.observations, len(envs.columns))
            recorder.add(newest, step.rewards, step.infos, step.running)
    return recorder.finish()


def _present(observations: Any, columns: int) -> np.ndarray:
    """The newest of the observations that a policy saw, (..., columns), without privileged ones."""
    seen = observations["policy"] if isinstance(observations, Mapping) else observations
    return seen[..., -columns:]


def _drawn(infos: Mapping[str, Any], n: int) -> list[dict[str, Any]]:
    """Values that the randomization drew for each of n environments, as in the info of a single one."""
    found = infos.get("drawn", {})
    names = [name for name in found if not name.startswith("_")]
    values = [{name: found[name][i] for name in names if found[f"_{name}"][i]} for i in range(n)]
    return [
        {name: one.item() if isinstance(one, np.generic) else one for name, one in row.items()}
        for row in values
    ]


def record(experiment: Experiment, trial: Trial, policy: policies.Policy | None = None) -> Recording:
    """Runs the episode of a trial and keeps its steps; a policy may act instead of the trial's own."""
    task = find(experiment.task)  # first of all: one of your own registers itself, in this process too
    with _named(trial):
        policy = policy or make_policy(experiment, trial)
        keywords = {**environment(experiment, trial), **policies.modes(policy)}
        with environment_for(policy, task.id, **keywords) as env:
            observation, info = env.reset(seed=trial.seed, options=dict(trial.options))
            columns = env.unwrapped.columns  # type: ignore[attr-defined]
            recorder = Recorder([column.name for column in columns], [info.get("drawn", {})])
            for step in steps(env, policy, observation):
                newest = _present(step.observation, len(columns))[np.newaxis]
                infos = {name: np.asarray(step.info[name])[np.newaxis] for name in INFOS if name in step.info}
                recorder.add(newest, np.array([step.reward]), infos, np.ones(1, dtype=bool))
    return recorder.finish()[0]


def environment(experiment: Experiment, trial: Trial) -> dict[str, Any]:
    """Keyword arguments of a trial's environment, but for those that the policy decides."""
    return {
        **experiment.arguments,
        "engine": experiment.engine,
        "friction_source": trial.friction.source,
        "estimator": trial.friction.argument,
        "material": trial.material,
        "frame_skip": experiment.frame_skip_of(trial.policy),
    }


def make_policy(experiment: Experiment, trial: Trial) -> policies.Policy:
    """The policy that acts; a controller gets the environment's configuration and its own rate."""
    parameters, name, config = dict(trial.policy.parameters), trial.policy.name, dict(experiment.config)
    if policies.is_controller(name):
        skip = experiment.frame_skip_of(trial.policy)
        takes = inspect.signature(policies.find(name)).parameters
        if skip > 1:
            config = at_rate(experiment.environment_config().physics.control_rate / skip, config)
        if config and "config" in takes:
            parameters.setdefault("config", config)
    policy = policies.load(trial.policy.name, **parameters)
    policies.check_estimates(trial.policy.name, policy, environment(experiment, trial))
    return policy
