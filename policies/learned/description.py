"""Content of policy.json: the environment a policy was trained in, its network, its origin."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Literal, Self

from pydantic import BeforeValidator, Field, JsonValue, field_validator, model_validator

from slipgym.config import names
from slipgym.config.base import Count, Frozen, Positive, as_tuple
from slipgym.config.errors import unknown

FORMAT = 1
"""The version of the format that is written and read here."""
WEIGHTS = "weights.safetensors"
"""What a policy needs to act."""
TRAINING = "training.safetensors"
"""All that training adapts, critics too; a policy acts without it."""

_Width = Annotated[int, Field(ge=1, le=8192)]
_Layers = Annotated[tuple[_Width, ...], BeforeValidator(as_tuple), Field(max_length=16)]
_Text = Annotated[str, Field(max_length=200)]

RENAMED_COLUMNS = {
    "support_mu_s": "confidence_mu_s",
    "support_mu_c": "confidence_mu_c",
    "support_r": "confidence_r",
    "travel_x": "measured_slip_x",
    "travel_y": "measured_slip_y",
    "travel_theta": "measured_slip_theta",
    "command": "commanded_force",
}
"""Name of a column in files of version 0.1.0 -> its present name."""


class Column(Frozen):
    """A number that a policy reads or gives."""

    name: _Text = Field(description="Its name [-]")
    low: float = Field(description="Lower bound; of an action: what -1 stands for [unit]")
    high: float = Field(description="Upper bound; of an action: what +1 stands for [unit]")
    unit: _Text = Field(description="Unit of the bounds [-]")

    @field_validator("name")
    @classmethod
    def _present_name(cls, name: str) -> str:
        return RENAMED_COLUMNS.get(name, name)


_Columns = Annotated[tuple[Column, ...], BeforeValidator(as_tuple), Field(min_length=1, max_length=1024)]


class Environment(Frozen):
    """The environment a policy was trained in."""

    id: str = Field(
        pattern=r"\A([A-Za-z0-9_-]+/)?[A-Za-z0-9_]+(-v[0-9]+)?\z",
        max_length=200,
        description="Its Gymnasium id, without a module to import [-]",
    )
    arguments: Mapping[str, JsonValue] = Field(description="Keyword arguments it was made with [-]")
    rate: Positive = Field(description="Steps per second [Hz]")
    history: int = Field(ge=0, le=1024, description="Earlier observations along with each [-]")
    observation: _Columns = Field(description="Columns of one observation, in order [-]")
    action: _Columns = Field(description="Components of an action, in order [-]")

    @field_validator("arguments")
    @classmethod
    def _names_no_files(cls, arguments: Mapping[str, JsonValue]) -> Mapping[str, JsonValue]:
        if "render_mode" in arguments:
            raise ValueError("'render_mode' is no part of what a policy was trained with")
        config, drawn = arguments.get("config"), arguments.get("randomization", "none")
        if config is not None and not isinstance(config, Mapping):
            raise ValueError(f"config = {config!r} must be a mapping; a policy names no files")
        if not isinstance(drawn, Mapping) and drawn not in names("randomization"):
            raise ValueError(unknown("randomization", drawn, names("randomization")))
        return arguments

    @property
    def width(self) -> int:
        """Numbers in an observation, earlier ones included."""
        return (self.history + 1) * len(self.observation)


class Memory(Frozen):
    """LSTM layers ahead of the dense ones."""

    size: _Width = Field(description="Units of each layer [-]")
    layers: int = Field(ge=1, le=16, description="How many [-]")


class Network(Frozen):
    """The network from observation to action."""

    kind: Literal["mlp", "lstm"] = Field(description="Dense layers, or LSTM layers ahead of them [-]")
    memory: Memory | None = Field(default=None, description="The LSTM layers of kind lstm [-]")
    layers: _Layers = Field(description="Sizes of the hidden dense layers [-]")
    activation: Literal["tanh", "relu", "elu"] = Field(description="Behind each hidden dense layer [-]")
    squash: bool = Field(description="Whether tanh bounds the action; it is clipped otherwise [-]")

    @model_validator(mode="after")
    def _has_the_memory_of_its_kind(self) -> Self:
        if (self.memory is not None) != (self.kind == "lstm"):
            raise ValueError("memory is needed for kind 'lstm', and only there")
        return self

    @classmethod
    def of(
        cls, memory: int, layers: Sequence[int], activation: str, squash: bool, stacked: int = 1
    ) -> Network:
        """One with `stacked` LSTM layers of `memory` units; 0: none."""
        lstm = {"size": memory, "layers": stacked} if memory else None
        dense = {"layers": layers, "activation": activation, "squash": squash}
        return cls.model_validate({"kind": "lstm" if lstm else "mlp", "memory": lstm, **dense})


class Normalisation(Frozen):
    """clip((observation - mean) / sqrt(var + epsilon), -clip, clip); mean and var are with the weights."""

    clip: Positive = Field(description="Largest size of a normalised number [-]")
    epsilon: Positive = Field(description="Added to the variance [unit^2]")


class Critic(Frozen):
    """Settings that rebuilding the model for more training needs besides the policy's own network."""

    layers: _Layers = Field(description="Sizes of the hidden layers [-]")
    count: Count = Field(default=1, le=64, description="How many critics (SAC, TQC) [-]")
    quantiles: Count = Field(default=1, le=8192, description="Quantiles of each (TQC) [-]")
    memory: Literal["own", "shared", "none"] = Field(default="none", description="Its LSTM layers [-]")


class Origin(Frozen):
    """Origin of a policy."""

    algorithm: Literal["PPO", "SAC", "TQC", "RecurrentPPO", "PrivilegedPPO", "DAgger"] = Field(
        description="What trained it [-]"
    )
    command: str = Field(max_length=10_000, description="The command that trained it [-]")
    steps: int = Field(ge=0, description="Steps of experience [-]")
    seeds: Annotated[tuple[int, ...], BeforeValidator(as_tuple), Field(max_length=1024)] = Field(
        description="Seeds of the training [-]"
    )
    versions: Mapping[str, str | None] = Field(description="Versions of what trained it [-]")
    cpu_seconds: float | None = Field(
        default=None, ge=0.0, description="Time of the processor that its run took; null: not known [s]"
    )
    critic: Critic | None = Field(default=None, description="With `training.safetensors` only [-]")


class Description(Frozen):
    """Content of policy.json."""

    format: Literal[1] = Field(description="Version of the format [-]")
    environment: Environment = Field(description="The environment it was trained in [-]")
    network: Network = Field(description="What turns an observation into an action [-]")
    normalisation: Normalisation | None = Field(description="Of observations; null: none [-]")
    residual: None = Field(default=None, description="Null; kept for files that have it [-]")
    origin: Origin = Field(description="How it came about [-]")
    files: Mapping[str, Annotated[str, Field(pattern=r"\A[0-9a-f]{64}\z")]] = Field(
        description="SHA-256 of each other file by its name [-]"
    )

    @field_validator("files")
    @classmethod
    def _holds_the_files_of_the_format(cls, files: Mapping[str, str]) -> Mapping[str, str]:
        for name in files:
            if name not in (WEIGHTS, TRAINING):
                raise ValueError(unknown("file", name, (WEIGHTS, TRAINING)))
        if WEIGHTS not in files:
            raise ValueError(f"{WEIGHTS!r} is missing")
        return files

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        if (self.origin.critic is not None) != (TRAINING in self.files):
            raise ValueError(f"origin.critic is needed with the file {TRAINING!r}, and only there")
        return self
