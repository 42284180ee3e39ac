"""The declaration of a task: settings, the start of an episode, what is rewarded, what is observed."""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Any, Generic, NamedTuple

from gymnasium.envs.registration import parse_env_id
from gymnasium.error import Error

from slipgym.config.task import SettingsT
from slipgym.tasks.compile import compile_evaluate_step, compile_script_wrist
from slipgym.tasks.motion import Motion
from slipgym.tasks.options import EpisodeOptions, derive_options

Value = Callable[..., Any]
"""A function of (episode, world, fingers): EPISODE and WORLD records, FINGER (2,); compiled by numba."""


class Column(NamedTuple):
    """One entry of the observation, and how it is read."""

    name: str
    low: float
    high: float
    unit: str
    meaning: str
    read: str | Value = ""
    """An expression of `episode`, `world` and `fingers`, or a function of them that is compiled."""


class Term(NamedTuple):
    """One term of the reward, and how it is computed."""

    name: str
    scale: float
    """Its default scale."""
    meaning: str
    """Its value before scaling."""
    value: Value
    """Computes it, not scaled."""
    event: bool = False
    """Whether it is paid in full when it happens. If not, the term is dense: every control step pays its
    value, limited to [-1, 1], times scale / (control steps of the episode)."""


def term(scale: float) -> Callable[[Value], Term]:
    """Decorator that makes a dense reward term of a function (episode, world, fingers).

    The term has the function's name, and its meaning is the function's docstring. The value is limited to
    [-1, 1] and paid in every control step, times scale / (control steps of the episode). The sum over an
    episode therefore lies within [-scale, scale].

    Args:
        scale: Default scale of the term.
    """
    return partial(_declared, scale, False)


def event(scale: float) -> Callable[[Value], Term]:
    """Decorator that makes a reward term of a function as `term` does, but of an event.

    The value, 0 in steps without the event, is paid times the scale when the event happens.

    Args:
        scale: Default scale of the term.
    """
    return partial(_declared, scale, True)


def _declared(scale: float, event: bool, value: Value) -> Term:
    meaning = " ".join((value.__doc__ or "").split()).removesuffix(".")
    return Term(value.__name__, scale, meaning, value, event)


@dataclass(frozen=True, eq=False)
class Task(Generic[SettingsT]):
    """A task, for every engine and every number of environments.

    The functions `track`, `success`, `violated`, `ends` and `wrist_velocity`, and those of terms and columns,
    are plain Python that is compiled by numba. They work on one environment: `episode` is an EPISODE record,
    `world` a WORLD record.

    Raises:
        ValueError: The id is malformed, the task has neither `success` nor `violated`, a column's low is not
            below its high, or a term's scale is not finite.
    """

    id: str
    """Id of its environment."""
    settings: type[SettingsT]
    """Its settings, which stand under `tasks.<key>` in overrides of the configuration."""
    start: Callable[..., None]
    """Fills one EPISODE row: (settings, options, rng, episode). The settings hold the options already."""
    terms: tuple[Term, ...]
    """Terms of the reward, at most `slipgym.tasks.episode.TERMS_MAX`."""
    columns: tuple[Column, ...]
    """The task's part of the observation."""
    success: Value | None = None
    """Whether an episode that is over, without drop and violation, was a success: (episode, world) -> bool;
    None: it was."""
    violated: Value | None = None
    """After each control step: (episode, world, fingers) -> bool, whether success has become impossible,
    whatever follows; `episode.violated` stays true from then on. None: never before the end."""
    track: Value | None = None
    """After each control step, first: (episode, world, fingers) updates `episode.reference` and what is kept.
    The other functions change nothing. The former (episode, world) works with a DeprecationWarning."""
    ends: Value | None = None
    """After each control step: (episode, world) -> bool, whether the episode ends before its length; the
    environment then reports it as terminated. None: it never does."""
    wrist_velocity: Value | None = None
    """Before each control step: (episode, world) -> scripted velocity (x, z, pitch) at its end; None: 0."""
    action_mode: str = "grip_force"
    """Of its environment, unless another is asked for."""
    motion: Motion = field(default_factory=Motion)
    """What pictures, tables and figures show of the object's slip."""
    page: str | None = None
    """What is written by hand of its environment's documentation: see `slipgym.envs.docstring`."""
    key: str = ""
    """Its name in configuration and command lines; empty: the id's name in snake case, "linear_slip"."""

    def __post_init__(self) -> None:
        try:
            name = self.name
        except Error as error:
            raise ValueError(f"id = {self.id!r}: {error}") from error
        if self.success is None and self.violated is None:
            raise ValueError(f"{self.id} needs `success`, `violated` or both")
        for column in self.columns:
            if not column.low < column.high:
                raise ValueError(
                    f"column {column.name}: low = {column.low} must be below high = {column.high}"
                )
        for term in self.terms:
            if not math.isfinite(term.scale):
                raise ValueError(f"term {term.name}: scale = {term.scale}: expected a finite number")
        if not self.key:
            object.__setattr__(self, "key", re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower())

    @cached_property
    def name(self) -> str:
        """Name in the environment's id."""
        return parse_env_id(self.id)[1]

    @cached_property
    def term_names(self) -> tuple[str, ...]:
        """Names of the reward terms."""
        return tuple(term.name for term in self.terms)

    @cached_property
    def options(self) -> type[EpisodeOptions]:
        """Options that `reset(options=...)` can fix, derived from the settings."""
        return derive_options(self.name, self.settings)

    @cached_property
    def default_settings(self) -> dict[str, Any]:
        """Every value of the settings by its name, as plain data."""
        scales = {term.name: term.scale for term in self.terms}
        return {**self.settings().model_dump(mode="json"), "reward": scales}

    @property
    def module(self) -> str:
        """Module that defines the task: that of its `start`."""
        return self.start.__module__

    @cached_property
    def script_wrist(self) -> Any:
        """Compiled, before a control step: (episodes, worlds) sets the wrist's acceleration."""
        return compile_script_wrist(self, self._file)

    @cached_property
    def evaluate_step(self) -> Any:
        """Compiled, after a control step: (episodes, worlds, fingers, columns) evaluates it.

        It writes `dropped`, `violated`, `ended`, `success` and the scaled reward terms into the episodes, and
        the task's part of the observation into `columns` (n, k).
        """
        return compile_evaluate_step(self, self._file)

    @property
    def _file(self) -> str:
        return getattr(sys.modules[self.module], "__file__", None) or __file__
