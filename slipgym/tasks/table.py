"""Finds and registers tasks."""

from __future__ import annotations

import importlib

from estimator.reference import is_reference, referenced
from slipgym.config.errors import unknown
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
