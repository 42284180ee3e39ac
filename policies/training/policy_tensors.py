"""Between the actor of `privileged_ppo` and the tensors of a policy's file (docs/policy_files.md)."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import torch

from policies.learned import files
from policies.learned.description import WEIGHTS, Network
from policies.learned.extract import array, places
from policies.learned.pretrained import locate
from policies.training.config import Training
from policies.training.derived import folded
from slipgym.tasks import find

EPSILON = 1e-8
"""Added to the variance of an observation [unit^2]."""
_SEEN = 10_000_000
"""Samples that the observations' statistics of a policy count as, which training goes on from."""
_LAYERS = "mlp", "rnn.rnn"
"""Dense and LSTM layers of an actor of rsl-rl."""


def network(config: Training) -> Network:
    """Description of the network of a run in a file."""
    chosen = config.privileged_ppo
    return Network.of(chosen.memory, chosen.net_arch, chosen.activation, squash=False)


def take(actor: Any, moments: Any, matrix: np.ndarray) -> dict[str, np.ndarray]:
    """Tensors of an actor by their names in a file, and the moments of its observations.

    The actor reads derived columns, of `matrix` (d, k), behind the observation.
    """
    found, state = {}, actor.state_dict()
    if moments is not None:
        found = {"observation.mean": np.array(moments.mean), "observation.var": np.array(moments.var)}
    found |= {ours: array(state[theirs]) for ours, theirs in places(state, *_LAYERS).items()}
    if len(matrix):
        first = "memory.0.input_" if "memory.0.input_weight" in found else "layers.0."
        weight, bias = f"{first}weight", f"{first}bias"
        found[weight], found[bias] = folded(found[weight], found[bias], matrix, moments, EPSILON)
    return found


def load(
    actor: Any, moments: Any, matrix: np.ndarray, path: str | os.PathLike[str], config: Training
) -> None:
    """Gives an actor the network of a policy, and the statistics of its observations.

    Derived columns count nothing at first. For the arguments see `take`.

    Raises:
        FileNotFoundError: There is nothing at the path, and it is no name of a policy of slipgym.
        ValueError: It is no policy, of another task, or its network is another one.
    """
    description, weights = files.read(locate(path), WEIGHTS)
    if description.environment.id != find(config.task).id:
        raise ValueError(f"{path}: is a policy for {description.environment.id}, not for {config.task}")
    if description.network != network(config):
        raise ValueError(
            f"{path}: privileged_ppo.start needs the network that is trained, {network(config)!r}; "
            f"the policy has {description.network!r}"
        )
    normalised = config.normalisation.observation
    if normalised != (description.normalisation is not None):
        raise ValueError(f"{path}: normalisation.observation = {normalised} is not that of the policy")
    for name, value in take(actor, moments if normalised else None, matrix).items():
        if name not in weights or weights[name].shape != value.shape:
            raise ValueError(f"{path}: {name!r} does not fit the observation or action of the run")
    if normalised:
        moments.mean, moments.var = weights["observation.mean"].copy(), weights["observation.var"].copy()
        moments.count = _SEEN
    parameters = dict(actor.named_parameters())
    with torch.no_grad():
        for ours, theirs in places(parameters, *_LAYERS).items():
            parameters[theirs].zero_()  # those of derived columns stay 0
            parameters[theirs][..., : weights[ours].shape[-1]].copy_(torch.tensor(weights[ours]))
