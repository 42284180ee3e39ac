"""Finds and registers tasks; loads the configuration and the settings of a task's environment."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import Any

from estimator.reference import is_reference, referenced
from slipgym.config import Config, Overrides, load
from slipgym.config.errors import unknown
from slipgym.config.level import Chosen
from slipgym.config.load import merge, read_overrides
from slipgym.config.task import SettingsT, TaskConfig
from slipgym.config.yaml_model import validate
from slipgym.registration import ENVIRONMENTS, TASK_MODULES
from slipgym.tasks.episode import TERMS_MAX
from slipgym.tasks.task import Task

TASKS: dict[str, Task] = {
    task.name: task for task in (importlib.import_module(name).TASK for name in TASK_MODULES.values())
}
"""Name -> task."""


def find(name: str) -> Task:
    """Find a task by its key ("linear_slip"), its name ("LinearSlip") or the id of its environment.

    Args:
        name: One of these, or "module:attribute" for a task of your own, which imports the module.

    Raises:
        ValueError: There is no such task, or it is not registered.
    """
    if is_reference(name):
        task = referenced(name)
        if not isinstance(task, Task) or TASKS.get(task.name) is not task:
            raise ValueError(f"{name!r} is no task that slipgym.register_task knows")
        return task
    for task in TASKS.values():
        if name in (task.key, task.name, task.id):
            return task
    keys, ids = zip(*((task.key, task.id) for task in TASKS.values()), strict=True)
    raise ValueError(unknown("task", name, keys, ids))


def add(task: Task) -> None:
    """Register a task; it replaces one of the same id.

    Raises:
        ValueError: The id is one of slipgym's own, another task has the name or the key, there are too many
            reward terms, two of the same name, or a default is not allowed.
    """
    name = task.name
    if task.id in ENVIRONMENTS:
        raise ValueError(f"id = {task.id!r} is one of slipgym's own")
    for what, value in (("name", name), ("key", task.key)):
        if not value.isidentifier():
            raise ValueError(f"{what} = {value!r} of {task.id} must be a word of letters, digits and _")
        for other in TASKS.values():
            if other.id != task.id and getattr(other, what) == value:
                raise ValueError(f"{what} = {value!r} of {task.id} is taken by {other.id}")
    for what, rows in (("reward term", task.terms), ("column", task.columns)):
        names = [row.name for row in rows]
        twice = next((each for each in names if names.count(each) > 1), None)
        if twice is not None:
            raise ValueError(f"{task.id} has two {what}s of the name {twice!r}")
    if len(task.terms) > TERMS_MAX:
        raise ValueError(f"{task.id} has {len(task.terms)} reward terms; at most {TERMS_MAX}")
    validate({}, task.settings, f"defaults of {task.id}", prefix=("tasks", task.key))
    TASKS[name] = task


_GIVE_WAY = {
    ("object", "mass"): {"mass_range": None},
    ("contact", "radius"): {"radius": None, "radius_range": None},
    ("gripper", "wrist_speed_max"): {"wrist_speed": None},
}
"""Group and key of the configuration -> settings of tasks that would take its place."""


def configure(
    task: Task[SettingsT],
    overrides: Overrides | None = None,
    sensors: str = "realistic",
    contact: str | None = None,
    level: Chosen | None = None,
) -> tuple[Config, SettingsT]:
    """Loads the configuration and the settings of a task.

    Args:
        task: The task.
        overrides: Values that replace defaults, as a mapping or as the path of a YAML file. Its group
            "tasks" holds settings by the tasks' keys: `{"tasks": {"hold": {"duration": 2.0}}}`. Settings of
            other tasks are checked and then ignored. What is given in part acts in place of what the task
            takes or draws: `{"object": {"mass": 0.3}}`. An object with a size replaces the task's own.
        sensors: Sensor preset, see `slipgym.config.load`.
        contact: Friction model, see `slipgym.config.load`.
        level: Its settings replace the task's defaults; None: none.

    Raises:
        FileNotFoundError: The overrides' file does not exist.
        ValueError: A key is unknown or a value is not allowed; the message names file or argument, key, value
            and what is valid there.
    """
    source, values = ("defaults", {}) if overrides is None else read_overrides(overrides)
    changed: Mapping[str, Any] = {}
    if level is not None:
        changed = level.level.settings
        _settings(task, changed, level.source)
    box = _box(task, values, changed)
    config = load(overrides, sensors, contact, box)
    groups = values.get("tasks", {})
    if not isinstance(groups, Mapping):
        raise ValueError(f"{source}: tasks = {groups!r:.80} must be a mapping of names to values")
    known: dict[Any, Task[Any]] = {each.key: each for each in TASKS.values()} | {task.key: task}
    for key, group in groups.items():
        if key not in known:
            raise ValueError(f"{source}: tasks.{key}: {unknown('key', key, known)}")
        _settings(known[key], group, source)
    changed = merge(changed, _given_way(values))
    if box is not None:
        changed["object"] = config.object.model_dump()
    settings = _settings(task, groups.get(task.key, {}), source, changed)
    try:
        settings.check(config, f"tasks.{task.key}")
    except ValueError as error:
        raise ValueError(f"{source}: {error}") from None
    return config, settings


def _whole(values: Mapping[str, Any]) -> bool:
    return values.keys() >= Config.model_fields.keys()


def _box(task: Task[Any], values: Mapping[str, Any], level: Mapping[str, Any]) -> Mapping[str, Any] | None:
    """The object of the task or its level that an object given in part completes, if there is one."""
    given = values.get("object")
    if _whole(values) or not isinstance(given, Mapping) or not given or "size" in given:
        return None
    return merge(task.default_settings, level)["object"]


def _given_way(values: Mapping[str, Any]) -> dict[str, Any]:
    """The settings that give way to a configuration given in part; a whole one gives them all itself."""
    if _whole(values):
        return {}
    changed: dict[str, Any] = {}
    for (group, key), settings in _GIVE_WAY.items():
        if values.get(group, {}).get(key) is not None:
            changed |= settings
    if "size" in values.get("object", {}):
        changed["object"] = None
    return changed


def _settings(
    task: Task[SettingsT], group: Any, source: str, changed: Mapping[str, Any] | None = None
) -> SettingsT:
    place = f"tasks.{task.key}"
    if not isinstance(group, Mapping):
        raise ValueError(f"{source}: {place} = {group!r:.80} must be a mapping of names to values")
    values = merge(merge(task.default_settings, changed or {}), group)
    settings = validate(values, task.settings, source, prefix=("tasks", task.key))
    for name in settings.reward:
        if name not in task.term_names:
            raise ValueError(f"{source}: {place}.reward.{name}: {unknown('key', name, task.term_names)}")
    return settings


def recorded(config: Config, settings: TaskConfig, key: str) -> dict[str, Any]:
    """Configuration and settings as plain data, in the shape of overrides that restore both."""
    return {**config.model_dump(mode="json"), "tasks": {key: settings.model_dump(mode="json")}}
