"""Experiments as YAML files."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from policies.evaluation.experiment import Experiment
from slipgym.config import files
from slipgym.config.errors import unknown

M = TypeVar("M", bound=BaseModel)


def experiment_names() -> list[str]:
    """Names of the experiments that come with slipgym."""
    return sorted(path.stem for path in (files.folder() / "experiments").glob("*.yaml"))


def load_experiment(which: str | os.PathLike[str]) -> Experiment:
    """Reads an experiment.

    Args:
        which: One of `experiment_names()`, or the path of a YAML file.

    Raises:
        FileNotFoundError: It looks like a path, but there is no such file.
        ValueError: The name is unknown, or the file holds a wrong key or value.
    """
    path = Path(which)
    if path.suffix not in (".yaml", ".yml"):
        if str(which) not in experiment_names():
            raise ValueError(unknown("experiment", str(which), experiment_names()))
        path = files.folder() / "experiments" / f"{which}.yaml"
    return checked(files.read(path), path.name)


def narrowed(
    experiment: Experiment,
    trials: int | None = None,
    seed: int | None = None,
    friction: Sequence[str] = (),
) -> Experiment:
    """The experiment with another number of trials, another seed, or fewer friction choices.

    Args:
        experiment: The experiment.
        trials: Trials per cell; None leaves them.
        seed: Its seed; None leaves it.
        friction: Labels or sources to keep; none given keeps all.

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
    values = {**dict(experiment), "friction": kept}
    values.update({key: value for key, value in (("trials", trials), ("seed", seed)) if value is not None})
    return checked(values, experiment.name)


def checked(values: Mapping[str, Any], source: str) -> Experiment:
    """An experiment from plain values.

    Args:
        values: As in a YAML file.
        source: Where they come from, for the message of an error.

    Raises:
        ValueError: A key or value is wrong; one line per fault says where and what is valid.
    """
    return validated(Experiment, values, source)


def validated(model: type[M], values: Mapping[str, Any], source: str) -> M:
    """A model from plain values; arguments and errors as of `checked`."""
    try:
        return model.model_validate(dict(values))
    except ValidationError as error:
        lines = []
        for fault in error.errors():
            at = ".".join(str(part) for part in fault["loc"])
            message = fault["msg"].removeprefix("Value error, ")
            given = "" if fault["type"] in ("value_error", "missing") else f" = {fault['input']!r}"
            lines.append(f"{source}: {at}{given}{': ' if at else ''}{message}")
        raise ValueError("\n".join(lines)) from error
