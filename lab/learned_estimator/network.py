"""The network of "gru" in torch, and its loss; `lab.learned_estimator.cell` is the same step, compiled.

The loss of a sample is the mean, over mu_s, mu_c, r and mu_c r, of the negative log-likelihood of the
logarithm's error under a normal distribution with the stated deviation, less a constant.
"""

from __future__ import annotations

from collections.abc import Sequence as Several

import numpy as np
import torch
from torch import Tensor, nn
from torch.nn.utils.rnn import pad_sequence

from lab.learned_estimator.cell import HIDDEN, HIGH, LOW, MU_C, TARGETS, R
from lab.learned_estimator.columns import Sequence
from lab.learned_estimator.features import COLUMNS
from lab.learned_estimator.weights import SHAPES, Tensors

GATES = {
    "input_weight": "weight_ih_l0",
    "input_bias": "bias_ih_l0",
    "hidden_weight": "weight_hh_l0",
    "hidden_bias": "bias_hh_l0",
}
"""Tensor of the file -> that of `torch.nn.GRU`, which is its transpose."""
FIXED = ("centre", "scale")
"""Tensors that are computed from the data once."""


class Network(nn.Module):
    """Averages of measurements whose weights a gated recurrent unit chooses.

    Args:
        tensors: Those of `lab.learned_estimator.weights.SHAPES`.
    """

    centre: Tensor
    scale: Tensor
    head_of_hidden: Tensor
    head_of_columns: Tensor
    head_bias: Tensor
    start: Tensor

    def __init__(self, tensors: Tensors) -> None:
        super().__init__()
        self.unit = nn.GRU(COLUMNS, HIDDEN)
        with torch.no_grad():
            for name, own in GATES.items():
                getattr(self.unit, own).copy_(torch.from_numpy(tensors[name].T))
        for name in set(SHAPES) - set(GATES):
            value = torch.from_numpy(tensors[name].copy())
            if name in FIXED:
                self.register_buffer(name, value)
            else:
                self.register_parameter(name, nn.Parameter(value))

    def forward(self, columns: Tensor) -> tuple[Tensor, Tensor]:
        """Averages (t, n, 3) and logarithms of relative deviations (t, n, 4) of columns (t, n, COLUMNS)."""
        x = (columns - self.centre) * self.scale
        hidden, _ = self.unit(x)
        out = hidden @ self.head_of_hidden + x @ self.head_of_columns + self.head_bias
        weights, measured = out[..., :TARGETS].sigmoid(), out[..., TARGETS : 2 * TARGETS]
        mean, means = self.start.expand_as(measured[0]), []
        for weight, value in zip(weights, measured, strict=True):
            mean = torch.lerp(mean, value, weight)
            means.append(mean)
        low, high = float(LOW), float(HIGH)
        return torch.stack(means), low + (high - low) * out[..., 2 * TARGETS :].sigmoid()

    def loss(self, sequences: Several[Sequence]) -> Tensor:
        """Mean loss of the samples of sequences.

        Args:
            sequences: Sequences.
        """
        columns = pad_sequence([torch.from_numpy(one.columns) for one in sequences])
        targets = pad_sequence([torch.from_numpy(one.targets).float() for one in sequences])
        lengths = torch.tensor([len(one.columns) for one in sequences])
        means, deviations = self(columns)
        error = targets - means
        error = torch.cat([error, error[..., MU_C, None] + error[..., R, None]], dim=-1)
        each = 0.5 * (error * torch.exp(-deviations)).square() + deviations
        return each[torch.arange(len(columns))[:, None] < lengths].mean()

    def tensors(self) -> Tensors:
        """Tensors as the file of weights holds them."""
        state = {name: value.detach().numpy().copy() for name, value in self.state_dict().items()}
        return {
            name: np.ascontiguousarray(state[f"unit.{GATES[name]}"].T) if name in GATES else state[name]
            for name in SHAPES
        }
