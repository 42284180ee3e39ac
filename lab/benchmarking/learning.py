"""Measures what learning costs end to end, and what the adapter adds to a step."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter
from typing import Any

import gymnasium as gym
import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import DummyVecEnv, VecEnv, VecMonitor

from lab.benchmarking.measure import ACTIONS
from lab.benchmarking.sample_cost import sample_cost
from lab.benchmarking.stopwatches import Stopwatches
from lab.benchmarking.timing import Block, compare
from policies.training import files
from policies.training.adapter import make_vec_env
from slipgym.benchmarking import report
from slipgym.benchmarking.report import Figure
from slipgym.tasks import find

LIBRARIES = ("stable-baselines3", "torch")
BATCH, SCALAR = 256, 8
"""Environments that PPO learns in."""
ROLLOUT = 8192
"""Samples between two updates of PPO, whatever the number of environments."""
SIZES = 256, 4096
"""Batches whose steps are taken apart."""
STEPS = 1000
"""As many: more than an episode has, so that every environment ends some."""
RECURRENT = "fragile_hold_memory"
"""Whose cost is that of a recurrent learner, of a task that has no configuration "<task>_memory"."""


def benchmark(env_id: str, pairs: int, json: Path | None = None) -> None:
    """Measure and print.

    Args:
        env_id: Id of the environment.
        pairs: Pairs of timed blocks; a fiftieth of PPO, a twentieth of updates of a configuration, but at
            least 2.
        json: File to write the figures to.
    """
    print(report.line(report.machine(*LIBRARIES)))
    torch.set_num_threads(1)  # more cost PPO's small networks time, most of all where other work runs
    figures = learning(env_id, max(2, pairs // 50))
    for size in SIZES:
        figures += shares(env_id, size, STEPS)
    wanted = [f"{find(env_id).key}_{ending}" for ending in ("plain", "scratch", "memory")]
    found = [name for name in wanted if name in files.names()]
    if not found[-1].endswith("_memory"):
        found.append(RECURRENT)
    for name in found:
        figures += sample_cost(name, max(2, pairs // 20))
    report.publish(figures, json, *LIBRARIES)


def learning(env_id: str, pairs: int, rollout: int = ROLLOUT) -> list[Figure]:
    """PPO with its default networks and epochs, in a batch and in PyBullet environments, in turn.

    Args:
        env_id: Id of the environment.
        pairs: Pairs of blocks: a rollout and its update each.
        rollout: Samples of a block.
    """
    batch = make_vec_env(env_id, BATCH)
    scalar = VecMonitor(DummyVecEnv([lambda: gym.make(env_id, disable_env_checker=True).unwrapped] * SCALAR))
    first, second = _learner(batch, rollout), _learner(scalar, rollout)
    blocks = _learning(first, rollout), _learning(second, rollout)
    for block in blocks:
        block()  # warm up
    result = compare(*blocks, pairs)
    with Stopwatches() as watches:
        watches.watch("learner", first, "learn")
        watches.watch("environments", batch, "step")
        first.learn(2 * rollout, reset_num_timesteps=False)
    batch.close()
    scalar.close()
    lower, middle, upper = result.quartiles
    return [
        Figure(f"PPO in {SCALAR} PyBullet environments", 1.0 / result.second, "samples/s"),
        Figure(f"PPO in a batch of {BATCH}", 1.0 / result.first, "samples/s"),
        Figure("PPO, batch / PyBullet", middle, "-"),
        Figure("PPO, batch / PyBullet, lower quartile", lower, "-"),
        Figure("PPO, batch / PyBullet, upper quartile", upper, "-"),
        Figure(
            f"PPO in a batch of {BATCH}, share of the environments",
            watches.spent["environments"] / sum(watches.spent.values()),
            "-",
        ),
    ]


def shares(env_id: str, size: int, steps: int) -> list[Figure]:
    """Time of the batch, the adapter and the monitor in the same steps; episodes end and begin in them.

    Args:
        env_id: Id of the environment.
        size: Environments.
        steps: Steps of all of them.
    """
    envs = make_vec_env(env_id, size, seed=0)
    adapter: Any = envs.unwrapped
    envs.reset()
    play = _playing(envs, steps)
    with Stopwatches() as watches:
        watches.watch("batch", adapter.env, "step")
        watches.watch("adapter", adapter, "step_wait")
        watches.watch("monitor", envs, "step_wait")
        play()
    envs.close()
    spent = {label: 1e6 * seconds / steps for label, seconds in watches.spent.items()}
    return [
        Figure(f"SlipVectorEnv.step, n = {size}", spent["batch"], "us"),
        Figure(f"SlipVecEnv, n = {size}", spent["adapter"], "us"),
        Figure(f"SlipVecEnv, n = {size}, share", spent["adapter"] / (spent["batch"] + spent["adapter"]), "-"),
        Figure(f"VecMonitor, n = {size}", spent["monitor"], "us"),
    ]


def _learner(envs: VecEnv, rollout: int) -> PPO:
    return PPO("MlpPolicy", envs, n_steps=rollout // envs.num_envs, batch_size=256, seed=0, device="cpu")


def _learning(model: PPO, rollout: int) -> Block:
    def block() -> tuple[float, int]:
        start = perf_counter()
        model.learn(rollout, reset_num_timesteps=False)
        return perf_counter() - start, rollout

    return block


def _playing(envs: Any, steps: int) -> Block:
    """Steps with random grip forces about the slip limit."""
    rng, size = np.random.default_rng(0), envs.num_envs

    def block() -> tuple[float, int]:
        actions = rng.uniform(*ACTIONS, (steps, size, 1)).astype(np.float32)
        start = perf_counter()
        for action in actions:
            envs.step(action)
        return perf_counter() - start, steps

    return block
