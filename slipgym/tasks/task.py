"""What makes a task."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

from gymnasium.envs.registration import parse_env_id
from gymnasium.error import Error

from slipgym.config.tasks import TaskConfig
from slipgym.tasks.motion import Motion
from slipgym.tasks.options import EpisodeOptions

EFFORT = "-(mean actuator force / gripper.force_max)"
"""Meaning of the reward term that is minus `slipgym.tasks.episode.effort`."""
SMOOTHNESS = "-(change of the commanded force / gripper.force_max)^2"
"""Meaning of the reward term that is minus `slipgym.tasks.episode.roughness`."""
DROP = "-1 on a drop, else 0"
"""Meaning of the reward term that punishes a drop."""


class Column(NamedTuple):
    """One entry of the observation."""

    name: str
    low: float
    high: float
    unit: str
    meaning: str
    read: str = ""
    """Expression that reads it out of the simulation's arrays."""


class Term(NamedTuple):
    """One term of the reward."""

    name: str
    scale: float
    """Its default scale."""
    meaning: str
    """Its value before scaling."""


@dataclass(frozen=True, eq=False)
class Task:
    """A task as functions over a leading batch axis, so that every world can run it.

    Raises:
        ValueError: The id is malformed.
    """

    id: str
    """Id of its environment."""
    key: str
    """Its group under `tasks` in the configuration."""
    settings: type[TaskConfig]
    """That group, but for the reward's scales."""
    defaults: Mapping[str, Any]
    """Their values; what every task has and is left out is null."""
    options: type[EpisodeOptions]
    """What `reset(options=...)` can fix."""
    reward: tuple[Term, ...]
    """Terms of the reward, at most `slipgym.tasks.episode.TERMS_MAX`."""
    columns: tuple[Column, ...]
    """The task's part of the observation."""
    start: Callable[..., None]
    """Fills one EPISODE row: (config, options, rng, episode)."""
    plan: Callable[..., None]
    """Compiled, before a control step: (episodes, worlds) sets wrist motion and disturbance."""
    judge: Callable[..., None]
    """Compiled, after a control step: (episodes, worlds, fingers, columns)."""
    action_mode: str = "grip_force"
    """Of its environment, unless another is asked for."""
    motion: Motion = field(default_factory=Motion)
    """What pictures, tables and figures show of the object's slip."""
    page: str | None = None
    """What is written by hand of its environment's documentation: see `slipgym.envs.docstring`."""

    def __post_init__(self) -> None:
        try:
            _ = self.name
        except Error as error:
            raise ValueError(f"id = {self.id!r}: {error}") from error

    @cached_property
    def name(self) -> str:
        """Name in the environment's id."""
        return parse_env_id(self.id)[1]

    @cached_property
    def terms(self) -> tuple[str, ...]:
        """Names of the reward terms."""
        return tuple(term.name for term in self.reward)

    @property
    def defaults_with_scales(self) -> dict[str, Any]:
        """Every value of the task's group in the configuration."""
        scales = {term.name: term.scale for term in self.reward}
        return {**dict.fromkeys(("object", "mass_range", "radius")), **self.defaults, "reward": scales}
