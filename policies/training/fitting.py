"""Fits the networks of PPO to targets: sample by sample, or over whole sequences where they have a memory."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
import torch
from sb3_contrib import RecurrentPPO
from sb3_contrib.common.recurrent.type_aliases import RNNStates
from torch.nn.functional import mse_loss, smooth_l1_loss
from torch.nn.utils import clip_grad_norm_
from torch.nn.utils.rnn import pad_sequence

from policies.training.config import Imitation

_BATCH = 1024
"""Samples of a step of gradient descent; those of sequences are in the configuration."""
Sequences: TypeAlias = list[tuple[torch.Tensor, torch.Tensor]]
"""Normalised observations (steps, m) and targets (steps, k) of each."""


class Fit:
    """Least squares, or Huber's loss, by Adam.

    Args:
        chosen: Passes, learning rate, loss, sequences.
        model: The learner, PPO or RecurrentPPO.
    """

    def __init__(self, chosen: Imitation, model: Any) -> None:
        self._chosen, self._model = chosen, model
        self._optimizer = torch.optim.Adam(model.policy.parameters(), chosen.learning_rate)

    def slow_down(self, left: float) -> None:
        """Go on with less than the whole learning rate.

        Args:
            left: 1 for all of it, 0 for `learning_rate_end` of it, linear in between.
        """
        end = self._chosen.learning_rate_end
        for group in self._optimizer.param_groups:
            group["lr"] = self._chosen.learning_rate * (end + (1.0 - end) * left)

    def actions(self, x: Sequence[np.ndarray], y: Sequence[np.ndarray], ends: Sequence[np.ndarray]) -> None:
        """Fits the mean actions.

        Args:
            x: Observations of each round, (steps, n, m).
            y: Actions, (steps, n, k) each.
            ends: Whether an episode ended with a step, (steps, n) each.
        """
        self._fit(x, y, ends, "actions")

    def values(self, x: Sequence[np.ndarray], y: Sequence[np.ndarray], ends: Sequence[np.ndarray]) -> None:
        """Fits the value function; see `actions`, with y (steps, n) each."""
        self._fit(x, [part[..., None] for part in y], ends, "values")

    def _fit(
        self, x: Sequence[np.ndarray], y: Sequence[np.ndarray], ends: Sequence[np.ndarray], what: str
    ) -> None:
        normalise = self._model.get_vec_normalize_env().normalize_obs
        inputs = [torch.as_tensor(normalise(part), dtype=torch.float32) for part in x]
        targets = [torch.as_tensor(part, dtype=torch.float32) for part in y]
        if isinstance(self._model, RecurrentPPO):
            parts = zip(inputs, targets, ends, strict=True)
            sequences = [episode for part in parts for episode in _episodes(*part)]
            self._over_sequences(sequences, _RECURRENT[what])
        else:
            flat = (torch.cat([part.flatten(0, 1) for part in parts]) for parts in (inputs, targets))
            self._over_samples(next(flat), next(flat), _DENSE[what])

    def _over_samples(self, inputs: torch.Tensor, targets: torch.Tensor, output: Any) -> None:
        for _ in range(self._chosen.epochs):
            for batch in torch.randperm(len(inputs)).split(_BATCH):
                self._descend(output(self._model.policy, inputs[batch]), targets[batch])

    def _over_sequences(self, sequences: Sequences, output: Any) -> None:
        """From chunk to chunk the memory is handed on, not its gradient."""
        for _ in range(self._chosen.epochs):
            for batch in torch.randperm(len(sequences)).split(self._chosen.sequences):
                xs, ys = zip(*(sequences[k] for k in batch.tolist()), strict=True)
                lengths = torch.tensor([len(x) for x in xs])
                inputs, targets = (pad_sequence(list(part), batch_first=True) for part in (xs, ys))
                played = torch.arange(inputs.shape[1]) < lengths[:, None]
                states = _fresh(self._model.policy, len(batch))
                for begun in range(0, inputs.shape[1], self._chosen.chunk):
                    now = slice(begun, begun + self._chosen.chunk)
                    found, states = output(self._model.policy, inputs[:, now], states)
                    self._descend(found[played[:, now]], targets[:, now][played[:, now]])

    def _descend(self, found: torch.Tensor, wanted: torch.Tensor) -> None:
        huber = self._chosen.huber
        loss = mse_loss(found, wanted) if huber is None else smooth_l1_loss(found, wanted, beta=huber)
        self._optimizer.zero_grad()
        loss.backward()
        if self._chosen.max_grad_norm is not None:
            clip_grad_norm_(self._model.policy.parameters(), self._chosen.max_grad_norm)
        self._optimizer.step()


def _episodes(inputs: torch.Tensor, targets: torch.Tensor, ends: np.ndarray) -> Sequences:
    """The episodes of a round, (steps, n, ...), the last of each environment maybe without its end."""
    found = []
    for row in range(inputs.shape[1]):
        inner = np.flatnonzero(ends[:-1, row]) + 1
        for begun, ended in zip((0, *inner), (*inner, len(ends)), strict=True):
            found.append((inputs[begun:ended, row], targets[begun:ended, row]))
    return found


def _fresh(policy: Any, n: int) -> RNNStates:
    """Empty memories of actor and critic."""
    layers, _, size = policy.lstm_hidden_state_shape
    empty = torch.zeros(layers, n, size), torch.zeros(layers, n, size)
    return RNNStates(empty, empty)


def _means(policy: Any, observations: torch.Tensor) -> torch.Tensor:
    """Mean actions."""
    return policy.get_distribution(observations).distribution.mean


def _values(policy: Any, observations: torch.Tensor) -> torch.Tensor:
    return policy.predict_values(observations)


def _means_over_time(
    policy: Any, observations: torch.Tensor, states: RNNStates
) -> tuple[torch.Tensor, RNNStates]:
    """Mean actions (n, steps, k), and the memory, cut off from what made it."""
    n, steps, _ = observations.shape
    found, actor = policy.get_distribution(observations.flatten(0, 1), states.pi, torch.zeros(n * steps))
    return found.distribution.mean.unflatten(0, (n, steps)), RNNStates(_cut(actor), states.vf)


def _values_over_time(
    policy: Any, observations: torch.Tensor, states: RNNStates
) -> tuple[torch.Tensor, RNNStates]:
    """The same of values, (n, steps, 1)."""
    n, steps, _ = observations.shape
    _, found, _, (actor, critic) = policy(observations.flatten(0, 1), states, torch.zeros(n * steps), True)
    return found.unflatten(0, (n, steps)), RNNStates(_cut(actor), _cut(critic))


def _cut(memory: tuple[torch.Tensor, ...]) -> tuple[torch.Tensor, torch.Tensor]:
    hidden, cell = memory
    return hidden.detach(), cell.detach()


_DENSE = {"actions": _means, "values": _values}
_RECURRENT = {"actions": _means_over_time, "values": _values_over_time}
