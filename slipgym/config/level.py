"""Configuration model of a level of difficulty: settings of the task and randomization that it changes."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, NamedTuple

from pydantic import Field

from slipgym.config import files
from slipgym.config.base import Frozen
from slipgym.config.randomization import Randomization, Ranges
from slipgym.config.yaml_model import Choice, chosen, validate

DEFAULT = "easy"
"""The level that changes nothing."""
_FOLDER = "levels"


class Level(Frozen):
    """Changes of settings and randomization by a level."""

    settings: Mapping[str, Any] = Field(default={}, description="Settings of the task that differ")
    randomization: Ranges = Field(default=Ranges(), description="Distributions of the task that differ")

    def applied_to(self, randomization: Randomization, task: str) -> Randomization:
        """The randomization of a task, given by its key, with the level's distributions in place of its own.

        The level's disturbances are added. A disturbance of a kind that can happen only once in an episode,
        that is, any but a push, replaces the one of its kind.

        Raises:
            ValueError: The distributions contradict each other.
        """
        own = self.randomization
        if not own.model_fields_set:
            return randomization
        before = randomization.of(task)
        changed = {name: getattr(own, name) for name in own.model_fields_set}
        if not {"mu_c", "mu_s", "friction_ratio"}.isdisjoint(changed):
            changed.setdefault("materials", None)
        once = {each.kind for each in own.disturbances} - {"push"}
        kept = tuple(each for each in before.disturbances if each.kind not in once)
        changed["disturbances"] = (*kept, *own.disturbances)
        values = {name: getattr(before, name) for name in Ranges.model_fields} | changed
        ranges = validate(values, Ranges, "level and randomization together")
        return randomization.model_copy(update={"tasks": {**randomization.tasks, task: ranges}})


class Chosen(NamedTuple):
    """A level and where it comes from."""

    level: Level
    source: str
    """File or argument, for the messages of errors."""
    name: str | None = None
    """Its name; None: it is the user's own."""

    @property
    def argument(self) -> str | dict[str, Any]:
        """Argument that chooses it again, JSON-able once a task has accepted its settings."""
        return self.name or self.level.model_dump(mode="json", exclude_unset=True)


def level_names(task: str) -> list[str]:
    """Names of the levels of a task: those of its file in `configs/levels`, or DEFAULT alone."""
    return list(_levels(task))


def load_level(choice: Choice, task: str) -> Chosen:
    """Loads a level of a task.

    Args:
        choice: One of `level_names(task)`, the path of a YAML file with the keys `settings` and
            `randomization`, or a mapping of the same shape.
        task: Key of the task.

    Raises:
        FileNotFoundError: The file does not exist.
        ValueError: The name or a key is unknown, or a value is not allowed.
    """
    known = _levels(task)
    values, source, name = chosen(choice, "level", known, f" of {task}")
    if not name:
        return Chosen(validate(values, Level, source), source)
    source = os.fspath(files.folder() / _FOLDER / f"{task}.yaml")
    return Chosen(validate(known[name], Level, source, prefix=(name,)), source, name)


def _levels(task: str) -> Mapping[str, Mapping[str, Any]]:
    path = files.folder() / _FOLDER / f"{task}.yaml"
    return files.read_once(path) if path.is_file() else {DEFAULT: {}}
