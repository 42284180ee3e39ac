"""The learning algorithms: their hyperparameters, by Stable-Baselines3's names."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from slipgym.config.base import Count, Frozen, NonNegative, Positive, as_tuple

Layers = Annotated[tuple[Count, ...], BeforeValidator(as_tuple), Field(min_length=1)]
Share = Annotated[float, Field(ge=0, le=1)]


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
