"""The learner: made from a configuration, its whole state taken out and put back."""

from __future__ import annotations

import random
from typing import Any

import numpy as np
import torch
from sb3_contrib import TQC, RecurrentPPO
from sb3_contrib.common.recurrent.type_aliases import RNNStates
from stable_baselines3 import PPO, SAC
from stable_baselines3.common.base_class import BaseAlgorithm
from stable_baselines3.common.vec_env import VecNormalize
from torch import nn

from policies.training import vector
from policies.training.config import Training
from policies.training.derived import DerivedVecEnv, Moments
from policies.training.privileged_ppo import PrivilegedPPO
from policies.training.state_checks import arrays, check_like, fits, moments, set_moments, tensors

_CLASSES: dict[str, Any] = {"ppo": PPO, "recurrent_ppo": RecurrentPPO, "sac": SAC, "tqc": TQC}
_ACTIVATIONS = {"tanh": nn.Tanh, "relu": nn.ReLU, "elu": nn.ELU}
_EPSILON = {"ppo": 1e-5, "recurrent_ppo": 1e-5}
"""Epsilon of Adam where it is not torch's; that of Stable-Baselines3."""
_HUGE = 1e12
"""A parameter that no network has that acts; its square is still a number of 32 bits."""
_OF_POLICY = ("net_arch", "activation", "log_std_init", "lstm_hidden_size", "n_critics")
_COUNTERS = ("num_timesteps", "_episode_num", "_n_updates", "_current_progress_remaining")
_LAST = ("_last_obs", "_last_episode_starts", "_last_original_obs")
_REPLAY = ("observations", "next_observations", "actions", "rewards", "dones", "timeouts")


def normalised(config: Training, envs: Any, training: bool = True) -> VecNormalize:
    """Environments whose observations and rewards are normalised as configured."""
    chosen = config.normalisation
    made = VecNormalize(
        envs,
        training=training,
        norm_obs=chosen.observation,
        norm_reward=chosen.reward and training,
        clip_obs=chosen.clip,
        clip_reward=chosen.clip,
        gamma=config.hyperparameters.gamma,
    )
    if isinstance(envs, DerivedVecEnv) and chosen.observation:
        made.obs_rms = Moments(envs.matrix.shape[1], sum(envs.matrix.shape))
        ends: Any = np.repeat([chosen.clip, np.inf], envs.matrix.shape[::-1])
        made.clip_obs = ends  # derived columns keep their size: `fold` is exact
    return made


def begin(config: Training, seed: int) -> Any:
    """An untrained learner, see `make`, in environments of its own, which `get_env().close()` ends."""
    if config.algorithm == "privileged_ppo":
        return PrivilegedPPO(config, seed)
    return make(config, normalised(config, vector.make(config, seed, shaped=True)), seed)


def make(config: Training, envs: VecNormalize, seed: int) -> BaseAlgorithm:
    """An untrained learner in environments from `normalised`.

    The seed is that of the first environment; the networks are seeded with it, too.
    """
    torch.set_num_threads(config.threads)
    values = config.hyperparameters.model_dump()
    start, end = values.pop("learning_rate"), values.pop("learning_rate_end")
    policy: dict[str, Any] = {name: values.pop(name) for name in _OF_POLICY if name in values}
    policy["activation_fn"] = _ACTIVATIONS[policy.pop("activation")]
    policy["net_arch"] = list(policy["net_arch"])
    policy["optimizer_kwargs"] = {"eps": _EPSILON.get(config.algorithm, 1e-8), "fused": True}
    if config.algorithm == "tqc":
        policy["n_quantiles"] = 25
    return _CLASSES[config.algorithm](
        "MlpLstmPolicy" if config.algorithm == "recurrent_ppo" else "MlpPolicy",
        envs,
        learning_rate=lambda left: start * (end + (1.0 - end) * left),
        policy_kwargs=policy,
        seed=seed,
        device="cpu",
        **values,
    )


def get_state(model: Any, replay: bool = True) -> dict[str, Any]:
    """Everything that decides how training goes on, as plain data, maybe with the replay buffer.

    The learner must be between two updates.
    """
    if isinstance(model, PrivilegedPPO):
        return model.get_state(environments=replay)
    envs = model.get_vec_normalize_env()
    state: dict[str, Any] = {
        "parameters": arrays(model.get_parameters()),
        "entropy": arrays(getattr(model, "log_ent_coef", None)),
        "counters": {name: getattr(model, name) for name in _COUNTERS},
        "last": {name: _copied(getattr(model, name)) for name in _LAST},
        "lstm": arrays(getattr(model, "_last_lstm_states", None)),
        "normalisation": normalisation(envs),
        "environments": vector.get_state(envs.venv),
        # those that Stable-Baselines3 draws from; torch's and numpy's are global
        "generators": {
            "torch": torch.get_rng_state().numpy().copy(),
            "numpy": np.random.get_state(),  # noqa: NPY002
            "python": random.getstate(),
            "actions": model.action_space.np_random.bit_generator.state,
        },
    }
    if replay and not isinstance(model, PPO | RecurrentPPO):
        buffer = model.replay_buffer
        size = buffer.buffer_size if buffer.full else buffer.pos
        state["replay"] = {name: getattr(buffer, name)[:size].copy() for name in _REPLAY}
        state["replay"] |= {"pos": buffer.pos, "full": buffer.full}
    return state


def set_state(model: Any, state: dict[str, Any]) -> None:
    """Go on from a state: learner, normalisation, environments, random numbers.

    Raises:
        ValueError: It is of a learner with another configuration.
    """
    with fits("the checkpoint"):
        if isinstance(model, PrivilegedPPO):
            model.set_state(state)
            return
        _check(model, state)
        _set_state(model, state)


def _check(model: Any, state: dict[str, Any]) -> None:
    """Raise ValueError if a state has other shapes than this learner, or holds NaN."""
    own = get_state(model, replay=False) | {"parameters": None, "lstm": None, "environments": None}
    seen = np.zeros((model.n_envs, *model.observation_space.shape), np.float32)
    last = dict(zip(_LAST, (seen, np.zeros(model.n_envs, bool), seen), strict=True))
    own["last"] = {name: like if state["last"][name] is not None else None for name, like in last.items()}
    if "replay" in state:
        saved, buffer = state["replay"], model.replay_buffer
        size = buffer.buffer_size if saved["full"] else saved["pos"]
        own["replay"] = {name: getattr(buffer, name)[:size] for name in _REPLAY} | {"pos": 0, "full": False}
    check_like("learner", {**state, "environments": None}, own)  # those check theirs


def _set_state(model: Any, state: dict[str, Any]) -> None:
    envs = model.get_vec_normalize_env()
    set_parameters(model, state)
    for name in _COUNTERS:
        setattr(model, name, state["counters"][name])
    for name in _LAST:
        setattr(model, name, _copied(state["last"][name]))
    if state["lstm"] is not None:
        model._last_lstm_states = RNNStates(*tensors(state["lstm"]))
    set_normalisation(envs, state["normalisation"])
    vector.set_state(envs.venv, state["environments"])
    if "replay" in state:
        saved, buffer = state["replay"], model.replay_buffer
        for name in _REPLAY:
            getattr(buffer, name)[: len(saved[name])] = saved[name]
        buffer.pos, buffer.full = saved["pos"], saved["full"]
    generators = state["generators"]
    torch.set_rng_state(torch.from_numpy(generators["torch"].copy()))
    np.random.set_state(generators["numpy"])  # noqa: NPY002
    random.setstate(generators["python"])
    model.action_space.np_random.bit_generator.state = generators["actions"]


def check_finite(model: Any) -> None:
    """Raise FloatingPointError if a parameter of a learner's networks is NaN or too large for its sums."""
    networks = (model.ppo.actor, model.ppo.critic) if isinstance(model, PrivilegedPPO) else (model.policy,)
    if not all(bool((one.abs() < _HUGE).all()) for each in networks for one in each.parameters()):
        raise FloatingPointError(
            f"after {model.num_timesteps} steps a parameter of the learner is NaN or beyond {_HUGE:g}: try a "
            "smaller learning_rate"
        )


def renew_noise(model: Any) -> None:
    """Draw the noise of gSDE anew, as the run's seed and the number of steps say.

    Stable-Baselines3 draws it before a run writes its checkpoint; a resumed run draws it once more.
    """
    (seed,) = np.random.SeedSequence([model.seed, model.num_timesteps]).generate_state(1).tolist()
    torch.manual_seed(seed)
    model.policy.reset_noise(model.n_envs)


def set_parameters(model: Any, state: dict[str, Any]) -> None:
    """Give a learner the parameters of a state, optimizers included."""
    if isinstance(model, PrivilegedPPO):
        model.set_parameters(state)
        return
    model.set_parameters(tensors(state["parameters"]), exact_match=True, device="cpu")
    if state["entropy"] is not None:
        with torch.no_grad():
            model.log_ent_coef.copy_(tensors(state["entropy"]))


def normalisation(envs: VecNormalize) -> dict[str, Any]:
    """Running statistics of observations and returns."""
    return {**{name: moments(rms) for name, rms in _moments(envs).items()}, "running": envs.returns.copy()}


def set_normalisation(envs: VecNormalize, state: dict[str, Any]) -> None:
    """Go on from statistics."""
    check_like("normalisation", state, normalisation(envs))
    for name, rms in _moments(envs).items():
        set_moments(rms, state[name])
    envs.returns = state["running"].copy()


def _moments(envs: VecNormalize) -> dict[str, Any]:
    return {"returns": envs.ret_rms, **({"observations": envs.obs_rms} if envs.norm_obs else {})}


def _copied(value: Any) -> Any:
    return value.copy() if isinstance(value, np.ndarray) else value
