"""Accepts every spelling of a task's name, such as "linear_slip" or "LinearSlip", and finds its policy."""

from __future__ import annotations

import os

from estimator.reference import is_reference
from policies import registry
from slipgym.config.yaml_model import names
from slipgym.registration import ENVIRONMENTS
from slipgym.tasks import find


def file_name(which: str | os.PathLike[str], folder: str, ending: str = "") -> str | os.PathLike[str]:
    """The name of a task's default file, where the task's name is given, in whatever spelling.

    Args:
        which: Name or path of a YAML file, or a task as `slipgym.tasks.find` takes it: "linear_slip",
            "LinearSlip", "slipgym/LinearSlip-v0" or "module:attribute".
        folder: Folder of the default configuration, "experiments" for example.
        ending: What the file's name has behind the task's key.

    Returns:
        The task's key with the ending if that is the name of a file in the folder; otherwise what was given.
    """
    if not isinstance(which, str) or which in names(folder):
        return which
    try:
        name = find(which).key + ending
    except ValueError:
        return which
    return name if name in names(folder) else which


def canonical(name: str) -> str:
    """The name of a task, however it is spelled.

    "module:attribute" of a reader's own task stays as it is, since other processes have to import the module.

    Raises:
        ValueError: There is no such task.
    """
    task = find(name)
    return name if is_reference(name) and task.id not in ENVIRONMENTS else task.name


def own_policy(task: str) -> str:
    """The policy named like a task's group in the configuration; a constant force if there is none.

    Args:
        task: As `slipgym.tasks.find` takes it.
    """
    key = find(task).key
    return key if key in registry.names() else "constant_force"
