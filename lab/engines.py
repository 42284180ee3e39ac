"""The planar engine against PyBullet: the same actions, and the same controller."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from tqdm import tqdm

import policies
from policies.evaluation.experiment import Experiment
from policies.evaluation.plan import Trial, plan
from policies.evaluation.recording import Recording
from policies.evaluation.trial import make_policy, record
from slipgym.config import load

QUANTILE = 0.95


class Tape:
    """A policy that also notes what it did; for a single environment.

    Args:
        policy: The policy.

    Attributes:
        modes: Keyword arguments that its environment needs.
        actions: What it did so far.
    """

    def __init__(self, policy: policies.Policy) -> None:
        self._policy, self.modes = policy, policies.modes(policy)
        self.actions: list[np.ndarray] = []

    def predict(
        self,
        observation: np.ndarray,
        state: Any = None,
        episode_start: np.ndarray | None = None,
        deterministic: bool = True,
    ) -> tuple[np.ndarray, Any]:
        """See `policies.Policy.predict`."""
        action, state = self._policy.predict(observation, state, episode_start, deterministic)
        self.actions.append(action)
        return action, state


class Replay:
    """A policy that repeats noted actions whatever it observes; after the last it keeps that one.

    Args:
        tape: The actions, one per step.
        modes: Keyword arguments that its environment needs.
    """

    def __init__(self, tape: Sequence[np.ndarray], modes: dict[str, Any]) -> None:
        self._tape, self.modes = tape, modes

    def predict(
        self,
        observation: np.ndarray,
        state: Any = None,
        episode_start: np.ndarray | None = None,
        deterministic: bool = True,
    ) -> tuple[np.ndarray, Any]:
        """See `policies.Policy.predict`; the state is the number of the step."""
        step = 0 if state is None else state
        return self._tape[min(step, len(self._tape) - 1)], step + 1


def apart(one: Recording, other: Recording) -> tuple[float, float]:
    """How far apart two episodes end, or where the first of them does [mm, deg]."""
    end = min(len(one.slip), len(other.slip)) - 1
    x, y, theta = one.slip[end] - other.slip[end]
    return 1e3 * math.hypot(x, y), abs(math.degrees(theta))


def halved(experiment: Experiment) -> Experiment:
    """The experiment with every step of the physics halved."""
    physics = load(experiment.config).physics
    finer = {
        "engine_steps": 2 * physics.engine_steps,
        "substep_max": physics.substep_max / 2,
        "patch_substep_max": physics.patch_substep_max / 2,
        "planar_substep_max": physics.planar_substep_max / 2,
    }
    own = {**experiment.config.get("physics", {}), **finer}
    return experiment.model_copy(update={"config": {**experiment.config, "physics": own}})


def evenly(experiment: Experiment, n: int) -> list[Trial]:
    """Trials of the experiment's first policy and friction: n, spread evenly over all its cells."""
    first = {"policies": experiment.policies[:1], "friction": experiment.friction[:1]}
    cells = len(experiment.materials) * len(experiment.combinations())
    trials = plan(experiment.model_copy(update={**first, "trials": -(-n // cells)}))
    return sorted(trials, key=lambda trial: trial.number)[:n]


def compare(
    experiment: Experiment, n: int = 200, progress: bool = True, halving: bool = True
) -> pd.DataFrame:
    """Runs trials with either engine.

    PyBullet's episode is compared with the planar engine's under the actions that the controller took on
    PyBullet, with PyBullet's own under the same actions when every step is halved, and with the planar
    engine's when the controller acts there.

    Args:
        experiment: Its first policy and friction take part.
        n: Trials.
        progress: Whether to show a progress bar.
        halving: Whether to compare also with halved steps.

    Returns:
        A row for each comparison: how far apart the episodes end, median and 95 % quantile [mm, deg], and
        the share of successes in both [%].

    Raises:
        ValueError: n is not positive.
    """
    if n < 1:
        raise ValueError(f"trials = {n} must be at least 1")
    bullet, planar = (experiment.model_copy(update={"engine": engine}) for engine in ("bullet", "planar"))
    rows: dict[str, list[tuple[float, ...]]] = {}
    for trial in tqdm(evenly(experiment, n), desc=experiment.name, unit="trial", disable=not progress):
        tape = Tape(make_policy(experiment, trial))
        truth = record(bullet, trial, tape)
        replay = Replay(tape.actions, tape.modes)
        others = {"planar, same actions": record(planar, trial, replay)}
        if halving:
            others["PyBullet halved, same actions"] = record(halved(bullet), trial, replay)
        others["planar, same controller"] = record(planar, trial)
        for name, other in others.items():
            outcome = *apart(truth, other), truth.success, other.success
            rows.setdefault(name, []).append(outcome)
    return pd.DataFrame([_summary(experiment, name, np.array(outcome)) for name, outcome in rows.items()])


def _summary(experiment: Experiment, name: str, outcomes: np.ndarray) -> dict[str, Any]:
    median, most = np.median(outcomes, axis=0), np.quantile(outcomes, QUANTILE, axis=0)
    success = 100.0 * outcomes.mean(axis=0)
    return {
        "task": experiment.task,
        "sensors": experiment.sensors,
        "against PyBullet": name,
        "trials": len(outcomes),
        "median [mm]": median[0],
        "95 % [mm]": most[0],
        "median [deg]": median[1],
        "95 % [deg]": most[1],
        "success, PyBullet [%]": success[2],
        "success [%]": success[3],
    }
