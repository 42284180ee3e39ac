"""The environment class of a task."""

from __future__ import annotations

from functools import cache

from slipgym.envs.docstring import docstring
from slipgym.envs.slip_env import SlipEnv
from slipgym.registration import ENVIRONMENTS
from slipgym.tasks import Task


@cache
def environment(task: Task) -> type[SlipEnv]:
    """The class <name>Env, documented; the same for every call.

    It is to be found in `slipgym.envs`, or, for a task of one's own, in the module of the task's `start`.

    Raises:
        ValueError: The task's page has an unknown section.
    """
    module = "slipgym.envs" if task.id in ENVIRONMENTS else task.start.__module__
    members = {"task": task, "__doc__": docstring(task), "__module__": module}
    return type(f"{task.name}Env", (SlipEnv,), members)
