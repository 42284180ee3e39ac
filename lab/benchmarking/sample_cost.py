"""Measures what a sample of a training run costs, by part."""

from __future__ import annotations

from collections.abc import Iterator
from time import process_time
from typing import Any

import torch
from stable_baselines3.common.vec_env import VecMonitor, VecNormalize

from lab.benchmarking.stopwatches import Stopwatches
from policies.training import evaluate, files, seeds, vector
from policies.training import model as learners
from policies.training.adapter import SlipVecEnv
from policies.training.config import Training
from policies.training.derived import DerivedVecEnv
from policies.training.residual import ResidualVecEnv
from slipgym.benchmarking.report import Figure
from slipgym.config.errors import unknown
from slipgym.tasks import find

_WRAPPERS: dict[type, str] = {
    SlipVecEnv: "adapter",
    VecMonitor: "monitor",
    ResidualVecEnv: "controller",
    DerivedVecEnv: "derived columns",
    VecNormalize: "normalisation",
}
"""Label of each layer around the vector environment."""


def configuration(env_id: str) -> str:
    """The configuration of an environment's task that trains with Stable-Baselines3's PPO.

    Raises:
        ValueError: The task has none.
    """
    name = f"{find(env_id).key}_plain"
    if name not in files.names():
        raise ValueError(unknown("training configuration", name, files.names()))
    return name


def sample_cost(name: str, updates: int) -> list[Figure]:
    """CPU time per sample of a configuration with PPO on the batch, by part.

    The first update is not measured. An evaluation is measured once; its time is divided by the samples
    between two evaluations.

    Args:
        name: Of the configuration.
        updates: Rollouts and updates that are measured.

    Returns:
        CPU time per sample [µs]: that of each part, then the sum.
    """
    config = files.load(name, {})
    first = seeds.training(0)
    training = vector.make(config, first, shaped=True)
    held_out = vector.make(config, seeds.held_out(0), min(config.num_envs, config.evaluation.episodes))
    model: Any = learners.make(config, learners.normalised(config, training), first)
    rollout = model.n_steps * config.num_envs
    model.learn(rollout)
    samples = updates * rollout
    with Stopwatches(clock=process_time) as watches:
        _watch(watches, model)
        model.learn(samples, reset_num_timesteps=False)
    spent = {label: seconds / samples for label, seconds in watches.spent.items()}
    spent["evaluation"] = _evaluation(config, model, held_out) / config.evaluation.every
    training.close()
    held_out.close()
    spent["sum"] = sum(spent.values())
    return [Figure(f"{name}, {label}", 1e6 * seconds, "us") for label, seconds in spent.items()]


def _watch(watches: Stopwatches, model: Any) -> None:
    """Time the parts of `model.learn`."""
    for layer in _layers(model.get_env()):
        watches.watch(_WRAPPERS[type(layer)], layer, "step_wait")
        if isinstance(layer, SlipVecEnv):
            watches.watch("environments", layer.env, "step")
            watches.watch("resets", layer.env, "reset")
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


def _layers(envs: Any) -> Iterator[Any]:
    """A stack of environments, from the outermost layer to the adapter."""
    while not isinstance(envs, SlipVecEnv):
        yield envs
        envs = envs.venv
    yield envs


def _evaluation(config: Training, model: Any, envs: Any) -> float:
    """CPU time of an evaluation [s]; the second one, since the first one also prepares its options."""
    evaluate.evaluate(config, model, envs)
    start = process_time()
    evaluate.evaluate(config, model, envs)
    return process_time() - start
