"""The learning algorithms: their hyperparameters, by Stable-Baselines3's names."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from slipgym.config.base import Count, Frozen, NonNegative, Positive, as_tuple

Layers = Annotated[
    tuple[Annotated[Count, Field(le=8192)], ...],
    BeforeValidator(as_tuple),
    Field(min_length=1, max_length=16),
]
"""As wide and as many as the file of a policy holds."""
Share = Annotated[float, Field(ge=0, le=1)]
HORIZON = 300.0
"""Longest memory of a unit of an LSTM before it has learned anything [steps]."""


class _Shared(Frozen):
    """What all algorithms have."""

    learning_rate: Positive = Field(default=3e-4, description="Step size of Adam [-]")
    learning_rate_end: Share = Field(
        default=1.0, description="Share of it left at the end of the budget; linear in between [-]"
    )
    batch_size: Count = Field(default=256, description="Samples per gradient step [-]")
    gamma: Share = Field(default=0.99, description="Discount per step of the environment [-]")
    net_arch: Layers = Field(default=(64, 64), description="Units of the hidden layers [-]")
    activation: Literal["tanh", "relu", "elu"] = Field(default="tanh", description="Of the hidden layers [-]")


class PPO(_Shared):
    """Proximal policy optimization (Schulman et al., arXiv 1707.06347)."""

    n_steps: Count = Field(default=256, description="Steps per environment between updates [-]")
    n_epochs: Count = Field(default=10, description="Passes over them [-]")
    gae_lambda: Share = Field(default=0.95, description="Of the generalised advantage estimate [-]")
    clip_range: Positive = Field(default=0.2, description="Largest change of the probability ratio [-]")
    ent_coef: NonNegative = Field(default=0.0, description="Weight of the entropy [-]")
    vf_coef: NonNegative = Field(default=0.5, description="Weight of the value function's loss [-]")
    max_grad_norm: Positive = Field(default=0.5, description="Gradients are clipped to this norm [-]")
    target_kl: Positive | None = Field(default=None, description="Stop an update's passes beyond it [-]")
    log_std_init: float = Field(default=0.0, description="Logarithm of the first standard deviation [-]")
    use_sde: bool = Field(
        default=False, description="Whether exploration depends on the state, not on time [-]"
    )
    sde_sample_freq: int = Field(
        default=-1, ge=-1, description="Steps after which it does so in another way; -1: only an update [-]"
    )


class RecurrentPPO(PPO):
    """PPO with an LSTM before the hidden layers, in actor and critic."""

    lstm_hidden_size: Count = Field(default=64, description="Units of the LSTM [-]")


class Curriculum(Frozen):
    """Stages that come before the task itself, each until enough episodes are solved."""

    stages: Annotated[tuple[Mapping[str, Any], ...], BeforeValidator(as_tuple)] = Field(
        default=(), description="Overrides of the environment's config, one mapping a stage"
    )
    success: Share = Field(default=0.6, description="Share of episodes solved that ends a stage [-]")
    episodes: Count = Field(default=500, description="The last episodes of training that are counted [-]")


class PrivilegedPPO(Frozen):
    """PPO of rsl-rl: the critic reads the privileged group, the actor may have a memory."""

    learning_rate: Positive = Field(default=1e-3, description="Step size of Adam [-]")
    learning_rate_end: Share = Field(
        default=0.1, description="Share of it left at the end of the budget; linear in between [-]"
    )
    n_steps: Count = Field(default=32, description="Steps per environment between updates [-]")
    n_epochs: Count = Field(default=4, description="Passes over them [-]")
    n_minibatches: Count = Field(default=8, description="Gradient steps of a pass [-]")
    gamma: Share = Field(default=0.995, description="Discount per step of the environment [-]")
    gae_lambda: Share = Field(default=0.95, description="Of the generalised advantage estimate [-]")
    clip_range: Positive = Field(default=0.2, description="Largest change of the probability ratio [-]")
    ent_coef: NonNegative = Field(default=0.0, description="Weight of the entropy [-]")
    vf_coef: NonNegative = Field(default=0.5, description="Weight of the value function's loss [-]")
    max_grad_norm: Positive = Field(default=0.5, description="Gradients are clipped to this norm [-]")
    log_std_init: float = Field(default=-1.5, description="Logarithm of the first standard deviation [-]")
    net_arch: Layers = Field(default=(64, 64), description="Units of the hidden layers [-]")
    activation: Literal["tanh", "relu", "elu"] = Field(default="tanh", description="Of the hidden layers [-]")
    memory: int = Field(default=0, ge=0, le=1024, description="Units of the actor's LSTM; 0: none [-]")
    memory_horizon: float = Field(
        default=HORIZON, ge=2.0, le=1e6, description="Longest memory of a unit of a new LSTM [steps]"
    )
    mirrored: Annotated[tuple[str, ...], BeforeValidator(as_tuple)] = Field(
        default=(),
        description="Columns that change sign in a mirror: samples count twice, as they are and mirrored [-]",
    )
    privileged: bool = Field(default=True, description="Whether the critic reads the privileged group [-]")
    start: str | None = Field(default=None, description="Policy that the actor starts as")
    critic_first: int = Field(
        default=0, ge=0, description="Updates at first that change the critic alone [-]"
    )
    curriculum: Curriculum = Field(default=Curriculum(), description="Easier stages that come first [-]")

    @model_validator(mode="after")
    def _what_a_memory_has(self) -> Self:
        if self.mirrored and self.memory:
            raise ValueError("mirrored needs memory 0: rsl-rl mirrors no sequences")
        if self.memory_horizon != HORIZON and not self.memory:
            raise ValueError("memory_horizon needs a memory")
        return self


class SAC(_Shared):
    """Soft actor-critic (Haarnoja et al., arXiv 1812.05905)."""

    buffer_size: Count = Field(default=200_000, description="Transitions in the replay buffer [-]")
    learning_starts: Count = Field(default=5_000, description="Steps of random actions first [-]")
    train_freq: Count = Field(default=1, description="Steps per environment between updates [-]")
    gradient_steps: Count = Field(default=1, description="Gradient steps per update [-]")
    tau: Share = Field(default=0.005, description="Rate of the target network [-]")
    ent_coef: NonNegative | Literal["auto"] = Field(
        default="auto", description="Weight of the entropy; auto: learned [-]"
    )


class TQC(SAC):
    """Truncated quantile critics (Kuznetsov et al., arXiv 2005.04269)."""

    top_quantiles_to_drop_per_net: Count = Field(default=2, description="Of each critic's 25 quantiles [-]")
    n_critics: Count = Field(default=2, description="Critics [-]")
