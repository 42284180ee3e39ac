"""A policy's network in numpy, in float32 as it was trained."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from policies.learned import description

Memory = tuple[np.ndarray, np.ndarray]
"""Hidden and cell state of the LSTM layers, (n, layers, size) each."""


class Network:
    """Observations to actions, with the tensors of `tensors.expected`."""

    def __init__(
        self,
        network: description.Network,
        normalisation: description.Normalisation | None,
        tensors: Mapping[str, np.ndarray],
    ) -> None:
        self._network, self._normalisation = network, normalisation
        self._dense = [
            (tensors[f"layers.{k}.weight"].T, tensors[f"layers.{k}.bias"])
            for k in range(len(network.layers) + 1)
        ]
        memory = network.memory
        self.memory_shape = None if memory is None else (memory.layers, memory.size)
        self._recurrent = [
            (
                tensors[f"memory.{k}.input_weight"].T,
                tensors[f"memory.{k}.hidden_weight"].T,
                tensors[f"memory.{k}.input_bias"] + tensors[f"memory.{k}.hidden_bias"],
            )
            for k in range(0 if memory is None else memory.layers)
        ]
        if self._normalisation is not None:
            self._mean = tensors["observation.mean"]
            self._scale = np.sqrt(tensors["observation.var"] + self._normalisation.epsilon)

    def forward(self, observations: np.ndarray, memory: Memory | None) -> tuple[np.ndarray, Memory | None]:
        """Actions (n, k), float32 within [-1, 1], for observations (n, m), and the new memory."""
        x = self._normalised(observations)
        if memory is not None:
            x, memory = self._remember(x, memory)
        for weight, bias in self._dense[:-1]:
            x = _activate(self._network.activation, x @ weight + bias)
        weight, bias = self._dense[-1]
        x = x @ weight + bias
        return np.tanh(x) if self._network.squash else np.clip(x, -1.0, 1.0), memory

    def _normalised(self, observations: np.ndarray) -> np.ndarray:
        """As Stable-Baselines3's VecNormalize: in float64, then rounded to float32."""
        if self._normalisation is None:
            return observations.astype(np.float32)
        clip = self._normalisation.clip
        return np.clip((observations - self._mean) / self._scale, -clip, clip).astype(np.float32)

    def _remember(self, x: np.ndarray, memory: Memory) -> tuple[np.ndarray, Memory]:
        """One step of the LSTM layers (Hochreiter & Schmidhuber 1997, with forget gates)."""
        hidden, cell = (np.array(part, dtype=np.float32) for part in memory)
        for k, (input_weight, hidden_weight, bias) in enumerate(self._recurrent):
            gates = x @ input_weight + hidden[:, k] @ hidden_weight + bias
            enter, forget, candidate, leave = np.split(gates, 4, axis=1)
            cell[:, k] = _sigmoid(forget) * cell[:, k] + _sigmoid(enter) * np.tanh(candidate)
            hidden[:, k] = _sigmoid(leave) * np.tanh(cell[:, k])
            x = hidden[:, k]
        return x, (hidden, cell)


def _activate(name: str, x: np.ndarray) -> np.ndarray:
    if name == "tanh":
        return np.tanh(x)
    if name == "relu":
        return np.maximum(x, 0.0)
    return np.where(x > 0.0, x, np.expm1(np.minimum(x, 0.0)))


def _sigmoid(x: np.ndarray) -> np.ndarray:
    """1 / (1 + exp(-x)), written so that nothing overflows."""
    return 0.5 * (1.0 + np.tanh(0.5 * x))
