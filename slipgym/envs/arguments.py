"""Declares the keyword arguments of the environments, each once: type, default, choices and meaning.

Signatures, docstrings, pages, checks and the arguments that a state records are derived from the fields of
`ScalarArguments` and `VectorArguments`.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from types import NoneType
from typing import Annotated, Any, Literal, TypeAlias, TypedDict, get_args, get_origin, get_type_hints

from gymnasium.vector import AutoresetMode

import estimator as estimators
from slipgym.config.base import plain
from slipgym.config.errors import unknown
from slipgym.config.level import DEFAULT as DEFAULT_LEVEL
from slipgym.config.physics import ContactModel

FrictionSource: TypeAlias = Literal["estimated", "true", "nominal", "none"]
ActionMode: TypeAlias = Literal[
    "grip_force", "grip_force_pitch", "grip_force_translation", "grip_force_wrist", "grip_force_wrist_guess",
    "force_increment", "log_grip_force", "log_grip_force_pitch", "log_grip_force_translation",
    "log_grip_force_wrist", "log_grip_force_wrist_guess",
]  # fmt: skip
ObservationMode: TypeAlias = Literal["flat", "deviations", "sensor", "dict", "deviations_dict"]
Engine: TypeAlias = Literal["auto", "bullet", "planar"]

FRICTION_SOURCES: tuple[str, ...] = get_args(FrictionSource)
OBSERVATION_MODES: tuple[str, ...] = get_args(ObservationMode)
ENGINES: tuple[str, ...] = get_args(Engine)

DEFAULT_ESTIMATOR = estimators.DEFAULT


@dataclass(frozen=True)
class Argument:
    """Metadata of a keyword argument, beside its type."""

    default: Any
    doc: str
    """Its meaning, in Markdown."""
    least: int | None = None
    most: int | None = None
    """Smallest and largest value, of an argument that is a whole number."""


RenderSize: TypeAlias = Annotated[
    tuple[int, int] | None,
    Argument(
        None, "width and height of what `render` shows, in pixels; `None`: 720 and 480 (docs/rendering.md)",
        least=32, most=4096,
    ),
]  # fmt: skip


class CommonArguments(TypedDict, total=False):
    """Keyword arguments of both kinds of environment."""

    friction_source: Annotated[
        FrictionSource, Argument("estimated", "source of the friction part of the observation")
    ]
    estimator: Annotated[
        str | Mapping[str, Any] | None,
        Argument(
            DEFAULT_ESTIMATOR,
            "a name of `estimator.names()`, or a mapping with its `name` and parameters; `None`: none "
            "(see docs/modes.md)",
        ),
    ]
    contact: Annotated[
        ContactModel, Argument("ellipsoid", "friction model of the pads (see docs/contact.md)")
    ]
    sensors: Annotated[str, Argument("realistic", "sensor preset (see docs/sensors.md)")]
    material: Annotated[
        str, Argument("random", 'name of a material, or `"random"` for another in every episode')
    ]
    action_mode: Annotated[
        ActionMode | None, Argument(None, "meaning of an action (see docs/modes.md); `None`: the task's own")
    ]
    observation_mode: Annotated[
        ObservationMode, Argument("flat", "layout of an observation (see docs/modes.md)")
    ]
    load_columns: Annotated[bool, Argument(False, "whether observations have the load part (docs/modes.md)")]
    history: Annotated[
        int, Argument(0, "number of earlier observations in each observation", least=0, most=1000)
    ]
    randomization: Annotated[
        str | os.PathLike[str] | Mapping[str, Any],
        Argument(
            "none",
            'parameters sampled per episode: `"none"`, `"train"`, `"lab"`, `"eval_ood"`, a file or a mapping '
            "(see docs/randomization.md)",
        ),
    ]
    level: Annotated[
        str | os.PathLike[str] | Mapping[str, Any],
        Argument(
            DEFAULT_LEVEL,
            'difficulty: `"easy"`, `"standard"`, `"hard"`, a file or a mapping (see docs/levels.md); '
            "`config` and reset options replace its settings, it replaces parts of `randomization`",
        ),
    ]
    end_at_violation: Annotated[bool, Argument(False, "whether a violation terminates the episode")]
    frame_skip: Annotated[
        int,
        Argument(
            1, "control steps per step; the action is repeated, the rewards are summed", least=1, most=10_000
        ),
    ]
    config: Annotated[
        str | os.PathLike[str] | Mapping[str, Any] | None,
        Argument(None, "file or mapping of overrides, merged over the defaults in `configs/`"),
    ]


class ScalarArguments(CommonArguments, total=False):
    """Keyword arguments of a `SlipEnv`."""

    engine: Annotated[
        Engine,
        Argument("auto", "engine that moves the bodies (see docs/batch.md); auto: PyBullet if installed"),
    ]
    render_mode: Annotated[
        Literal["human", "rgb_array", "depth_array"] | None,
        Argument(None, "output of `render` (see docs/rendering.md)"),
    ]
    render_size: RenderSize


class VectorArguments(CommonArguments, total=False):
    """Keyword arguments of a `SlipVectorEnv`."""

    num_envs: Annotated[int, Argument(1, "number of environments", least=1, most=2**20)]
    autoreset_mode: Annotated[
        Literal["NextStep", "SameStep", "Disabled"] | AutoresetMode,
        Argument(
            "NextStep",
            'when to reset an environment whose episode has ended; with `"Disabled"`, '
            '`reset(options={"reset_mask": ...})` is up to the caller',
        ),
    ]
    threads: Annotated[
        int | None,
        Argument(
            None, "threads that share the environments; `None`: one per processor, each with at least 32"
        ),
    ]
    max_episode_steps: Annotated[
        int | None,
        Argument(
            None, "steps after which an episode is truncated, if it has not ended; `None`: its own length", 1
        ),
    ]
    render_mode: Annotated[
        Literal["rgb_array", "depth_array"] | None, Argument(None, "output of `render`; `None`: nothing")
    ]
    render_size: RenderSize
    render_rows: Annotated[
        Sequence[int] | None,
        Argument(
            None, "environments that `render` shows, in this order; `None`: all, or the first of more than 16"
        ),
    ]


@dataclass(frozen=True, kw_only=True)
class Field(Argument):
    """A keyword argument."""

    name: str
    annotation: Any
    """Its type, without the `Argument`."""
    choices: tuple[str, ...]
    """The valid names, where they are fixed."""
    optional: bool
    """Whether it may be None."""

    @property
    def text(self) -> str:
        """Meaning and choices."""
        listed = ", ".join(f'`"{choice}"`' for choice in self.choices)
        return f"{self.doc}; one of {listed}" if listed else self.doc

    def check(self, value: Any) -> None:
        """Raise ValueError unless the value is allowed, as far as its type says."""
        if value is None and self.optional:
            return
        if self.choices and not (isinstance(value, AutoresetMode) and value.value in self.choices):
            one_of(self.name, value, self.choices)
        if self.annotation is bool and not isinstance(value, bool):
            raise ValueError(f"{self.name} = {value!r:.80} must be True or False")
        if any(get_origin(member) is tuple for member in get_args(self.annotation)):
            _check_pair(self.name, value, self.least or 0, self.most or 0)
        elif self.least is not None:
            whole(self.name, value, self.least, self.most)


@cache
def fields(kind: type) -> dict[str, Field]:
    """Name -> keyword argument, of `ScalarArguments`, `VectorArguments` or `CommonArguments`."""
    found = {}
    for name, hint in get_type_hints(kind, include_extras=True).items():
        annotation, given = get_args(hint)
        members = get_args(annotation) if get_origin(annotation) is not Literal else (annotation,)
        choices = [
            choice for member in members if get_origin(member) is Literal for choice in get_args(member)
        ]
        own = {"name": name, "annotation": annotation, "choices": tuple(choices)}
        found[name] = Field(**vars(given), **own, optional=NoneType in members)
    return found


def complete(kind: type, given: Mapping[str, Any]) -> dict[str, Any]:
    """All arguments of a kind, with their defaults; checked as far as their types say.

    Raises:
        TypeError: An argument is unknown.
        ValueError: The value of an argument is not allowed.
    """
    known = fields(kind)
    for name in given:
        if name not in known:
            raise TypeError(unknown("keyword argument", name, known))
    values = {name: plain(given.get(name, field.default)) for name, field in known.items()}
    for name, value in values.items():
        known[name].check(value)
    return values


def friction_part(friction_source: str, estimator: object) -> str:
    """Source of the friction part: "none" where it would be estimates, and there is no estimator."""
    return "none" if friction_source == "estimated" and estimator is None else friction_source


def one_of(name: str, value: object, valid: Iterable[str]) -> str:
    """Return `value` if it is one of the valid names, or raise ValueError."""
    if not isinstance(value, str) or value not in tuple(valid):
        raise ValueError(unknown(name, value, valid))
    return value


def whole(name: str, value: object, least: int, most: int | None = None) -> int:
    """Return `value` if it is a whole number from `least` to `most`, or raise ValueError."""
    if isinstance(value, bool) or not isinstance(value, int) or value < least:
        raise ValueError(f"{name} = {value!r:.80} must be a whole number >= {least}")
    if most is not None and value > most:
        raise ValueError(f"{name} = {value!r:.80} must be a whole number from {least} to {most}")
    return value


def _check_pair(name: str, value: object, least: int, most: int) -> None:
    given = value if isinstance(value, list | tuple) else ()
    if len(given) != 2 or not all(type(each) is int and least <= each <= most for each in given):
        valid = f"two whole numbers from {least} to {most}: width, height"
        raise ValueError(f"{name} = {value!r:.80} must be {valid}")
