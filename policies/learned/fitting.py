"""Compares an environment with the one that a policy was trained for, and finds the columns that it reads."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from policies.learned.description import Column, Environment
from slipgym.config import load
from slipgym.envs.actions import ACTION_MODES
from slipgym.envs.arguments import DEFAULT_ESTIMATOR, friction_part
from slipgym.envs.observation import columns
from slipgym.tasks import find

_DECISIVE = "sensors", "friction_source", "action_mode"
"""Arguments of an environment on which its columns depend most."""


def layout(trained: Environment) -> tuple[str, ...]:
    """Names of the columns that the environment of a policy has in this version of slipgym, in order.

    Columns may have been added since the policy was trained. If one that it reads is missing, these are the
    columns of its training, and no environment fits.

    Raises:
        ValueError: The environment's id is not registered.
    """
    try:
        task = find(trained.id)  # what comes with a policy imports nothing
    except ValueError as error:
        own = "a task of your own: import its module first, or give --task module:attribute"
        raise ValueError(f"{error}; {own}") from None
    given, read = trained.arguments, tuple(column.name for column in trained.observation)
    source = friction_part(
        str(given.get("friction_source") or "estimated"), given.get("estimator", DEFAULT_ESTIMATOR)
    )
    action_mode = str(given.get("action_mode") or task.action_mode)
    mode = str(given.get("observation_mode") or "flat")
    if action_mode not in ACTION_MODES:
        return read
    shown = columns(load(), task, source, action_mode, mode, bool(given.get("load_columns", False)))
    present = tuple(column.name for column in shown)
    return present if set(read) <= set(present) else read


def selection(trained: Environment) -> np.ndarray | None:
    """Places of the numbers in an observation that a policy's network reads; None: all, in their order."""
    present = layout(trained)
    places = np.array([present.index(column.name) for column in trained.observation])
    frames = np.arange(trained.history + 1)[:, np.newaxis] * len(present)
    chosen = (frames + places).ravel()
    return None if np.array_equal(chosen, np.arange(frames.size * len(present))) else chosen


def check_environment(trained: Environment, env: Any) -> None:
    """Refuse an environment of slipgym whose observations or actions mean something else than in training.

    Columns that were added to the observations of slipgym since the training are ignored.

    Raises:
        ValueError: A column differs in name, bounds or unit, or the history or the rate does; the message
            names the first difference.
    """
    inner, names = env.unwrapped, layout(trained)
    added = set(names) - {column.name for column in trained.observation}
    observed = [column for column in inner.columns if column.name not in added]
    for what, ours, theirs in (
        ("observation", trained.observation, observed),
        ("action", trained.action, inner.action_columns),
    ):
        difference = first_difference(ours, [column_of(column) for column in theirs])
        if difference:
            given = [f"{name}={trained.arguments[name]!r}" for name in _DECISIVE if name in trained.arguments]
            trained_with = f"; it was trained with {', '.join(given)}" if given else ""
            raise ValueError(f"the policy was trained for another {what}: {difference}{trained_with}")
    space = inner.observation_space
    width = getattr(space, "spaces", {"policy": space})["policy"].shape[-1]
    wanted = (trained.history + 1) * len(names)
    if width != wanted:
        raise ValueError(
            f"the policy was trained with history={trained.history}: {wanted} numbers; "
            f"the environment's observation has {width}"
        )
    rate = inner.metadata["render_fps"]
    if not np.isclose(rate, trained.rate):
        raise ValueError(f"the policy was trained at {trained.rate:g} steps per second, here are {rate:g}")


def column_of(column: Any) -> Column:
    """A column of an environment as policies keep it."""
    return Column(name=column.name, low=float(column.low), high=float(column.high), unit=column.unit)


def first_difference(ours: Sequence[Column], theirs: Sequence[Column]) -> str:
    """In words, where two lists of columns begin to differ; empty if they do not."""
    for k, (a, b) in enumerate(zip(ours, theirs, strict=False)):
        if a != b:
            return f"column {k} is {_words(b)} here, {_words(a)} in training"
    if len(theirs) < len(ours):
        return f"column {len(theirs)}, {_words(ours[len(theirs)])} in training, is missing here"
    if len(theirs) > len(ours):
        return f"column {len(ours)}, {_words(theirs[len(ours)])} here, was not there in training"
    return ""


def _words(column: Column) -> str:
    return f"{column.name!r} ({column.low:g} to {column.high:g}, [{column.unit}])"
