"""A learned policy as it acts: numpy only."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np

from policies.learned import description, files
from policies.learned.fitting import check_environment, layout, selection

Memory = tuple[np.ndarray, np.ndarray]
"""Hidden and cell state of the LSTM layers, (n, layers, size) each."""
MODES = ("action_mode", "observation_mode", "load_columns", "history", "frame_skip")
"""Arguments of an environment that decide what a policy reads, gives and how often."""


class LearnedPolicy:
    """A policy read from its folder (docs/policy_files.md); never changes, so one serves many episodes.

    Attributes:
        description: What policy.json says.
        names: Columns of an observation that it takes: those of the environment in this version of slipgym.
            The network reads the columns of its training among them.
        width: Numbers in an observation that it takes, earlier observations included.

    Raises:
        FileNotFoundError: There is nothing at the path.
        ValueError: What lies there is no policy, or not whole, or was changed.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.description, tensors = files.read(path)
        self._network = Network(self.description.network, self.description.normalisation, tensors)
        where = self.description.environment
        self.names = layout(where)
        self.width = (where.history + 1) * len(self.names)
        self._read = selection(where)

    @property
    def modes(self) -> dict[str, Any]:
        """Keyword arguments that an environment for it needs; others may differ from the training's."""
        arguments = self.description.environment.arguments
        return {name: arguments[name] for name in MODES if name in arguments}

    def check(self, env: Any) -> None:
        """Refuse an environment whose observations or actions mean something else than in training.

        Raises:
            ValueError: They do; the message names the first difference.
        """
        check_environment(self.description.environment, env)

    def predict(
        self,
        observation: np.ndarray | Mapping[str, np.ndarray],
        state: Any = None,
        episode_start: np.ndarray | None = None,
        deterministic: bool = True,
    ) -> tuple[np.ndarray, Any]:
        """Action for an observation (m,) or for a batch of them (n, m).

        Args:
            observation: From the environment, not normalised; of groups, "policy" is read.
            state: As returned by the last call; None before the first.
            episode_start: Rows that begin a new episode and forget their memory, (n,) bool.
            deterministic: Must be True: a file holds what acts, not what explores.

        Returns:
            Action (k,) or (n, k), float32 within [-1, 1], and the memory: None, or hidden and cell state of
            the LSTM layers, (n, layers, size) each, n = 1 for a single observation.

        Raises:
            ValueError: The observation, the memory or `episode_start` does not fit, or holds NaN or infinity.
        """
        if not deterministic:
            raise ValueError("deterministic = False: a policy's file acts without exploration")
        observations = self._observations(observation)
        rows = np.atleast_2d(observations)
        memory = self._memory(state, episode_start, len(rows))
        if self._read is not None:
            rows = np.take(rows, self._read, axis=1)
        with np.errstate(over="ignore", invalid="ignore"):
            actions, memory = self._network.forward(rows, memory)
        if np.isnan(actions).any():
            raise ValueError("the action is NaN: observation or weights are too large for float32")
        return (actions if observations.ndim == 2 else actions[0]), memory

    def _observations(self, observation: np.ndarray | Mapping[str, np.ndarray]) -> np.ndarray:
        """What the network reads, (m,) or (n, m)."""
        if isinstance(observation, Mapping):
            if "policy" not in observation:
                raise ValueError(f"observation has the groups {', '.join(observation)}, but no 'policy'")
            observation = observation["policy"]
        observations = np.asarray(observation)
        if observations.ndim not in (1, 2):
            raise ValueError(f"observation must have shape (m,) or (n, m), got {observations.shape}")
        width, history = observations.shape[-1], self.description.environment.history
        if width != self.width:
            said = f"observation has {width} columns, the policy needs {self.width} (history={history})"
            if history == 0 and width < self.width:
                said += f"; the first that it lacks at its end is {self.names[width]!r}"
            elif history == 0:
                said += f"; the last one known is {self.names[-1]!r}"
            raise ValueError(said)
        if not np.isfinite(observations).all():
            column = int(np.argwhere(~np.isfinite(np.atleast_2d(observations)))[0, 1])
            name = self.names[column % len(self.names)]
            raise ValueError(f"observation column {column} ({name}) must be finite")
        return observations

    def _memory(self, state: Memory | None, episode_start: np.ndarray | None, n: int) -> Memory | None:
        """The memory to act on: zero where an episode begins."""
        shape = self._network.memory_shape
        if shape is None:
            if state is not None:
                kind = type(state).__name__
                raise ValueError(f"state must be None for a policy without memory, got {kind}")
            return None
        begun = np.zeros(n, bool) if episode_start is None else np.atleast_1d(np.asarray(episode_start, bool))
        if begun.shape != (n,):
            raise ValueError(f"episode_start must have shape ({n},), got {begun.shape}")
        if state is None:
            return np.zeros((n, *shape), np.float32), np.zeros((n, *shape), np.float32)
        shapes = [np.shape(part) for part in state]
        if shapes != [(n, *shape)] * 2:
            raise ValueError(f"state has shapes {shapes}, {n} observations need {[(n, *shape)] * 2}")
        hidden, cell = (np.where(begun[:, None, None], np.float32(0.0), part) for part in state)
        return hidden, cell


class Network:
    """Observations to actions, with the tensors of `files.expected`."""

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
