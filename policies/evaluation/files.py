"""Reads experiments from YAML files."""

from __future__ import annotations

import os
from collections.abc import Sequence

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
