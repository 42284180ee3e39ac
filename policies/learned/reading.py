"""Finds the columns of an environment's observation that a policy reads."""

from __future__ import annotations

import numpy as np

from policies.learned.description import Environment
from slipgym.config import load
from slipgym.envs.actions import ACTION_MODES
from slipgym.envs.arguments import DEFAULT_ESTIMATOR, friction_part
from slipgym.envs.observation import columns
from slipgym.tasks import Task, find


def layout(trained: Environment) -> tuple[str, ...]:
    """Names of the columns that the environment of a policy has in this version of slipgym, in order.

    Columns may have been added since the policy was trained. If one that it reads is missing, these are the
    columns of its training, and no environment fits (`policies.learned.fitting`).

    Args:
        trained: The environment the policy was trained in.

    Raises:
        ValueError: Its id is not registered.
    """
    given, task = trained.arguments, _task(trained.id)
    read = tuple(column.name for column in trained.observation)
    source, action_mode, mode = (
        str(given.get(name) or default)
        for name, default in (
            *(("friction_source", "estimated"), ("action_mode", task.action_mode)),
            ("observation_mode", "flat"),
        )
    )
    source = friction_part(source, given.get("estimator", DEFAULT_ESTIMATOR))
    if action_mode not in ACTION_MODES:
        return read
    present = tuple(
        column.name
        for column in columns(load(), task, source, action_mode, mode, bool(given.get("load_columns", False)))
    )
    return present if set(read) <= set(present) else read


def _task(env_id: str) -> Task:
    """The task of an id that is registered: what comes with a policy imports nothing."""
    try:
        return find(env_id)
    except ValueError as error:
        own = "a task of your own: import its module first, or give --task module:attribute"
        raise ValueError(f"{error}; {own}") from None


def selection(trained: Environment) -> np.ndarray | None:
    """Places of the numbers that a policy's network reads.

    Args:
        trained: The environment the policy was trained in.

    Returns:
        Indices, or None if all are read in their order.
    """
    present = layout(trained)
    places = np.array([present.index(column.name) for column in trained.observation])
    frames = np.arange(trained.history + 1)[:, np.newaxis] * len(present)
    chosen = (frames + places).ravel()
    return None if np.array_equal(chosen, np.arange(frames.size * len(present))) else chosen
