"""A first policy that acts like a controller, before it learns by itself."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

import policies
from policies.training import model as learners
from policies.training import vector
from policies.training.config import Imitation, Training
from policies.training.fitting import Fit
from slipgym.envs.observation import FRICTION_COLUMNS


class _Round(NamedTuple):
    """What was seen in a round, (steps, n, ...)."""

    observations: np.ndarray
    answers: np.ndarray
    rewards: np.ndarray
    ends: np.ndarray


def imitate(config: Training, model: Any, seed: int) -> None:
    """Fits a learner's actions to those of a controller: DAgger (Ross et al., arXiv 1011.0686).

    In the first round the controller acts, in the last or already from `alone_from` on the learner, in
    between each its share; the controller is asked at every step. After a round the learner is fitted to all
    answers so far, after the last its value function to the discounted rewards of that round. A learner with
    a memory is fitted to whole episodes. The controller is told the truth if the learner is, and estimated
    friction otherwise: also where the learner is told nothing; but then it looks for no friction
    (`policies.base.ForcePolicy.unaware`), as the learner could not use it.

    Args:
        config: The run; `config.imitation` says what to imitate.
        model: An untrained learner, PPO or RecurrentPPO; its statistics of observations and rewards begin
            here.
        seed: Of the first environment.

    Raises:
        ValueError: The controller does not fit the environment.
    """
    chosen, own = config.imitation, model.get_vec_normalize_env()
    assert chosen is not None
    source = "true" if config.environment.friction_source == "true" else "estimated"
    told = config.environment.model_copy(update={"friction_source": source})
    raw = vector.make(config.model_copy(update={"environment": told}), seed, shaped=True)
    envs, seen, fit = learners.normalised(config, raw), [], Fit(chosen, model)
    envs.norm_obs = False
    last = chosen.rounds - 1
    for k in range(chosen.rounds):
        share = max(0.0, 1.0 - k / max(1, chosen.alone_from or last))
        seen.append(_round(config, model, envs, _led(chosen, share, envs.num_envs)))
        _normalise(chosen, own.obs_rms, seen[-1].observations)
        fit.slow_down(1.0 - k / max(1, last))
        fit.actions(*([getattr(one, name) for one in seen] for name in ("observations", "answers", "ends")))
    own.ret_rms = envs.ret_rms
    fit.values([seen[-1].observations], [_returns(seen[-1], config)], [seen[-1].ends])
    envs.close()


def _normalise(chosen: Imitation, moments: Any, observations: np.ndarray) -> None:
    """Takes the observations of a round into the statistics that they are normalised by.

    Of the mean absolute deviation d the variance is taken as pi / 2 d^2, which it is for Gaussian values.
    """
    rows = observations.reshape(-1, observations.shape[-1])
    if chosen.spread == "variance":
        moments.update(rows)
        return
    mean = rows.mean(axis=0, dtype=np.float64)
    variance = 0.5 * np.pi * np.abs(rows - mean).mean(axis=0) ** 2
    moments.update_from_moments(mean, variance, len(rows))


def _led(chosen: Imitation, share: float, n: int) -> np.ndarray:
    """Steps of a round through which the controller leads each environment, (n,)."""
    if chosen.hand_over == "between":
        return np.where(np.arange(n) < round(n * share), chosen.steps, 0)
    return chosen.steps * np.clip((np.arange(n) + 0.5) / n + 2.0 * share - 1.0, 0.0, 1.0)


def _round(config: Training, model: Any, envs: Any, led: np.ndarray) -> _Round:
    """Steps the environments; the controller leads each for its first `led` steps."""
    chosen, frames = config.imitation, config.environment.history + 1
    assert chosen is not None
    rate = envs.get_attr("metadata")[0]["render_fps"]  # whole: the controller acts as often as the learner
    slower = {"physics": {"control_rate": round(rate)}, "sensors": {"slip": {"rate": round(rate)}}}
    alone = config.environment.friction_source == "none"
    given = getattr(policies.find(chosen.policy), "unaware", {}) if alone else {}
    teacher = policies.make(chosen.policy, config=slower, **{**given, **chosen.parameters})
    state, memory, rows = None, None, []
    observations, starts = envs.reset(), np.ones(envs.num_envs, bool)
    for step in range(chosen.steps):
        split = observations.reshape(envs.num_envs, frames, -1)
        answers, state = teacher.predict(split[:, -1], state, starts)
        if alone:
            split = split[..., : -len(FRICTION_COLUMNS)]
        own = split.reshape(envs.num_envs, -1)
        normalised = model.get_vec_normalize_env().normalize_obs(own)
        actions, memory = model.predict(normalised, memory, starts, deterministic=True)
        actions = np.where(step < led[:, None], answers, actions)
        observations, rewards, starts, _ = envs.step(actions)
        rows.append((own, answers, rewards, starts))
    return _Round(*(np.stack(column) for column in zip(*rows, strict=True)))


def _returns(seen: _Round, config: Training) -> np.ndarray:
    """Discounted rewards until the end of the episode or of the round, (steps, n)."""
    found, ahead = np.zeros_like(seen.rewards), np.zeros_like(seen.rewards[0])
    for k in range(len(found) - 1, -1, -1):
        ahead = seen.rewards[k] + config.hyperparameters.gamma * np.where(seen.ends[k], 0.0, ahead)
        found[k] = ahead
    return found
