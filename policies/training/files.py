"""Reads training configurations from YAML files, and applies what a command line sets."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import yaml

from policies.task_names import file_name
from policies.training.config import Training
from slipgym.config import files, yaml_model
from slipgym.tasks import find

_FOLDER = "training"
OWN = "_scratch"
"""Ending of the configuration that a task's own name stands for."""


def names() -> list[str]:
    """Names of the training configurations that come with slipgym."""
    return yaml_model.names(_FOLDER)


def load(which: str | os.PathLike[str], overrides: Mapping[str, Any] | None = None) -> Training:
    """Reads a training configuration: one of `names()`, or the path of a YAML file.

    A task's name, "carry" or "Carry", stands for the configuration that learns it from nothing,
    "carry_scratch". Overrides by dotted key ("ppo.gamma") replace the file's values.

    Raises:
        FileNotFoundError: It looks like a path, but there is no such file.
        ValueError: The name is unknown, or a key or value is wrong; the message names the file or option,
            the key, and what is valid.
    """
    found = yaml_model.read_model(file_name(which, _FOLDER, OWN), Training, _FOLDER, "training configuration")
    return changed(found, overrides or {})


def chosen(name: str | None, options: Mapping[str, Any], texts: Sequence[str]) -> Training:
    """The configuration that a command line names, or its option "task", with what it sets.

    Assignments as texts win over options; an option that is None leaves a value as it is.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: Nothing is named, or a name, key or value is wrong.
    """
    given = {key: value for key, value in options.items() if value is not None}
    if name is None:
        task = given.get("task")
        if task is None:
            raise ValueError(f"name a configuration ({', '.join(names())}, or a YAML file) or a --task")
        name = find(task).key
    return load(name, {**given, **assignments(texts)})


def changed(training: Training, overrides: Mapping[str, Any], source: str = "command line") -> Training:
    """The configuration with other values by dotted key; the source of these is named in errors.

    Raises:
        ValueError: A key or value is wrong, or estimates are asked for where no estimator runs.
    """
    values = with_values(training.model_dump(exclude_unset=True), overrides)
    found = checked(values, source if overrides else training.task)
    if overrides.get("environment.friction_source") == "estimated" and found.environment.estimator is None:
        raise ValueError(
            f"{source}: friction_source 'estimated' needs an estimator, and environment.estimator is null; "
            "--set environment.estimator=adaptive runs one"
        )
    return found


def with_values(values: Mapping[str, Any], overrides: Mapping[str, Any]) -> dict[str, Any]:
    """Nested values with others by dotted key."""
    changed = dict(values)
    for key, value in overrides.items():
        *groups, last = key.split(".")
        at = changed
        for group in groups:
            inner = at.get(group)
            at[group] = dict(inner) if isinstance(inner, Mapping) else {}
            at = at[group]
        at[last] = value
    return changed


def assignments(texts: Iterable[str]) -> dict[str, Any]:
    """Values by dotted key out of texts like "ppo.gamma=0.99"; the value is YAML.

    Raises:
        ValueError: A text is no assignment.
    """
    found = {}
    for text in texts:
        key, equals, value = text.partition("=")
        if not equals or not key:
            raise ValueError(f"--set {text!r} must be key=value")
        found[key] = files.parse(value, f"--set {key}")
    return found


def checked(values: Mapping[str, Any], source: str) -> Training:
    """A configuration from plain values as in a YAML file; their source is named in errors.

    Raises:
        ValueError: A key or value is wrong; one line per fault.
    """
    return yaml_model.validate(values, Training, source)


def text(training: Training) -> str:
    """The whole configuration as YAML."""
    return yaml.safe_dump(training.model_dump(mode="json"), sort_keys=False, allow_unicode=True)
