"""A first policy that acts like a controller, before it learns by itself."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import torch
from torch.nn.functional import mse_loss

import policies
from policies.training import model as learners
from policies.training import vector
from policies.training.config import Imitation, Training
from slipgym.envs.observation import FRICTION_COLUMNS

_BATCH = 1024


class _Round(NamedTuple):
    """What was seen in a round, (steps, n, ...)."""

    observations: np.ndarray
    answers: np.ndarray
    rewards: np.ndarray
    ends: np.ndarray


def imitate(config: Training, model: Any, seed: int) -> None:
    """Fits a learner's actions to those of a controller: DAgger (Ross et al., arXiv 1011.0686).

    In the first round the controller acts, in the last the learner, in between each in its share of the
    environments; the controller is asked at every step. After a round the learner is fitted to all answers so
    far, after the last its value function to the discounted rewards of that round. The controller is told
    the truth if the learner is, and estimated friction otherwise: also where the learner is told nothing; but
    then it looks for no friction (`policies.base.ForcePolicy.unaware`), as the learner could not use it.

    Args:
        config: The run; `config.imitation` says what to imitate.
        model: An untrained learner (PPO); its statistics of observations and rewards begin here.
        seed: Of the first environment.

    Raises:
        ValueError: The controller does not fit the environment.
    """
    chosen, own = config.imitation, model.get_vec_normalize_env()
    assert chosen is not None
    source = "true" if config.environment.friction_source == "true" else "estimated"
    told = config.environment.model_copy(update={"friction_source": source})
    raw = vector.make(config.model_copy(update={"environment": told}), seed, shaped=True)
    envs, seen = learners.normalised(config, raw), []
    envs.norm_obs = False
    optimizer = torch.optim.Adam(model.policy.parameters(), chosen.learning_rate)
    for k in range(chosen.rounds):
        led = round(envs.num_envs * (1.0 - k / max(1, chosen.rounds - 1)))
        seen.append(_round(config, model, envs, led))
        own.obs_rms.update(seen[-1].observations.reshape(-1, seen[-1].observations.shape[-1]))
        x, y = (np.concatenate([getattr(one, name) for one in seen]) for name in ("observations", "answers"))
        _fit(chosen, optimizer, model, x, y, _means)
    own.ret_rms = envs.ret_rms
    _fit(chosen, optimizer, model, seen[-1].observations, _returns(seen[-1], config), _values)
    envs.close()


def _round(config: Training, model: Any, envs: Any, led: int) -> _Round:
    """Steps the environments; the controller leads the first `led`."""
    chosen, frames = config.imitation, config.environment.history + 1
    assert chosen is not None
    rate = envs.get_attr("metadata")[0]["render_fps"]  # whole: the controller acts as often as the learner
    slower = {"physics": {"control_rate": round(rate)}, "sensors": {"slip": {"rate": round(rate)}}}
    alone = config.environment.friction_source == "none"
    given = getattr(policies.find(chosen.policy), "unaware", {}) if alone else {}
    teacher, state, rows = policies.make(chosen.policy, config=slower, **given), None, []
    observations, starts = envs.reset(), np.ones(envs.num_envs, bool)
    for _ in range(chosen.steps):
        split = observations.reshape(envs.num_envs, frames, -1)
        answers, state = teacher.predict(split[:, -1], state, starts)
        if alone:
            split = split[..., : -len(FRICTION_COLUMNS)]
        own = split.reshape(envs.num_envs, -1)
        actions = model.predict(model.get_vec_normalize_env().normalize_obs(own), deterministic=True)[0]
        actions[:led] = answers[:led]
        observations, rewards, starts, _ = envs.step(actions)
        rows.append((own, answers, rewards, starts))
    return _Round(*(np.stack(column) for column in zip(*rows, strict=True)))


def _fit(chosen: Imitation, optimizer: Any, model: Any, x: np.ndarray, y: np.ndarray, output: Any) -> None:
    """Least squares over a few passes."""
    normalised = model.get_vec_normalize_env().normalize_obs(x.reshape(-1, x.shape[-1]))
    inputs = torch.as_tensor(normalised, dtype=torch.float32)
    targets = torch.as_tensor(y.reshape(len(inputs), -1), dtype=torch.float32)
    for _ in range(chosen.epochs):
        for batch in torch.randperm(len(inputs)).split(_BATCH):
            optimizer.zero_grad()
            mse_loss(output(model.policy, inputs[batch]), targets[batch]).backward()
            optimizer.step()


def _means(policy: Any, observations: torch.Tensor) -> torch.Tensor:
    """Mean actions."""
    return policy.get_distribution(observations).distribution.mean


def _values(policy: Any, observations: torch.Tensor) -> torch.Tensor:
    return policy.predict_values(observations)


def _returns(seen: _Round, config: Training) -> np.ndarray:
    """Discounted rewards until the end of the episode or of the round, (steps, n)."""
    found, ahead = np.zeros_like(seen.rewards), np.zeros_like(seen.rewards[0])
    for k in range(len(found) - 1, -1, -1):
        ahead = seen.rewards[k] + config.hyperparameters.gamma * np.where(seen.ends[k], 0.0, ahead)
        found[k] = ahead
    return found
