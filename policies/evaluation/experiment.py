"""The model of an experiment: task, policies, friction sources, trials.

Policies are compared at the same rate of action only: in some tasks a controller collects more at 60 than at
120 actions a second. So all policies of a comparison act every `frame_skip` control steps.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Annotated, Any, Self

from pydantic import BeforeValidator, Field, field_validator, model_validator

import estimator as estimators
import policies
from policies.learned import read_description
from policies.learned.pretrained import locate
from policies.task_names import canonical
from slipgym import config as configuration
from slipgym.config.base import Count, Frozen, as_name, as_tuple
from slipgym.config.errors import unknown
from slipgym.config.level import DEFAULT as DEFAULT_LEVEL
from slipgym.config.level import load_level
from slipgym.config.load import Content, randomization_content
from slipgym.config.yaml_model import file_content
from slipgym.envs.arguments import DEFAULT_ESTIMATOR, ENGINES, FRICTION_SOURCES, one_of
from slipgym.envs.engines import resolved
from slipgym.tasks import configure, find
from slipgym.tasks.configure import recorded


def frame_skip_of(name: str) -> int | None:
    """Control steps per action that a policy was trained with; None for a controller, which takes any.

    Raises:
        FileNotFoundError: There is no policy at the path.
        ValueError: What lies there is no policy.
    """
    if policies.is_controller(name):
        return None
    return int(read_description(locate(name)).environment.arguments.get("frame_skip", 1))  # type: ignore[arg-type]


def common_frame_skip(names: Iterable[str], asked: int | None = None) -> int:
    """Control steps per action at which policies can be compared.

    Args:
        names: Of the policies, as `policies.load` takes them.
        asked: What the comparison asks for; None: what the learned policies need, 1 without any.

    Raises:
        ValueError: Two policies need different ones, or one needs another than asked for.
    """
    needed = {name: skip for name in names if (skip := frame_skip_of(name)) is not None}
    found = {*needed.values(), *([] if asked is None else [asked])}
    if len(found) > 1:
        each = ", ".join(f"{name} {skip}" for name, skip in needed.items())
        raise ValueError(
            f"policies are compared at the same rate of action only; frame_skip of the training: {each}"
            + ("" if asked is None else f"; asked for: {asked}")
        )
    return found.pop() if found else 1


class PolicyChoice(Frozen):
    """A policy of `policies.load`."""

    name: str = Field(description="Its name, the folder of a learned one, or module:class [-]")
    parameters: Mapping[str, Any] = Field(default={}, description="Its parameters [-]")
    label: str = Field(default="", description="How tables and figures call it; empty: by its name [-]")
    friction: Annotated[tuple[str, ...], BeforeValidator(as_tuple)] = Field(
        default=(), description="Labels of the friction choices that it acts with; empty: all [-]"
    )
    frame_skip: Count | None = Field(
        default=None, description="Control steps per action of its own; null: the experiment's [-]"
    )

    @model_validator(mode="after")
    def _exists(self) -> Self:
        if Path(self.name).is_dir():
            policies.load(self.name, **self.parameters)
        elif policies.is_controller(self.name):
            policies.find(self.name)
        elif self.name not in policies.names():
            message = unknown("policy", self.name, policies.names())
            raise ValueError(f"{message}; or the folder of a learned one, or module:class")
        if self.frame_skip is not None:
            common_frame_skip([self.name], self.frame_skip)
        return self

    @property
    def title(self) -> str:
        """Name in tables and figures."""
        return self.label or Path(self.name).name


def _named(value: object) -> object:
    """A name alone as the mapping that it stands for."""
    return {"name": value} if isinstance(value, str) else value


class FrictionChoice(Frozen):
    """Friction information of a policy."""

    source: Annotated[str, BeforeValidator(as_name)] = Field(
        description="friction_source of the environment [-]"
    )
    estimator: Annotated[Mapping[str, Any] | None, BeforeValidator(_named)] = Field(
        default={"name": DEFAULT_ESTIMATOR},
        description="Name of the estimator, or a mapping of it and its parameters; null: none [-]",
    )

    label: str = Field(
        default="", description="How tables and figures call it; empty: by source and estimator [-]"
    )

    @model_validator(mode="after")
    def _exists(self) -> Self:
        if self.source not in FRICTION_SOURCES:
            raise ValueError(unknown("friction source", self.source, FRICTION_SOURCES))
        if parameters := self.argument:
            estimators.make(parameters.pop("name", ""), **parameters)
        return self

    @property
    def title(self) -> str:
        """Name in tables and figures: the label, or the source and an estimator other than the default."""
        name = (self.estimator or {}).get("name", DEFAULT_ESTIMATOR)
        return self.label or (self.source if name == DEFAULT_ESTIMATOR else f"{self.source}, {name}")

    @property
    def argument(self) -> dict[str, Any] | None:
        """The environment's argument `estimator`."""
        return None if self.estimator is None else dict(self.estimator)


class Experiment(Frozen):
    """Policies × friction × materials × options, each cell with a number of trials."""

    name: str = Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*$", description="Names the run folder [-]")
    task: str = Field(description="Task of the environment; one of your own as module:attribute [-]")
    seed: int = Field(default=0, ge=0, description="All randomness follows from it [-]")
    trials: Count = Field(description="Trials in each cell [-]")
    policies: Annotated[tuple[PolicyChoice, ...], BeforeValidator(as_tuple), Field(min_length=1)] = Field(
        description="The policies to compare [-]"
    )
    friction: Annotated[tuple[FrictionChoice, ...], BeforeValidator(as_tuple), Field(min_length=1)] = Field(
        description="Friction information; the first is the one compared with [-]"
    )
    materials: Annotated[tuple[str, ...], BeforeValidator(as_tuple), Field(min_length=1)] = Field(
        default=("random",), description='Materials, or "random" [-]'
    )
    options: Mapping[str, Any] = Field(default={}, description="Options of reset, for all trials [-]")
    vary: Mapping[str, list[Any]] = Field(
        default={}, description="Options of reset to try: every combination is a cell [-]"
    )
    sensors: str = Field(default="realistic", description="Sensor preset [-]")
    engine: str = Field(
        default="auto",
        validate_default=True,
        description="What moves the bodies: bullet, planar or auto, PyBullet where it is installed [-]",
    )
    randomization: Annotated[str | Mapping[str, Any], BeforeValidator(randomization_content)] = Field(
        default="none", description="What is drawn per episode: a preset, a file or a mapping [-]"
    )
    level: Annotated[str | Mapping[str, Any], BeforeValidator(file_content)] = Field(
        default=DEFAULT_LEVEL, description="Level of difficulty: a name, a file or a mapping [-]"
    )
    frame_skip: Count | None = Field(
        default=None,
        description="Control steps per action; null: as of the learned policies, or 1 [-]",
    )
    config: Content = Field(default={}, description="Overrides of the configuration [-]")

    @field_validator("task")
    @classmethod
    def _task_exists(cls, name: str) -> str:
        return canonical(name)

    @field_validator("engine")
    @classmethod
    def _engine_exists(cls, name: str) -> str:
        return resolved(one_of("engine", name, ENGINES))

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        for kind in ("policies", "friction"):
            titles = [choice.title for choice in getattr(self, kind)]
            if len(set(titles)) < len(titles):
                raise ValueError(f"{kind} needs distinct labels, got {', '.join(titles)}")
        titles = [choice.title for choice in self.friction]
        for name in (name for policy in self.policies for name in policy.friction):
            if name not in titles:
                raise ValueError(unknown("friction of this experiment", name, titles))
        configuration.load_randomization(self.randomization)
        load_level(self.level, find(self.task).key)
        known = self.environment_config().materials
        for material in self.materials:
            if material not in ("random", *known):
                raise ValueError(unknown("material", material, ["random", *known]))
        varied = {f"vary.{name}": values for name, values in self.vary.items()}
        for name, values in {"materials": self.materials, **varied}.items():
            if not values or len(set(map(repr, values))) < len(values):
                raise ValueError(f"{name} = {list(values)}: expected values, each once")
        if "material" in {**self.options, **self.vary}:
            raise ValueError("materials are listed under materials, not among the options")
        for options in self.combinations():
            find(self.task).options.parse(options)
        _ = self.steps_per_action
        return self

    @property
    def steps_per_action(self) -> int:
        """Control steps per action, the same for every policy without a `frame_skip` of its own.

        Raises:
            ValueError: The learned policies were trained with different ones, or not with `frame_skip`.
        """
        names = (policy.name for policy in self.policies if policy.frame_skip is None)
        return common_frame_skip(names, self.frame_skip)

    @property
    def arguments(self) -> dict[str, Any]:
        """Keyword arguments that the environments of all its trials have in common, on any engine."""
        same = {name: getattr(self, name) for name in ("sensors", "randomization", "level")}
        return {**same, "config": dict(self.config)}

    def frame_skip_of(self, policy: PolicyChoice) -> int:
        """Control steps per action of one of its policies."""
        return policy.frame_skip or self.steps_per_action

    def environment_config(self) -> configuration.Config:
        """The environment's configuration with this experiment's overrides, without the task's settings."""
        return configure(find(self.task), self.config, self.sensors)[0]

    def configured(self) -> tuple[configuration.Config, Any]:
        """Configuration and settings of the environment."""
        task = find(self.task)
        return configure(task, self.config, self.sensors, level=load_level(self.level, task.key))

    def recorded(self) -> dict[str, Any]:
        """Configuration and settings of the environment as plain data, in the shape of overrides."""
        return recorded(*self.configured(), find(self.task).key)

    def combinations(self) -> list[dict[str, Any]]:
        """Options of reset of each cell."""
        return [
            {**self.options, **dict(zip(self.vary, values, strict=True))}
            for values in itertools.product(*self.vary.values())
        ]
