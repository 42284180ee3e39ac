"""Gives environments their signature, a spec that says how long they last, and copies that keep changes."""

from __future__ import annotations

import inspect
import os
import textwrap
from collections.abc import Callable, Mapping
from copy import copy, deepcopy
from enum import Enum
from typing import Any, TypeVar

import numpy as np
from gymnasium.envs.registration import EnvSpec

from slipgym.config import TaskConfig
from slipgym.config.base import plain
from slipgym.envs.arguments import Field, fields
from slipgym.tasks import Task

_SPACES = "action_space", "observation_space", "single_action_space", "single_observation_space"
_LIMIT = "max_episode_steps"
"""Keyword argument of a vector environment that `gymnasium.make_vec` takes from the spec."""
_RESTORED = "_np_random", "_np_random_seed"
"""Attributes of a scalar environment that its state holds."""


Class = TypeVar("Class", bound=type)


class Conventions:
    """Base class of scalar and vector environments: `spec`, and what their copies keep."""

    _spec: EnvSpec | None = None
    _horizon: int | None = None
    """Steps of an episode with the environment's settings; None: they differ from episode to episode."""
    _own: frozenset[str] = frozenset()
    """Names of the attributes that the constructor sets."""

    @property
    def spec(self) -> EnvSpec | None:
        """Arguments of `gymnasium.make`, all JSON-able, and the steps of an episode, `max_episode_steps`.

        The environment ends its episodes itself: `gymnasium.make(id)` puts no `TimeLimit` around it.
        """
        return self._spec

    @spec.setter
    def spec(self, spec: EnvSpec | None) -> None:
        self._spec = made = copy(spec)
        if made is not None:
            made.kwargs = {name: _jsonable(value) for name, value in made.kwargs.items()}
            limit = made.kwargs.pop(_LIMIT, made.max_episode_steps)
            made.max_episode_steps = self._horizon if limit in (None, -1) else limit

    def _kept(self) -> dict[str, Any]:
        """Attributes that a copy takes over: spaces with their generators, spec, and those of the user."""
        mine = vars(self)
        kept = {name: deepcopy(mine[name]) for name in (*_SPACES, "metadata", "_spec") if name in mine}
        users = mine.keys() - self._own - {*_RESTORED, "_spec"}
        return kept | {name: mine[name] for name in sorted(users)}


def rebuilt(base: Any, kind: Any, arguments: Mapping[str, Any], state: Any) -> Any:
    """Return a copy of an environment.

    Args:
        base: The class whose constructor takes the arguments; a subclass of the user's may take others.
        kind: Class of the copy.
        arguments: Keyword arguments.
        state: From `get_state`; None: the copy is closed.
    """
    env = kind.__new__(kind)
    base.__init__(env, **arguments)
    if state is None:
        env.close()
    else:
        env.set_state(state)
    return env


def horizon(task: Task, settings: TaskConfig, blank: np.ndarray, frame_skip: int) -> int | None:
    """Steps of an episode without reset options; None if episodes differ. `blank` is EPISODE (1,)."""
    lengths = set()
    for seed in range(2):
        episode = blank.copy()
        try:
            task.start(settings, task.options.parse(None), np.random.default_rng(seed), episode[0])
        except Exception:  # a task of the user's that needs a sampled episode; reset says what is wrong
            return None
        lengths.add(-(-episode["steps"].item() // frame_skip))
    return lengths.pop() if len(lengths) == 1 else None


def _jsonable(value: Any) -> Any:
    """A keyword argument as JSON can hold it: paths and modes of autoreset as text."""
    value = plain(value)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    return value.value if isinstance(value, Enum) else value


def documented(kind: type, *first: inspect.Parameter) -> Callable[[Class], Class]:
    """Decorator for a class whose constructor takes the arguments of a kind: signature and docstring.

    Args:
        kind: `ScalarArguments` or `VectorArguments`.
        *first: Parameters in front of them.
    """

    def decorate(cls: Class) -> Class:
        parameters = [
            inspect.Parameter(
                field.name, inspect.Parameter.KEYWORD_ONLY, default=field.default, annotation=field.annotation
            )
            for field in fields(kind).values()
        ]
        cls.__signature__ = inspect.Signature([*first, *parameters])
        if cls.__doc__ is not None:
            lines = [_paragraph(field) for field in fields(kind).values()]
            cls.__doc__ = cls.__doc__.replace("        {arguments}", "\n".join(lines))
        return cls

    return decorate


def _paragraph(field: Field) -> str:
    text = f"{field.name}: {field.text[0].upper()}{field.text[1:]}. Default: {field.default!r}."
    return textwrap.fill(text, 110, initial_indent=" " * 8, subsequent_indent=" " * 12)
