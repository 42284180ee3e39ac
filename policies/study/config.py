"""Defines the content of a study's file, and reads it."""

from __future__ import annotations

import os
from typing import Annotated, Any, Literal, Self, TypeAlias

from pydantic import BeforeValidator, Field, field_validator, model_validator

from policies.evaluation.experiment import FrictionChoice
from policies.task_names import canonical
from slipgym.config import load_randomization
from slipgym.config.base import Count, Frozen, Positive, PositiveInterval, as_name, as_tuple
from slipgym.config.errors import unknown
from slipgym.config.level import DEFAULT as DEFAULT_LEVEL
from slipgym.config.level import load_level
from slipgym.config.load import Content
from slipgym.config.physics import ContactModel
from slipgym.config.yaml_model import names, read_model, validate
from slipgym.tasks import find

Kind: TypeAlias = Literal["classic", "memory", "recurrent", "learned", "imitation"]
Source: TypeAlias = Annotated[Literal["none", "nominal", "estimated", "true"], BeforeValidator(as_name)]
SOURCES: tuple[Source, ...] = ("none", "nominal", "estimated", "true")
BLOCKS_MAX = 1000

Names = Annotated[tuple[str, ...], BeforeValidator(as_tuple)]
Sources = Annotated[tuple[Source, ...], BeforeValidator(as_tuple)]
Levels = Annotated[tuple[float, ...], BeforeValidator(as_tuple)]


class World(Frozen):
    """Engine and contact of episodes."""

    label: str = Field(min_length=1, description="How tables and figures call it [-]")
    engine: Literal["bullet", "planar"] = Field(description="What moves the bodies [-]")
    contact: ContactModel = Field(description="Friction model [-]")
    presets: Names = Field(default=(), description="Presets to run here; none given: all of the study [-]")
    sources: Sources = Field(default=SOURCES, description="Friction sources to run here [-]")
    estimators: Names = Field(default=(), description="Estimators to run here; none given: all [-]")


class Degradation(Frozen):
    """One thing at a time gets worse; everything else is as the preset says."""

    world: str = Field(description="Label of the world [-]")
    preset: str = Field(default="train", description="Preset that is changed [-]")
    episodes: Count = Field(description="Episodes in each block [-]")
    sources: Sources = Field(default=SOURCES, description="Friction sources to run [-]")
    noise_scale: Levels = Field(default=(), description="White noise of all sensors over the configured [-]")
    slip_latency: Levels = Field(default=(), description="Age of a slip velocity when it arrives [samples]")
    friction_jump: Levels = Field(default=(), description="Friction after over before a jump [-]")
    jump_time: PositiveInterval = Field(default=(2.5, 3.5), description="When friction jumps [s]")


class Study(Frozen):
    """Policies x friction sources x estimators x tasks x presets x worlds."""

    name: str = Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*$", description="Names the study's folder [-]")
    seed: int = Field(default=0, ge=0, description="All randomness follows from it [-]")
    blocks: Annotated[int, Field(ge=1, le=BLOCKS_MAX)] = Field(
        default=3, description="Blocks of episodes; the k-th seed of a learned policy acts in the k-th [-]"
    )
    episodes: Count = Field(description="Episodes in each block [-]")
    tasks: Annotated[Names, Field(min_length=1)] = Field(description="Tasks [-]")
    kinds: Annotated[tuple[Kind, ...], BeforeValidator(as_tuple), Field(min_length=1)] = Field(
        default=("classic", "learned"), description="Kinds of policies [-]"
    )
    learned: str = Field(default="", description="Folder of learned policies; empty: those shipped [-]")
    imitation: str = Field(default="", description="Folder of the runs of `slipgym imitate` [-]")
    estimators: Annotated[Names, Field(min_length=1)] = Field(
        default=("disc",), description="Estimators; the first is the main one [-]"
    )
    presets: Annotated[Names, Field(min_length=1)] = Field(
        default=("train", "eval_ood"), description="Presets of randomization; the first is the main one [-]"
    )
    level: str = Field(default=DEFAULT_LEVEL, description="Level of difficulty [-]")
    sensors: str = Field(default="realistic", description="Sensor preset [-]")
    worlds: Annotated[tuple[World, ...], BeforeValidator(as_tuple), Field(min_length=1)] = Field(
        description="Worlds; the first is the main one [-]"
    )
    degradation: Degradation | None = Field(default=None, description="What gets worse step by step [-]")
    videos: Names = Field(default=(), description="Tasks that the report shows videos of [-]")
    video_speed: Positive = Field(default=1.0, description="Of the videos over the real one [-]")
    config: Content = Field(default={}, description="Overrides of the configuration [-]")

    @field_validator("tasks", "videos")
    @classmethod
    def _tasks_exist(cls, names: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(canonical(name) for name in names)

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        for preset in self.presets:
            load_randomization(preset)
        for task in self.tasks:
            load_level(self.level, find(task).key)
        for name in self.estimators:
            FrictionChoice(source="estimated", estimator={"name": name})
        for kind in ("tasks", "kinds", "estimators", "presets", "videos"):
            _distinct(kind, getattr(self, kind))
        _distinct("labels of worlds", [world.label for world in self.worlds])
        for world in self.worlds:
            _among("preset", world.presets, self.presets)
            _among("estimator", world.estimators, self.estimators)
        _among("task", self.videos, self.tasks)
        if "imitation" in self.kinds and not self.imitation:
            raise ValueError("kind 'imitation' needs the folder `imitation`; slipgym imitate fills one")
        if self.degradation is not None:
            load_randomization(self.degradation.preset)
            _among("world", [self.degradation.world], [world.label for world in self.worlds])
        return self


def _distinct(what: str, names: Any) -> None:
    if len(set(names)) < len(names):
        raise ValueError(f"{what} must differ, got {', '.join(names)}")


def _among(what: str, names: Any, valid: Any) -> None:
    for name in names:
        if name not in valid:
            raise ValueError(unknown(f"{what} of this study", name, valid))


_FOLDER = "studies"


def study_names() -> list[str]:
    """Names of the studies that come with slipgym."""
    return names(_FOLDER)


def load_study(which: str | os.PathLike[str]) -> Study:
    """Reads a study: one of `study_names()`, or the YAML file at a path.

    Raises:
        FileNotFoundError: It looks like a path, but there is no such file.
        ValueError: The name is unknown, or the file holds a wrong key or value.
    """
    return read_model(which, Study, _FOLDER, "study")


def narrowed(study: Study, **changes: Any) -> Study:
    """The study with other values; what is None or empty stays. The degradation has no more episodes.

    Raises:
        ValueError: A value is not allowed.
    """
    given = {key: value for key, value in changes.items() if value not in (None, "", (), [])}
    for kind in ("learned", "imitation"):
        if kind in given and kind not in given.get("kinds", study.kinds):
            raise ValueError(f"{kind} = {given[kind]!r}: {study.name} has no policies of the kind {kind!r}")
    if "tasks" in given:
        given["tasks"] = [find(task).name for task in given["tasks"]]
        given["videos"] = [task for task in study.videos if task in given["tasks"]]
    if "episodes" in given and study.degradation is not None:
        fewer = {"episodes": min(given["episodes"], study.degradation.episodes)}
        given["degradation"] = study.degradation.model_copy(update=fewer)
    return validate({**dict(study), **given}, Study, study.name)
