"""Reads experiments from YAML files, and lists their trials, seeds and which of them run together."""

from __future__ import annotations

import json
import os
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any

import numpy as np

from policies.evaluation.experiment import Experiment, FrictionChoice, PolicyChoice
from policies.task_names import file_name
from slipgym.config.errors import unknown
from slipgym.config.yaml_model import names, read_model, validate

_FOLDER = "experiments"


def experiment_names() -> list[str]:
    """Names of the experiments that come with slipgym."""
    return names(_FOLDER)


def load_experiment(which: str | os.PathLike[str]) -> Experiment:
    """Reads an experiment: one of `experiment_names()`, or the YAML file at a path.

    A task's own experiment also goes by the task's other names, "LinearSlip" for example.

    Raises:
        FileNotFoundError: It looks like a path, but there is no such file.
        ValueError: The name is unknown, or the file holds a wrong key or value.
    """
    return read_model(file_name(which, _FOLDER), Experiment, _FOLDER, "experiment")


def narrowed(
    experiment: Experiment,
    trials: int | None = None,
    seed: int | None = None,
    friction: Sequence[str] = (),
    level: str | None = None,
) -> Experiment:
    """The experiment with another number of trials, another seed or level; None leaves them.

    It keeps the friction choices with some labels or sources; none given keeps all.

    Raises:
        ValueError: A value is not allowed, or the experiment has no such friction.
    """
    kept = experiment.friction
    valid = {name for choice in kept for name in (choice.title, choice.source)}
    for name in friction:
        if name not in valid:
            raise ValueError(unknown("friction of this experiment", name, valid))
    if friction:
        kept = tuple(choice for choice in kept if {choice.title, choice.source} & set(friction))
    values = {**dict(experiment), "friction": kept, "policies": _acting(experiment.policies, kept)}
    changes = {"trials": trials, "seed": seed, "level": level}
    values.update({key: value for key, value in changes.items() if value is not None})
    return validate(values, Experiment, experiment.name)


def _acting(policies: Sequence[PolicyChoice], kept: Sequence[FrictionChoice]) -> tuple[PolicyChoice, ...]:
    """The policies that act with one of the friction choices, each with those alone."""
    titles = [choice.title for choice in kept]
    found = []
    for policy in policies:
        own = tuple(name for name in policy.friction if name in titles)
        if own or not policy.friction:
            found.append(policy.model_copy(update={"friction": own}))
    return tuple(found)


ROWS = 256
"""Most trials in one vector environment."""


@dataclass(frozen=True)
class Trial:
    """One episode: its policy, material or "random", options of reset, number in its cell from 0, seed."""

    policy: PolicyChoice
    friction: FrictionChoice
    material: str
    options: Mapping[str, Any]
    number: int
    seed: int

    @property
    def keys(self) -> dict[str, Any]:
        """Columns that distinguish this trial from the others, for tables."""
        return {
            "policy": self.policy.title,
            "friction": self.friction.title,
            "friction_source": self.friction.source,
            "estimator": json.dumps(self.friction.argument),
            "material": self.material,
            "options": json.dumps(dict(self.options), sort_keys=True),
            "trial": self.number,
            "seed": self.seed,
        }


def plan(experiment: Experiment) -> list[Trial]:
    """Every trial, in the order of the tables."""
    return [
        Trial(policy, friction, material, options, number, seed(experiment.seed, material, options, number))
        for policy in experiment.policies
        for friction in experiment.friction
        if not policy.friction or friction.title in policy.friction
        for material in experiment.materials
        for options in experiment.combinations()
        for number in range(experiment.trials)
    ]


def seed(experiment_seed: int, material: str, options: Mapping[str, Any], number: int) -> int:
    """Seed of an environment, the same for every policy and friction choice: trials come in pairs.

    It depends on the scenario by its content, so that leaving out a material moves no other trial.
    """
    scenario = zlib.crc32(json.dumps([material, dict(options)], sort_keys=True).encode())
    return int(np.random.SeedSequence([experiment_seed, scenario, number]).generate_state(1)[0])


def pieces(experiment: Experiment, trials: Sequence[Trial]) -> list[tuple[Trial, ...]]:
    """Trials that run together: on the planar engine up to ROWS of one policy and friction, else one."""
    if experiment.engine != "planar":
        return [(trial,) for trial in trials]
    alike = groupby(trials, lambda trial: (trial.policy.model_dump_json(), trial.friction.model_dump_json()))
    found = (tuple(group) for _, group in alike)
    return [group[first : first + ROWS] for group in found for first in range(0, len(group), ROWS)]
