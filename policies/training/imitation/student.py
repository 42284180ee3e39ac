"""The network of an imitation in torch: layers, loss, tensors as a policy's file holds them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import torch
from torch import nn

from policies.learned.description import Column, Network, Normalisation
from policies.learned.extract import array, places
from policies.training.imitation.config import Imitation
from policies.training.memory import remembering

EPSILON = 1e-8
"""Added to the variance of an observation [unit^2]."""
CLIP = 10.0
"""Largest size of a normalised observation [-]."""
FORCE = "grip_force"
"""Component of an action whose relative error counts."""
LEAST = 0.1
"""Added to the distance of a force from its lower end before an error is divided by it [-]."""
OTHER = 0.3
"""What errors of other components are divided by [-]."""


class Student(nn.Module):
    """An LSTM layer, unless the memory is 0, and dense layers; mean and variance of observations are (m,)."""

    def __init__(
        self, config: Imitation, mean: np.ndarray, var: np.ndarray, components: Sequence[Column]
    ) -> None:
        super().__init__()
        self.mean, self.var = torch.from_numpy(mean.copy()), torch.from_numpy(var.copy())
        width = len(mean)
        self.memory = remembering(nn.LSTM(width, config.memory)) if config.memory else None
        width = config.memory or width
        sizes = [width, *config.layers, len(components)]
        self.dense = nn.ModuleList(nn.Linear(a, b) for a, b in pairwise(sizes))
        self._squash = config.squash
        self._is_force = torch.tensor([column.name == FORCE for column in components])

    def forward(self, observations: torch.Tensor) -> torch.Tensor:
        """Actions (T, n, k), not clipped, for observations (T, n, m) from the beginning of their episodes."""
        scaled = (observations.double() - self.mean) / torch.sqrt(self.var + EPSILON)
        x = torch.clip(scaled, -CLIP, CLIP).float()
        if self.memory is not None:
            x, _ = self.memory(x)
        for layer in self.dense[:-1]:
            x = torch.tanh(layer(x))
        x = self.dense[-1](x)
        return torch.tanh(x) if self._squash else x

    def loss(self, observations: torch.Tensor, wanted: torch.Tensor, lengths: torch.Tensor) -> torch.Tensor:
        """Mean Huber loss of the errors, a force's relative to its size.

        Observations are (T, n, m), the wanted actions (T, n, k), the episodes' lengths (n,).
        """
        scale = torch.where(self._is_force, wanted + 1.0 + LEAST, torch.tensor(OTHER))
        given, wanted = self(observations) / scale, wanted / scale
        error = nn.functional.huber_loss(given, wanted, reduction="none", delta=0.5)
        running = torch.arange(len(wanted))[:, None] < lengths
        return (error.mean(-1) * running).sum() / running.sum()

    def tensors(self) -> dict[str, np.ndarray]:
        """Tensors by their names in a policy's file, see `policies.learned.files.expected`."""
        state = self.state_dict()
        found = {ours: array(state[theirs]) for ours, theirs in places(state, "dense", "memory").items()}
        return {"observation.mean": array(self.mean), "observation.var": array(self.var), **found}


def network_of(config: Imitation) -> Network:
    """Description of the network in a policy's file."""
    return Network.of(config.memory, config.layers, "tanh", config.squash)


NORMALISATION = Normalisation(clip=CLIP, epsilon=EPSILON)
"""What a policy's file says about the observations."""
