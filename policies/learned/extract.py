"""Takes a model of Stable-Baselines3 apart: its network, its critic, its tensors."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from policies.learned.description import Critic, Memory, Network
from slipgym.config.errors import unknown

ALGORITHMS = {
    "PPO": "stable_baselines3",
    "SAC": "stable_baselines3",
    "TQC": "sb3_contrib",
    "RecurrentPPO": "sb3_contrib",
}
"""Class -> package."""
ACTIVATIONS = {"Tanh": "tanh", "ReLU": "relu", "ELU": "elu"}
LSTM = {
    "input_weight": "weight_ih_l",
    "hidden_weight": "weight_hh_l",
    "input_bias": "bias_ih_l",
    "hidden_bias": "bias_hh_l",
}


def algorithm_of(model: Any) -> str:
    """Name of the algorithm that a model is of.

    Raises:
        ValueError: It is none of `ALGORITHMS`, or explores in a way that a file cannot hold.
    """
    classes = [cls.__name__ for cls in type(model).__mro__]
    for name in ALGORITHMS:
        if name in classes:
            break
    else:
        raise ValueError(unknown("algorithm", classes[0], ALGORITHMS))
    if model.use_sde and name in ("SAC", "TQC"):
        raise ValueError(f"use_sde = True: what {name} then acts with has no file format")
    if model.policy.features_extractor_class.__name__ != "FlattenExtractor":
        extractor = model.policy.features_extractor_class.__name__
        raise ValueError(f"features extractor {extractor!r}: a file holds networks that read a vector")
    return name


def network_of(model: Any) -> Network:
    """The network that turns an observation into an action.

    Raises:
        ValueError: It holds layers that a file cannot hold.
    """
    memory = None
    if algorithm_of(model) == "RecurrentPPO":
        lstm = model.policy.lstm_actor
        if lstm.bidirectional or lstm.proj_size or not lstm.bias or lstm.dropout:
            raise ValueError(f"{lstm}: a file holds LSTM layers with bias, without projection and dropout")
        memory = Memory(size=lstm.hidden_size, layers=lstm.num_layers)
    activation = model.policy.activation_fn.__name__
    if activation not in ACTIVATIONS:
        raise ValueError(unknown("activation", activation, ACTIVATIONS))
    return Network.model_validate(
        {
            "kind": "lstm" if memory else "mlp",
            "memory": memory,
            "layers": _widths(_actor(model)[:-1]),
            "activation": ACTIVATIONS[activation],
            "squash": bool(model.policy.squash_output),
        }
    )


def critic_of(model: Any) -> Critic:
    """Settings that rebuild the model's critics."""
    policy = model.policy
    if hasattr(policy, "critic_target"):
        nets, quantiles = policy.critic.q_networks, getattr(policy.critic, "n_quantiles", 1)
        return Critic(layers=_widths(_linear(nets[0]))[:-1], count=len(nets), quantiles=quantiles)
    own, shared = getattr(policy, "enable_critic_lstm", False), getattr(policy, "shared_lstm", False)
    memory = "own" if own else "shared" if shared else "none"
    return Critic(layers=_widths(_linear(policy.mlp_extractor.value_net)), memory=memory)


def acting_tensors(model: Any) -> dict[str, np.ndarray]:
    """The network's tensors, by their names in the file."""
    found = {}
    if hasattr(model.policy, "lstm_actor"):
        for k in range(model.policy.lstm_actor.num_layers):
            for ours, theirs in LSTM.items():
                found[f"memory.{k}.{ours}"] = array(getattr(model.policy.lstm_actor, f"{theirs}{k}"))
    for k, layer in enumerate(_actor(model)):
        found[f"layers.{k}.weight"], found[f"layers.{k}.bias"] = array(layer.weight), array(layer.bias)
    return found


def array(tensor: Any) -> np.ndarray:
    """A torch tensor as an array of its own."""
    return tensor.detach().cpu().numpy().copy()


def _actor(model: Any) -> list[Any]:
    """The dense layers of the policy, first to last."""
    policy = model.policy
    if hasattr(policy, "actor"):
        return [*_linear(policy.actor.latent_pi), *_linear([policy.actor.mu])]
    return [*_linear(policy.mlp_extractor.policy_net), *_linear([policy.action_net])]


def _linear(modules: Iterable[Any]) -> list[Any]:
    """The dense layers among modules that are nothing but dense layers and nonlinearities."""
    found = []
    for module in modules:
        kind = type(module).__name__
        if kind == "Linear" and module.bias is not None:
            found.append(module)
        elif kind not in ACTIVATIONS:
            raise ValueError(
                f"layer {module}: a file holds dense layers with bias and {', '.join(ACTIVATIONS)}"
            )
    return found


def _widths(layers: Iterable[Any]) -> tuple[int, ...]:
    return tuple(layer.out_features for layer in layers)
