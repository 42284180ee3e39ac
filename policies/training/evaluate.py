"""Evaluates a learner on held-out seeds."""

from __future__ import annotations

from typing import Any

import numpy as np
from stable_baselines3.common.vec_env import VecEnv

from policies.training import model as learners
from policies.training import seeds
from policies.training.config import Training
from policies.training.curve import Row


def evaluate(config: Training, model: Any, envs: VecEnv) -> Row:
    """Runs episodes without exploration, always the same ones, with the learner's statistics as they are."""
    frozen: Any = envs
    if config.algorithm != "privileged_ppo":
        frozen = learners.normalised(config, envs, training=False)
        if frozen.norm_obs:
            frozen.obs_rms = model.get_vec_normalize_env().obs_rms
    wanted, found = config.evaluation.episodes, []
    for begun in range(0, wanted, envs.num_envs):
        count = min(envs.num_envs, wanted - begun)
        found += _episodes(model, frozen, seeds.held_out(config.evaluation.first_seed + begun))[:count]
    success, drops, reward, length = np.mean(found, axis=0).tolist()
    return Row(model.num_timesteps, success, drops, reward, length)


def _episodes(model: Any, envs: Any, seed: int) -> list[tuple[float, ...]]:
    """One episode of each environment: success, drop, sum of rewards, length."""
    envs.seed(seed)
    observations: Any = envs.reset()
    outcomes: dict[int, tuple[float, ...]] = {}
    state, starts = None, np.ones(envs.num_envs, dtype=bool)
    while len(outcomes) < envs.num_envs:
        actions, state = model.predict(observations, state, starts, deterministic=True)
        observations, _, starts, infos = envs.step(actions)
        for i in np.flatnonzero(starts).tolist():
            info = infos[i]
            outcome = info["is_success"], info["dropped"], info["episode"]["r"], info["episode"]["l"]
            outcomes.setdefault(i, outcome)
    return [outcomes[i] for i in range(envs.num_envs)]
