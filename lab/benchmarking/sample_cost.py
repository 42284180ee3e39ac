"""Measures what a sample of a training run costs, by part."""

from __future__ import annotations

from time import process_time
from typing import Any

import torch
from stable_baselines3.common.callbacks import CallbackList
from stable_baselines3.common.vec_env import VecMonitor, VecNormalize

from lab.benchmarking.stopwatches import Stopwatches
from policies.training import callback, files, seeds, vector
from policies.training import model as learners
from policies.training.adapter import SlipVecEnv
from policies.training.derived import DerivedVecEnv
from policies.training.privileged_ppo import PrivilegedPPO
from slipgym.benchmarking.report import Figure

_WRAPPERS: dict[type, str] = {
    SlipVecEnv: "adapter",
    VecMonitor: "monitor",
    DerivedVecEnv: "derived columns",
    VecNormalize: "normalisation",
}
"""Label of each layer around the vector environment."""


def sample_cost(name: str, updates: int) -> list[Figure]:
    """CPU time per sample of a configuration on the batch, by part.

    The first update is not measured. An evaluation is measured once; its time is divided by the samples
    between two evaluations.

    Args:
        name: Of the configuration; its algorithm is "ppo" or "privileged_ppo".
        updates: Rollouts and updates that are measured.

    Returns:
        CPU time per sample [µs]: that of each part, then the sum.
    """
    config = files.load(name)
    first = seeds.training(0)
    held_out = vector.make(config, seeds.held_out(0), min(config.num_envs, config.evaluation.episodes))
    model: Any = learners.begin(config, first)
    rollout, idle = getattr(config, config.algorithm).n_steps * config.num_envs, CallbackList([])
    model.learn(rollout, idle)
    samples = updates * rollout
    with Stopwatches(clock=process_time) as watches:
        _watch_layers(watches, model.get_env())
        (_watch_privileged if isinstance(model, PrivilegedPPO) else _watch)(watches, model)
        model.learn(samples, idle, reset_num_timesteps=False)
    spent = {part: seconds / samples for part, seconds in watches.spent.items()}
    callback.evaluate(config, model, held_out)  # the first one also prepares its options
    start = process_time()
    callback.evaluate(config, model, held_out)
    spent["evaluation"] = (process_time() - start) / config.evaluation.every
    model.get_env().close()
    held_out.close()
    spent["sum"] = sum(spent.values())
    return [Figure(f"{name}, {part}", 1e6 * seconds, "us") for part, seconds in spent.items()]


def _watch_layers(watches: Stopwatches, envs: Any) -> None:
    """Time each layer of a stack of environments."""
    while not isinstance(envs, SlipVecEnv):
        watches.watch(_WRAPPERS[type(envs)], envs, "step_wait")
        envs = envs.venv
    watches.watch(_WRAPPERS[SlipVecEnv], envs, "step_wait")
    watches.watch("environments", envs.env, "step")
    watches.watch("resets", envs.env, "reset")


def _watch(watches: Stopwatches, model: Any) -> None:
    """Time the parts of `learn` of Stable-Baselines3's PPO."""
    policy, buffer = model.policy, model.rollout_buffer
    watches.watch("policy in rollouts", policy, "forward")
    watches.watch("policy in rollouts", policy, "predict_values")
    watches.watch("buffer and minibatches", buffer, "add")
    watches.watch("buffer and minibatches", buffer, "compute_returns_and_advantage")
    watches.watch("buffer and minibatches", buffer, "swap_and_flatten")
    watches.watch("buffer and minibatches", buffer, "_get_samples")
    watches.watch("forward pass", policy, "evaluate_actions")
    watches.watch("backward pass", torch.Tensor, "backward")
    watches.watch("gradient clipping", torch.nn.utils, "clip_grad_norm_")
    watches.watch("optimiser", policy.optimizer, "step")
    watches.watch("optimiser", policy.optimizer, "zero_grad")
    watches.watch("losses and loops of the learner", model, "learn")


def _watch_privileged(watches: Stopwatches, model: Any) -> None:
    """Time the parts of `learn` of `privileged_ppo`."""
    watches.watch("normalisation", model, "_observed")
    watches.watch("actor and critic in rollouts", model.ppo, "act")
    watches.watch("update", model.ppo, "update")
    watches.watch("loops of the learner", model, "learn")
