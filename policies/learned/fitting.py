"""Whether an environment is the one a policy was trained for."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from policies.learned.description import Column, Environment


def check_environment(trained: Environment, env: Any) -> None:
    """Refuse an environment whose observations or actions mean something else.

    Args:
        trained: What the policy was trained in.
        env: An environment of slipgym.

    Raises:
        ValueError: A column differs in name, bounds or unit, or the history or the rate does; the message
            names the first difference.
    """
    inner = env.unwrapped
    for what, ours, theirs in (
        ("observation", trained.observation, inner.columns),
        ("action", trained.action, inner.action_columns),
    ):
        difference = first_difference(ours, [column_of(column) for column in theirs])
        if difference:
            raise ValueError(f"the policy was trained for another {what}: {difference}")
    space = inner.observation_space
    width = getattr(space, "spaces", {"policy": space})["policy"].shape[-1]
    if width != trained.width:
        raise ValueError(
            f"the policy was trained with history={trained.history}: {trained.width} numbers; "
            f"the environment's observation has {width}"
        )
    rate = inner.metadata["render_fps"]
    if not np.isclose(rate, trained.rate):
        raise ValueError(f"the policy was trained at {trained.rate:g} steps per second, here are {rate:g}")


def check_width(trained: Environment, width: int) -> None:
    """Refuse observations of another length.

    Raises:
        ValueError: The length is another one; the message names the first column that is missing or follows.
    """
    if width == trained.width:
        return
    columns, message = trained.observation, f"observation has {width} columns, "
    message += f"the policy was trained on {trained.width} (history={trained.history})"
    if trained.history == 0 and width < len(columns):
        message += f"; the first that it lacks at its end is {columns[width].name!r}"
    elif trained.history == 0:
        message += f"; the last one known is {columns[-1].name!r}"
    raise ValueError(message)


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
