"""The model of the configuration, with the settings of every task there is."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import TYPE_CHECKING, Any

from pydantic import Field, create_model

from slipgym.config.base import Frozen
from slipgym.config.root import Config
from slipgym.config.tasks import TaskConfig, TasksConfig

if TYPE_CHECKING:
    from slipgym.tasks import Task


def tasks() -> dict[str, Task]:
    """Every task by its key in the configuration."""
    from slipgym.tasks import TASKS  # their files import slipgym.config

    return {task.key: task for task in TASKS.values()}


def config_model() -> type[Config]:
    """`Config` with a group for each task."""
    return _assembled(tuple(tasks().values()))


def restored(values: Mapping[str, Any]) -> Config:
    """A configuration from what `model_dump` made of it."""
    return config_model().model_validate(values)


@cache
def _assembled(tasks: tuple[Task, ...]) -> type[Config]:
    fields: dict[str, Any] = {task.key: (_group(task), Field(description=f"{task.id} [-]")) for task in tasks}
    groups = create_model("TasksConfig", __base__=TasksConfig, __doc__=TasksConfig.__doc__, **fields)
    field = Field(description=Config.model_fields["tasks"].description)
    return create_model("Config", __base__=Config, __doc__=Config.__doc__, tasks=(groups, field))


@cache
def _group(task: Task) -> type[TaskConfig]:
    """The settings of a task, with the scales of its reward terms."""
    scales: dict[str, Any] = {
        term.name: (float, Field(description=f"Scale of {term.meaning} [-]")) for term in task.reward
    }
    reward = create_model(
        f"{task.name}Reward",
        __base__=Frozen,
        __doc__=f"Scales of the reward terms of {task.name}.",
        **scales,
    )
    field = Field(description=TaskConfig.model_fields["reward"].description)
    return create_model(
        f"{task.name}Config", __base__=task.settings, __doc__=task.settings.__doc__, reward=(reward, field)
    )
