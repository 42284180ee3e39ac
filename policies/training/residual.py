"""Environments in which a learner changes the actions of a controller."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium.spaces import Box
from stable_baselines3.common.vec_env import VecEnv, VecEnvWrapper
from stable_baselines3.common.vec_env.base_vec_env import VecEnvStepReturn

from policies.learned.residual import Underlying


class ResidualVecEnv(VecEnvWrapper):
    """Environments whose observations end with a controller's action and memory, and whose actions change it.

    Args:
        venv: The environments; observations are vectors.
        underlying: The controller.
    """

    def __init__(self, venv: VecEnv, underlying: Underlying) -> None:
        observed, acted = venv.observation_space, venv.action_space
        assert isinstance(observed, Box)
        assert isinstance(acted, Box)
        low, high = (
            np.concatenate([getattr(space, end) for space in (observed, acted)]) for end in ("low", "high")
        )
        memory = np.full(underlying.memory, np.inf, np.float32)
        super().__init__(venv, Box(np.append(low, -memory), np.append(high, memory)))
        self._underlying, self._state = underlying, None
        self._given = np.zeros((venv.num_envs, *acted.shape), np.float32)

    def reset(self) -> np.ndarray:
        """Start episodes in all environments; the controller forgets all."""
        return self._seen(self.venv.reset(), np.ones(self.num_envs, bool))

    def step_async(self, actions: np.ndarray) -> None:
        """Take the changes (n, k) of the next `step_wait`."""
        self.venv.step_async(self._underlying.changed(self._given, actions))

    def step_wait(self) -> VecEnvStepReturn:
        """Step all environments; the controller acts on what an episode's last observation is, too."""
        observations, rewards, dones, infos = self.venv.step_wait()
        if dones.any():
            last: Any = np.array(observations)
            for i in np.flatnonzero(dones):
                last[i] = infos[i]["terminal_observation"]
            _, read, _ = self._underlying.act(last, self._state, None)
            for i in np.flatnonzero(dones):
                infos[i]["terminal_observation"] = read[i]
        return self._seen(observations, dones), rewards, dones, infos

    def get_state(self) -> dict[str, Any]:
        """The controller's memory and its present actions, as plain data."""
        return {"memory": self._state, "given": self._given.copy()}

    def set_state(self, state: dict[str, Any]) -> None:
        """Go on from a state."""
        self._state, self._given = state["memory"], state["given"].copy()

    def _seen(self, observations: Any, starts: np.ndarray) -> np.ndarray:
        self._given, read, self._state = self._underlying.act(observations, self._state, starts)
        return read
