"""Columns that the learner reads besides those of the observation: linear combinations of them.

A difference of two columns that are nearly equal, such as a tracking error, is small beside the standard
deviation by which either is normalised. Derived columns keep the scale that their factors give them. A
trained network needs no such columns: its first layer can compute them (`fold`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import torch
from gymnasium.spaces import Box
from stable_baselines3.common.running_mean_std import RunningMeanStd
from stable_baselines3.common.vec_env import VecEnv, VecEnvWrapper, VecNormalize
from stable_baselines3.common.vec_env.base_vec_env import VecEnvStepReturn

from slipgym.config.errors import unknown

Derived = Mapping[str, Mapping[str, float]]
"""Name of a derived column -> column of the observation -> coefficient."""
_FIRST_LAYERS = "mlp_extractor.policy_net.0", "mlp_extractor.value_net.0"


def coefficients(derived: Derived, columns: Sequence[Any], history: int, width: int) -> np.ndarray:
    """Matrix from an observation of `width` numbers to its derived columns, (d, k) float64.

    `columns` are those of one observation, of which there are `history` earlier ones in each.

    Raises:
        ValueError: The observation has no such column.
    """
    names = [column.name for column in columns]
    for column in (column for combination in derived.values() for column in combination):
        if column not in names:
            raise ValueError(f"derived: {unknown('column', column, names)}")
    rows = [[combination.get(name, 0.0) for name in names] for combination in derived.values()]
    matrix = np.kron(np.eye(history + 1), np.reshape(rows, (len(derived), len(names))))
    return np.pad(matrix, ((0, 0), (0, width - matrix.shape[1])))


def folded(
    weight: np.ndarray, bias: np.ndarray, matrix: np.ndarray, moments: Any, epsilon: float
) -> tuple[np.ndarray, np.ndarray]:
    """Weight (m, k) and bias (m,) of a layer that reads the observation alone and computes the same.

    The given layer, weight (m, k + d) and bias (m,), reads the derived columns of `coefficients` (d, k)
    behind the observation. What it reads is normalised by `moments`, mean and variance of the first columns,
    all or k; `epsilon` is added to the variance. None: nothing is.
    """
    count, width = matrix.shape[1], sum(matrix.shape)
    mean, scale = np.zeros(width), np.ones(width)
    if moments is not None:
        mean[: len(moments.mean)] = moments.mean
        scale[: len(moments.var)] = np.sqrt(moments.var + epsilon)
    own, derived = weight[:, :count].astype(np.float64), weight[:, count:].astype(np.float64)
    of_normalised = matrix * scale[:count] / scale[count:, None]
    offset = (matrix @ mean[:count] - mean[count:]) / scale[count:]
    return (own + derived @ of_normalised).astype(np.float32), (bias + derived @ offset).astype(np.float32)


class DerivedVecEnv(VecEnvWrapper):
    """Environments whose observations end with linear combinations of their columns.

    Earlier observations in it (`history` of them) give their own combinations, in the same order.

    Attributes:
        matrix: What turns an observation into its derived columns, (d, k) float64.

    Raises:
        ValueError: The observation has no such column.
    """

    def __init__(self, venv: VecEnv, derived: Derived, history: int) -> None:
        observed = venv.observation_space
        assert isinstance(observed, Box)
        self.matrix = coefficients(derived, venv.get_attr("columns")[0], history, observed.shape[0])
        ends = np.full(len(self.matrix), np.inf, np.float32)
        super().__init__(venv, Box(np.append(observed.low, -ends), np.append(observed.high, ends)))

    def reset(self) -> np.ndarray:
        """Start episodes in all environments."""
        return self._extended(self.venv.reset())

    def step_wait(self) -> VecEnvStepReturn:
        """Step all environments; the last observation of an episode is extended, too."""
        observations, rewards, dones, infos = self.venv.step_wait()
        for i in np.flatnonzero(dones).tolist():
            infos[i]["terminal_observation"] = self._extended(infos[i]["terminal_observation"])
        return self._extended(observations), rewards, dones, infos

    def _extended(self, observations: Any) -> np.ndarray:
        """Observations (..., k) with their derived columns, (..., k + d) float32."""
        return np.concatenate([observations, observations @ self.matrix.T], axis=-1, dtype=np.float32)


class Moments(RunningMeanStd):
    """Running mean and variance of the observation's k columns; 0 and 1 for the derived ones behind them."""

    def __init__(self, columns: int, width: int) -> None:
        super().__init__(shape=(width,))
        self._columns = columns

    def update_from_moments(self, batch_mean: np.ndarray, batch_var: np.ndarray, batch_count: float) -> None:
        """Take moments (k + d,) of more observations in."""
        super().update_from_moments(batch_mean, batch_var, batch_count)
        self.mean[self._columns :], self.var[self._columns :] = 0.0, 1.0


def fold(
    parameters: Mapping[str, torch.Tensor], normalisation: VecNormalize, matrix: np.ndarray
) -> dict[str, torch.Tensor]:
    """Parameters of a network that reads the observation alone and computes the same.

    Parameters are the state of an "MlpPolicy" of PPO, its observations are normalised (k + d columns), and
    derived by `matrix`, (d, k).
    """
    moments = normalisation.obs_rms if normalisation.norm_obs else None
    found = dict(parameters)
    for layer in _FIRST_LAYERS:
        weight, bias = (parameters[f"{layer}.{part}"].detach().numpy() for part in ("weight", "bias"))
        weight, bias = folded(weight, bias, matrix, moments, normalisation.epsilon)
        found[f"{layer}.weight"], found[f"{layer}.bias"] = torch.from_numpy(weight), torch.from_numpy(bias)
    return found
