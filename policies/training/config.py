"""The model of a training run: task, algorithm, environment, budget, evaluation."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self, TypeAlias

from pydantic import BeforeValidator, Field, create_model, field_validator, model_validator

from estimator.reference import is_reference
from policies.task_names import canonical
from policies.training import seeds
from policies.training.algorithms import PPO, SAC, TQC, PrivilegedPPO, RecurrentPPO
from slipgym.config import load
from slipgym.config.base import Count, Frozen, Positive, as_name, as_tuple
from slipgym.config.errors import unknown
from slipgym.config.load import Content, merge, randomization_content
from slipgym.config.yaml_model import file_content
from slipgym.envs.arguments import CommonArguments, fields
from slipgym.registration import ENVIRONMENTS
from slipgym.tasks import configure, find

Algorithm: TypeAlias = Literal["ppo", "recurrent_ppo", "sac", "tqc", "privileged_ppo"]


_DIFFERENT: dict[str, Any] = {"randomization": "train", "config": {}}
"""Arguments with another default than that of the environment."""
_TYPES: dict[str, Any] = {
    "observation_mode": Literal["flat", "deviations", "sensor"],
    "randomization": Annotated[str | Mapping[str, Any], BeforeValidator(randomization_content)],
    "level": Annotated[str | Mapping[str, Any], BeforeValidator(file_content)],
    "config": Content,
    "history": Annotated[int, Field(le=1024)],
}
"""Arguments of another type: a policy's file holds plain data and so long a history; it gets no privileged
group."""
_FIELDS: dict[str, Any] = {
    name: (
        _TYPES.get(name, field.annotation),
        Field(default=_DIFFERENT.get(name, field.default), ge=field.least, description=field.text),
    )
    for name, field in fields(CommonArguments).items()
}
_Arguments: Any = create_model("_Arguments", __base__=Frozen, **_FIELDS)


class Environment(_Arguments):
    """Keyword arguments of the environment, as `slipgym.envs.arguments` declares them."""

    _a_name = field_validator("friction_source", mode="before")(as_name)

    @model_validator(mode="after")
    def _known(self) -> Self:
        materials = ("random", *load(self.config, self.sensors, self.contact).materials)
        if self.material not in materials:
            raise ValueError(unknown("material", self.material, materials))
        return self


class Normalisation(Frozen):
    """Running mean and variance; they are part of a checkpoint."""

    observation: bool = Field(default=True, description="Whether observations are normalised [-]")
    reward: bool = Field(default=True, description="Whether rewards are scaled by their return's spread [-]")
    clip: Positive = Field(default=10.0, description="Normalised values are clipped here [-]")


class Evaluation(Frozen):
    """Episodes without exploration, on seeds that no training uses."""

    every: Count = Field(default=50_000, description="Steps between two evaluations [-]")
    episodes: Count = Field(default=40, description="Episodes of each [-]")
    first_seed: int = Field(default=0, ge=0, lt=seeds.HELD_OUT, description="First of the held-out seeds [-]")


class Stop(Frozen):
    """Conditions that end a run before its budget."""

    success: float | None = Field(default=None, ge=0, le=1, description="Share of episodes solved [-]")
    evaluations: Count = Field(default=2, description="As many evaluations in a row must reach it [-]")


class Checkpoints(Frozen):
    """Checkpoints of a run that may be interrupted."""

    every: Count = Field(default=50_000, description="Steps between two checkpoints [-]")
    keep: Count = Field(default=2, description="As many of the last are kept, besides the best [-]")


class Dimension(Frozen):
    """Values a sweep may try: numbers between two ends, or choices."""

    low: float | int | None = Field(default=None, description="Smallest value [-]")
    high: float | int | None = Field(default=None, description="Largest value [-]")
    log: bool = Field(default=False, description="Whether equal ratios are equally likely [-]")
    choices: Annotated[tuple[Any, ...], BeforeValidator(as_tuple)] = Field(
        default=(), description="Values to choose from, instead of low and high [-]"
    )

    @model_validator(mode="after")
    def _either(self) -> Self:
        ends = self.low is not None, self.high is not None
        if all(ends) == bool(self.choices) or any(ends) != all(ends):
            raise ValueError("give either low and high or choices")
        if all(ends) and not (0 if self.log else float("-inf")) < self.low <= self.high:  # type: ignore[operator]
            raise ValueError(
                f"low = {self.low!r} must not exceed high = {self.high!r}, nor 0 where log is true"
            )
        return self


class Training(Frozen):
    """A training run, but for its seed."""

    task: str = Field(description="Task of the environment; one of your own: module:attribute [-]")
    algorithm: Algorithm = Field(default="ppo", description="What learns [-]")
    budget: Count = Field(description="Steps of all environments together [-]")
    num_envs: int = Field(default=8, ge=1, le=seeds.ROWS, description="Environments side by side [-]")
    engine: Literal["planar", "bullet"] = Field(
        default="planar", description="What moves the bodies: a compiled batch, or PyBullet [-]"
    )
    engine_threads: Count | None = Field(
        default=None, description="Threads that share the batch; null: as many as processors [-]"
    )
    processes: bool = Field(
        default=False, description="Whether each environment of PyBullet has its own process [-]"
    )
    threads: Count = Field(default=1, description="Threads of torch [-]")
    vary: Mapping[str, Annotated[list[Any], Field(min_length=1)]] = Field(
        default={}, description="Options of reset; environment i always has combination i modulo their number"
    )
    spread: bool = Field(
        default=False,
        description="Whether the batch begins to learn with its environments spread over their episodes [-]",
    )
    environment: Environment = Field(default=Environment(), description="The environment [-]")
    shaping: Mapping[str, Any] = Field(
        default={},
        description="Overrides of the environment's config where it learns; not where it is evaluated [-]",
    )
    derived: Mapping[str, Mapping[str, float]] = Field(
        default={},
        description="Columns that the learner reads in addition: name -> column of the observation -> factor",
    )
    normalisation: Normalisation = Field(default=Normalisation(), description="Of what is learned from [-]")
    evaluation: Evaluation = Field(default=Evaluation(), description="How progress is measured [-]")
    stop: Stop = Field(default=Stop(), description="When a run ends early [-]")
    checkpoints: Checkpoints = Field(default=Checkpoints(), description="What is kept meanwhile [-]")
    ppo: PPO = Field(default=PPO(), description="Hyperparameters of ppo [-]")
    recurrent_ppo: RecurrentPPO = Field(default=RecurrentPPO(), description="Those of recurrent_ppo [-]")
    privileged_ppo: PrivilegedPPO = Field(default=PrivilegedPPO(), description="Those of privileged_ppo [-]")
    sac: SAC = Field(default=SAC(), description="Those of sac [-]")
    tqc: TQC = Field(default=TQC(), description="Those of tqc [-]")
    sweep: Mapping[str, Dimension] = Field(
        default={}, description="What a sweep tries, by dotted key as in --set [-]"
    )

    @field_validator("task")
    @classmethod
    def _task_exists(cls, name: str) -> str:
        if find(name).id not in ENVIRONMENTS and not is_reference(name):
            raise ValueError(f"name {name!r}, a task of your own, as module:attribute")
        return canonical(name)

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        if self.derived and self.algorithm not in ("ppo", "privileged_ppo"):
            raise ValueError("derived needs algorithm 'ppo' or 'privileged_ppo'")
        trained, chosen = [self.environment, self.shaped], self.privileged_ppo
        if self.algorithm == "privileged_ppo":
            if self.engine != "planar" or self.environment.observation_mode == "sensor":
                raise ValueError(
                    "privileged_ppo needs engine 'planar' and observation_mode 'flat' or 'deviations'"
                )
            rows = self.num_envs if chosen.memory else self.num_envs * chosen.n_steps
            if chosen.n_minibatches > rows:
                raise ValueError(
                    f"privileged_ppo.n_minibatches = {chosen.n_minibatches} must not exceed {rows}"
                )
            trained += [self.at_stage(stage).shaped for stage in range(len(chosen.curriculum.stages))]
        if self.spread and self.engine != "planar":
            raise ValueError("spread needs engine 'planar'")
        for options in self.combinations():
            find(self.task).options.parse(options)
        key = find(self.task).key
        for overrides in (self.shaping, *chosen.curriculum.stages):
            tasks = overrides.get("tasks")
            others = [name for name in tasks if name != key] if isinstance(tasks, Mapping) else []
            for name in others:
                raise ValueError(f"shaping and stages are of the run's task: {unknown('task', name, [key])}")
        for environment in trained:
            configure(find(self.task), environment.config, environment.sensors, environment.contact)
        return self

    @property
    def shaped(self) -> Environment:
        """The environment in which it learns."""
        values = self.environment.model_dump()
        values["config"] = merge(values["config"], self.shaping)
        return Environment.model_validate(values)

    def at_stage(self, stage: int) -> Training:
        """The run in a stage of its curriculum; from the number of stages on, the run itself."""
        stages = self.privileged_ppo.curriculum.stages
        overrides = stages[stage] if stage < len(stages) else {}
        return self.model_copy(update={"shaping": merge(self.shaping, overrides)})

    def without_start(self) -> Training:
        """The run on from a checkpoint: it needs the policy that its actor started as no more."""
        chosen = self.privileged_ppo.model_copy(update={"start": None})
        return self.model_copy(update={"privileged_ppo": chosen})

    def combinations(self) -> list[dict[str, Any]]:
        """Every combination of the options of reset that vary; without any, a single empty one."""
        every = itertools.product(*self.vary.values())
        return [dict(zip(self.vary, values, strict=True)) for values in every]

    @property
    def hyperparameters(self) -> PPO | SAC | PrivilegedPPO:
        """Those of the algorithm."""
        return getattr(self, self.algorithm)
