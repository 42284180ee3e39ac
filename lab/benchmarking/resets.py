"""Measures what the start of an episode costs, beside a step of the same environments."""

from __future__ import annotations

from functools import partial
from importlib.util import find_spec
from time import perf_counter
from typing import Any

import gymnasium as gym
import numpy as np

from lab.benchmarking.timing import compare
from slipgym.benchmarking.report import Figure

PRESET = "train"
TOGETHER = 1024
"""Environments of a batch whose episodes all begin at once."""


def resets(env_id: str, pairs: int) -> list[Figure]:
    """A reset of all rows of a batch, in one thread, and of single environments; each over a firm step."""
    batch = gym.make_vec(env_id, num_envs=TOGETHER, threads=1, randomization=PRESET)
    batch.reset(seed=0)
    result = compare(partial(_steps, batch, 4), partial(_resets, batch, 1), pairs)
    batch.close()
    title = f"batch of {TOGETHER}, randomized: reset"
    figures = [
        Figure(f"{title} of all, per episode", 1e6 * result.second / TOGETHER, "us", "<= 50"),
        Figure(f"{title} / firm step", result.quartiles[1], "-"),
    ]
    for engine in ("planar", "bullet") if find_spec("pybullet") else ("planar",):
        env = gym.make(env_id, engine=engine, randomization=PRESET)
        env.reset(seed=0)
        result = compare(partial(_steps, env, 200), partial(_resets, env, 20), pairs)
        env.close()
        title = f"one environment, {engine}, randomized: reset"
        figures.append(Figure(title, 1e6 * result.second, "us"))
        figures.append(Figure(f"{title} / firm step", result.quartiles[1], "-"))
    return figures


def _steps(env: Any, calls: int) -> tuple[float, int]:
    env.reset()
    action = np.ones(env.action_space.shape or (), dtype=np.float32)
    start = perf_counter()
    for _ in range(calls):
        env.step(action)
    return perf_counter() - start, calls


def _resets(env: Any, calls: int) -> tuple[float, int]:
    start = perf_counter()
    for _ in range(calls):
        env.reset()
    return perf_counter() - start, calls
