"""The model of an imitation: task, observation of the network, its size, rounds and optimisation."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import BeforeValidator, Field, field_validator, model_validator

from policies.task_names import canonical
from policies.training import seeds
from policies.training.config import Environment
from slipgym.config.base import Count, Frozen, Positive, as_tuple
from slipgym.config.yaml_model import Choice, read_model
from slipgym.envs.actions import LOGARITHMIC

FOLDER = "imitation"
"""Folder of the default configuration that holds them."""


class Imitation(Frozen):
    """An imitation: the arguments of its environments, the network, rounds of episodes and updates."""

    task: str = Field(default="PlanarSlip", description="Task, as `slipgym.tasks.find` takes it")
    environment: Environment = Field(
        default=Environment(friction_source="none", frame_skip=2),
        description="Keyword arguments of the environment; friction_source: what the network observes",
    )
    teacher: Literal["truth", "estimate", "revealed"] = Field(
        default="truth",
        description='Friction that the controller is given: the true one, the estimate, or "revealed", the '
        "true one from the time on at which the estimate has confidence [-]",
    )
    memory: int = Field(ge=0, le=1024, description="Units of the LSTM layer; 0: a network without memory [-]")
    layers: Annotated[tuple[Count, ...], BeforeValidator(as_tuple), Field(max_length=8)] = Field(
        description="Sizes of the dense layers behind it [-]"
    )
    squash: bool = Field(
        default=False,
        description="Whether a tanh bounds the actions: outputs are then about the logarithm of a force [-]",
    )
    rounds: Count = Field(
        default=8, description="Rounds of episodes; in the first one the controller acts [-]"
    )
    rows: Count = Field(default=128, le=4096, description="Episodes of a round [-]")
    controlled: float = Field(
        default=0.25,
        ge=0.0,
        le=1.0,
        description="Fraction of later rounds' rows where the controller acts [-]",
    )
    updates: Count = Field(default=400, description="Steps of the optimiser in a round [-]")
    batch: Count = Field(default=32, description="Episodes of each [-]")
    learning_rate: Positive = Field(default=2e-3, description="Largest step size; it falls as a cosine [-]")
    held_out: int = Field(
        default=256, ge=0, description="Held-out episodes that the result is evaluated on [-]"
    )
    threads: Count = Field(default=1, description="Threads of torch [-]")

    @field_validator("task")
    @classmethod
    def _task_exists(cls, name: str) -> str:
        return canonical(name)

    @model_validator(mode="after")
    def _is_seen(self) -> Self:
        given = self.environment
        if given.history:
            raise ValueError("environment.history must be 0: the LSTM layer is the network's memory")
        if self.teacher != "truth" and given.friction_source not in ("none", "estimated"):
            raise ValueError(f"teacher {self.teacher!r} needs environment.friction_source none or estimated")
        if self.teacher != "truth" and given.estimator is None:
            raise ValueError(f"teacher {self.teacher!r} acts on estimates: environment.estimator is null")
        if given.observation_mode == "sensor":
            flat = "must be 'flat'; friction_source 'none' shows sensors"
            raise ValueError(f"environment.observation_mode {flat}")
        if not (given.action_mode or LOGARITHMIC).startswith(LOGARITHMIC):
            own = "null, the controller's, or the same with a logarithmic grip"
            raise ValueError(f"environment.action_mode must be {own}")
        if self.rounds * self.rows > seeds.ROWS:
            raise ValueError(f"rounds * rows = {self.rounds * self.rows} episodes; at most {seeds.ROWS}")
        return self


def read(choice: Choice) -> Imitation:
    """Reads an imitation: the name of a file in configs/imitation, path of a YAML file, or a mapping.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: A key or value is wrong; the message names file, key and what is valid.
    """
    return read_model(choice, Imitation, FOLDER, "imitation")
