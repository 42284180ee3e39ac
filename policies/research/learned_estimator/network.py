"""The network of "gru" in torch, for training; `estimator.network.cell` computes the same."""

from __future__ import annotations

import math

import numpy as np
import torch
from torch import nn

from estimator.network.cell import HIDDEN, LARGEST, LEVER, MU_C, OUTPUTS, SMALLEST, TARGETS, R
from estimator.network.features import COLUMNS
from estimator.network.weights import Tensors

FIRST_WEIGHT = -3.0
"""Bias of the averages' weights at the start of training: a memory of 20 samples."""


class Network(nn.Module):
    """The recurrent unit and its averages.

    Args:
        centre: Means of the columns, (COLUMNS,).
        scale: One over their standard deviations, (COLUMNS,).
        start: Averages before the first sample, (TARGETS,).
    """

    def __init__(self, centre: np.ndarray, scale: np.ndarray, start: np.ndarray) -> None:
        super().__init__()
        self.register_buffer("centre", torch.as_tensor(centre, dtype=torch.float32))
        self.register_buffer("scale", torch.as_tensor(scale, dtype=torch.float32))
        self.start = nn.Parameter(torch.as_tensor(start, dtype=torch.float32))
        self.unit = nn.GRU(COLUMNS, HIDDEN)
        self.head = nn.Linear(HIDDEN + COLUMNS, OUTPUTS)
        with torch.no_grad():
            self.head.weight.mul_(0.1)
            self.head.bias.zero_()
            self.head.bias[:TARGETS] = FIRST_WEIGHT
            self.head.bias[TARGETS : 2 * TARGETS] = self.start

    def forward(self, columns: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """Averages and deviations after every sample.

        Args:
            columns: (t, n, COLUMNS), not normalised.

        Returns:
            ln mu_s, ln mu_c, ln r (t, n, TARGETS); logarithms of the relative standard deviations of mu_s,
            mu_c, r and mu_c r (t, n, TARGETS + 1).
        """
        x = (columns - self.centre) * self.scale
        hidden, _ = self.unit(x)
        out = self.head(torch.cat([hidden, x], dim=-1))
        weights = torch.sigmoid(out[..., :TARGETS]).unbind()
        measured = out[..., TARGETS : 2 * TARGETS].unbind()
        mean, means = self.start.expand(x.shape[1], TARGETS), []
        for weight, value in zip(weights, measured, strict=True):
            mean = torch.lerp(mean, value, weight)
            means.append(mean)
        low, high = math.log(SMALLEST), math.log(LARGEST)
        return torch.stack(means), low + (high - low) * torch.sigmoid(out[..., 2 * TARGETS :])

    def tensors(self) -> Tensors:
        """The tensors as `estimator.network.weights` stores them."""
        named = {name: value.detach().numpy() for name, value in self.state_dict().items()}
        head = named["head.weight"].T
        return {
            "centre": named["centre"],
            "scale": named["scale"],
            "input_weight": named["unit.weight_ih_l0"].T,
            "input_bias": named["unit.bias_ih_l0"],
            "hidden_weight": named["unit.weight_hh_l0"].T,
            "hidden_bias": named["unit.bias_hh_l0"],
            "head_of_hidden": head[:HIDDEN],
            "head_of_columns": head[HIDDEN:],
            "head_bias": named["head.bias"],
            "start": named["start"],
        }


def loss(
    means: torch.Tensor, deviations: torch.Tensor, targets: torch.Tensor, mask: torch.Tensor
) -> torch.Tensor:
    """Mean negative log-likelihood of the targets and of ln(mu_c r) under normal distributions, less a constant.

    Args:
        means: From `Network`, (t, n, TARGETS).
        deviations: From `Network`, (t, n, TARGETS + 1).
        targets: True ln mu_s, ln mu_c, ln r, (t, n, TARGETS).
        mask: Samples that count, (t, n).
    """
    errors = targets - means
    errors = torch.cat([errors, errors[..., MU_C : MU_C + 1] + errors[..., R : R + 1]], dim=-1)
    assert errors.shape[-1] == LEVER + 1
    each = 0.5 * (errors * torch.exp(-deviations)) ** 2 + deviations
    return each.mean(dim=-1)[mask].mean()
