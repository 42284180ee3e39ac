"""Takes a model of Stable-Baselines3 apart: its network, its critic, its tensors."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable
from typing import Any

import numpy as np

from policies.learned.description import Critic, Network
from slipgym.config.errors import unknown

ALGORITHMS = {
    "PPO": "stable_baselines3",
    "SAC": "stable_baselines3",
    "TQC": "sb3_contrib",
    "RecurrentPPO": "sb3_contrib",
}
"""Class -> package."""
ACTIVATIONS = {"Tanh": "tanh", "ReLU": "relu", "ELU": "elu"}
_LSTM = {
    "input_weight": "weight_ih_l",
    "hidden_weight": "weight_hh_l",
    "input_bias": "bias_ih_l",
    "hidden_bias": "bias_hh_l",
}


def places(names: Collection[str], hidden: str, memory: str, *last: str) -> dict[str, str]:
    """Name of a tensor in a policy's file -> its name among those of a module of torch.

    The module has a sequence `hidden` of dense layers and nonlinearities, maybe LSTM layers `memory` ahead of
    it and dense layers `last` behind it.
    """
    found, count = {}, 0
    while f"{memory}.weight_hh_l{count}" in names:
        found |= {f"memory.{count}.{ours}": f"{memory}.{theirs}{count}" for ours, theirs in _LSTM.items()}
        count += 1
    matches = (re.fullmatch(rf"{re.escape(hidden)}\.(\d+)\.weight", name) for name in names)
    numbers = sorted(int(match[1]) for match in matches if match)
    for k, layer in enumerate([*(f"{hidden}.{number}" for number in numbers), *last]):
        found |= {f"layers.{k}.{part}": f"{layer}.{part}" for part in ("weight", "bias")}
    return found


def acting_places(names: Collection[str]) -> dict[str, str]:
    """The same of a policy of Stable-Baselines3."""
    if "action_net.weight" in names:
        return places(names, "mlp_extractor.policy_net", "lstm_actor", "action_net")
    return places(names, "actor.latent_pi", "lstm_actor", "actor.mu")


def algorithm_of(model: Any) -> str:
    """Name of the algorithm that a model is of.

    Raises:
        ValueError: It is none of `ALGORITHMS`, or explores in a way that a file cannot hold.
    """
    classes = [cls.__name__ for cls in type(model).__mro__]
    name = next((name for name in ALGORITHMS if name in classes), None)
    if name is None:
        raise ValueError(unknown("algorithm", classes[0], ALGORITHMS))
    if model.use_sde and name in ("SAC", "TQC"):
        raise ValueError(f"use_sde = True: what {name} then acts with has no file format")
    extractor = model.policy.features_extractor_class.__name__
    if extractor != "FlattenExtractor":
        raise ValueError(f"features extractor {extractor!r}: a file holds networks that read a vector")
    return name


def network_of(model: Any) -> Network:
    """The network that turns an observation into an action.

    Raises:
        ValueError: It holds layers that a file cannot hold.
    """
    policy, size, stacked = model.policy, 0, 0
    if algorithm_of(model) == "RecurrentPPO":
        lstm = policy.lstm_actor
        if lstm.bidirectional or lstm.proj_size or not lstm.bias or lstm.dropout:
            raise ValueError(f"{lstm}: a file holds LSTM layers with bias, without projection and dropout")
        size, stacked = lstm.hidden_size, lstm.num_layers
    activation = policy.activation_fn.__name__
    if activation not in ACTIVATIONS:
        raise ValueError(unknown("activation", activation, ACTIVATIONS))
    actor = hasattr(policy, "actor")
    widths = _widths(policy.actor.latent_pi if actor else policy.mlp_extractor.policy_net)
    _widths([policy.actor.mu if actor else policy.action_net])
    return Network.of(size, widths, ACTIVATIONS[activation], bool(policy.squash_output), stacked)


def critic_of(model: Any) -> Critic:
    """Settings that rebuild the model's critics."""
    policy = model.policy
    if hasattr(policy, "critic_target"):
        nets, quantiles = policy.critic.q_networks, getattr(policy.critic, "n_quantiles", 1)
        return Critic(layers=_widths(nets[0])[:-1], count=len(nets), quantiles=quantiles)
    own, shared = getattr(policy, "enable_critic_lstm", False), getattr(policy, "shared_lstm", False)
    memory = "own" if own else "shared" if shared else "none"
    return Critic(layers=_widths(policy.mlp_extractor.value_net), memory=memory)


def acting_tensors(model: Any) -> dict[str, np.ndarray]:
    """The network's tensors, by their names in the file."""
    state = model.policy.state_dict()
    return {ours: array(state[theirs]) for ours, theirs in acting_places(state).items()}


def array(tensor: Any) -> np.ndarray:
    """A torch tensor as an array of its own."""
    return tensor.detach().cpu().numpy().copy()


def _widths(modules: Iterable[Any]) -> tuple[int, ...]:
    """Sizes of the dense layers among modules that are nothing but dense layers and nonlinearities."""
    found = []
    for module in modules:
        kind = type(module).__name__
        if kind == "Linear" and module.bias is not None:
            found.append(module.out_features)
        elif kind not in ACTIVATIONS:
            raise ValueError(
                f"layer {module}: a file holds dense layers with bias and {', '.join(ACTIVATIONS)}"
            )
    return tuple(found)
