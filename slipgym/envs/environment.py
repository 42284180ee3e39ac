"""Makes the environment class of a task."""

from __future__ import annotations

from functools import cache

import gymnasium as gym

from slipgym.envs.docstring import docstring
from slipgym.envs.slip_env import SlipEnv
from slipgym.registration import ENVIRONMENTS, register_id
from slipgym.tasks import Task
from slipgym.tasks.table import add


@cache
def environment(task: Task) -> type[SlipEnv]:
    """Return the class <name>Env with its docstring; every call returns the same class.

    Its module is `slipgym.envs` or, for a task of your own, the module of the task's `start`.

    Raises:
        ValueError: The task's page has an unknown section.
    """
    module = "slipgym.envs" if task.id in ENVIRONMENTS else task.module
    members = {"task": task, "__doc__": docstring(task), "__module__": module}
    return type(f"{task.name}Env", (SlipEnv,), members)


def register_task(task: Task) -> type[SlipEnv]:
    """Make a task of your own an environment, in this process.

    Bind the class that comes back to a name of the module that defines the task, <name>Env: Gymnasium looks
    for it there, and so does pickle. Once registered, a task is in `slipgym.tasks.TASKS`, and configuration,
    experiments, policies and pictures know it. Registering an id again replaces the task.

    Args:
        task: The task; its module is that of its `start`.

    Raises:
        ValueError: Another task has its name or key, or a part of the task is not valid; the message says
            which.
    """
    made = environment(task)
    add(task)
    gym.registry.pop(task.id, None)
    register_id(task.id, f"{made.__module__}:{made.__name__}")
    return made
