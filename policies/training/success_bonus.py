"""A reward for solved episodes, in the environments in which a learner learns."""

from __future__ import annotations

import numpy as np
from stable_baselines3.common.vec_env import VecEnv, VecEnvWrapper
from stable_baselines3.common.vec_env.base_vec_env import VecEnvObs, VecEnvStepReturn


class BonusVecEnv(VecEnvWrapper):
    """Environments that pay for an episode that ends solved.

    Args:
        venv: The environments.
        bonus: Added to the reward of an episode's last step if the episode is solved.
    """

    def __init__(self, venv: VecEnv, bonus: float) -> None:
        super().__init__(venv)
        self._bonus = bonus

    def reset(self) -> VecEnvObs:
        """Start episodes in all environments."""
        return self.venv.reset()

    def step_wait(self) -> VecEnvStepReturn:
        """Step all environments."""
        observations, rewards, dones, infos = self.venv.step_wait()
        solved = [done and info["is_success"] for done, info in zip(dones, infos, strict=True)]
        return observations, rewards + self._bonus * np.array(solved, np.float32), dones, infos
