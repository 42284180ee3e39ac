"""Measures the environments on this machine: steps per second and memory."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from statistics import median
from time import perf_counter

import gymnasium as gym
import numpy as np

from slipgym.benchmarking import report
from slipgym.benchmarking.memory import bytes_per_environment
from slipgym.benchmarking.report import Figure
from slipgym.benchmarking.vector_player import SLIP_LIMIT, VectorPlayer, action_bounds

SIZES = 1, 16, 256, 4096
FIRM = 15.0, 25.0
"""Commanded forces of a firm hold [N]."""
STEPS = 200
"""Control steps of a single environment in a timed block."""


def benchmark(env_id: str, pairs: int, json: Path | None = None) -> None:
    """Measure and print.

    Args:
        env_id: Id of the environment.
        pairs: Ten times the timed blocks of each figure.
        json: File to write the figures to.
    """
    print(report.line(report.machine()))
    repeats = max(3, pairs // 10)
    report.publish([*single(env_id, repeats), *batches(env_id, repeats)], json)


def engines() -> tuple[str, ...]:
    """The engines that are installed."""
    return ("planar", "bullet") if find_spec("pybullet") else ("planar",)


def single(env_id: str, repeats: int) -> Iterator[Figure]:
    """Control steps per second of one environment about the slip limit, with the resets in them.

    Args:
        env_id: Id of the environment.
        repeats: Timed blocks; the median counts.
    """
    for engine in engines():
        env = gym.make(env_id, engine=engine, disable_env_checker=True).unwrapped
        bounds = action_bounds(env.config.gripper, SLIP_LIMIT)  # type: ignore[attr-defined]
        actions = np.random.default_rng(0).uniform(*bounds, (STEPS, 1)).astype(np.float32)
        env.reset(seed=0)
        times = []
        for _ in range(repeats + 1):
            start = perf_counter()
            for action in actions:
                _, _, terminated, truncated, _ = env.step(action)
                if terminated or truncated:
                    env.reset()
            times.append(perf_counter() - start)
        env.close()
        yield Figure(f"one environment, {engine}: steps per second", STEPS / median(times[1:]), "1/s")


def batches(env_id: str, repeats: int) -> Iterator[Figure]:
    """Steps per second of batches about the slip limit and in a firm hold, and memory per environment.

    Args:
        env_id: Id of the environment.
        repeats: Timed blocks; the median counts.
    """
    for n in SIZES:
        for name, forces in {"about the slip limit": SLIP_LIMIT, "held firmly": FIRM}.items():
            player = VectorPlayer(env_id, n, forces)
            player.block()  # the first steps compile and fill the caches
            rates = [steps / seconds for seconds, steps in (player.block() for _ in range(repeats))]
            yield Figure(f"batch of {n}, {name}: steps per second", median(rates), "1/s")
            size = bytes_per_environment(player.env)
            player.env.close()
        yield Figure(f"batch of {n}: memory per environment", size / 1024, "KiB")
