"""Measures the benefit of each optimisation of `slipgym._numba`: the same steps with and without it, in turn.

Every variant has its own process and compiler cache. One process works at a time, all on the same
processor, and blocks alternate, so that other work on the machine hits all variants alike. Where a
process's arrays lie in memory changes its speed, so the processes are started several times.
"""

from __future__ import annotations

import os
import tempfile
from contextlib import ExitStack
from pathlib import Path
from statistics import median, quantiles
from time import perf_counter
from typing import Any

import gymnasium as gym
import numpy as np

from lab.benchmarking.processors import two_processors
from lab.benchmarking.worker import Worker
from slipgym._numba.switches import OPTIMISATIONS, VARIABLE
from slipgym.benchmarking.report import Figure
from slipgym.benchmarking.vector_player import SLIP_LIMIT, VectorPlayer, action_bounds

BLOCK_STEPS = 4096 * 8
SINGLE_STEPS = 500
BATCHES = 256, 4096
STARTS = 3
"""How often the processes are started."""


class SinglePlayer:
    """Plays one planar environment about the slip limit.

    Args:
        env_id: Id of the environment.
        resets: Whether to time resets instead of steps.
    """

    def __init__(self, env_id: str, resets: bool) -> None:
        self._env: Any = gym.make(env_id, engine="planar").unwrapped
        self._rng = np.random.default_rng(0)
        self._resets, self._actions = resets, action_bounds(self._env.config.gripper, SLIP_LIMIT)
        self._env.reset(seed=0)

    def block(self, steps: int) -> tuple[float, int]:
        """Time of some steps or resets [s], and how many they were."""
        if self._resets:
            start = perf_counter()
            for _ in range(steps):
                self._env.reset()
            return perf_counter() - start, steps
        seconds = 0.0
        for action in self._rng.uniform(*self._actions, (steps, 1)).astype(np.float32):
            start = perf_counter()
            _, _, terminated, truncated, _ = self._env.step(action)
            seconds += perf_counter() - start
            if terminated or truncated:
                self._env.reset()
        return seconds, steps


def optimisations(env_id: str, pairs: int) -> list[Figure]:
    """Time without each optimisation over the time with all of them, in the workload about the slip limit.

    Args:
        env_id: Id of the environment.
        pairs: Alternating blocks of each variant and each start of the processes.
    """
    figures = []
    for n in BATCHES:
        figures += _variants(f"batch of {n}, one thread", BLOCK_STEPS, pairs, VectorPlayer, env_id, n)
    for name, resets in (("one planar environment, step", False), ("one planar environment, reset", True)):
        figures += _variants(name, SINGLE_STEPS, pairs, SinglePlayer, env_id, resets)
    return figures


def _variants(name: str, steps: int, pairs: int, make: Any, *arguments: Any) -> list[Figure]:
    """Ratios of every variant's times over those of the blocks before it with all optimisations."""
    ratios: dict[str, list[float]] = {off: [] for off in OPTIMISATIONS}
    spent = []
    for _ in range(STARTS):
        with ExitStack() as stack:
            workers = {}
            for off in ("", *OPTIMISATIONS):
                worker = Worker(
                    _pinned, make, *arguments, processor=two_processors()[-1], environment=_environment(off)
                )
                worker.wait()  # one after the other: variants may have to be compiled
                stack.callback(worker.close)
                workers[off] = worker
                worker.block(steps)  # warm up
            for _ in range(pairs):
                for off in OPTIMISATIONS:
                    times = []
                    for worker in (workers[""], workers[off]):
                        seconds, made = worker.block(steps)
                        times.append(seconds / made)
                    spent.append(times[0])
                    ratios[off].append(times[1] / times[0])
    figures = [Figure(name, 1e6 * median(spent), "us")]
    for off, values in ratios.items():
        lower, middle, upper = quantiles(values, method="inclusive")
        figures += [
            Figure(f"{name}: without {off} / with", middle, "-"),
            Figure(f"{name}: without {off} / with, lower quartile", lower, "-"),
            Figure(f"{name}: without {off} / with, upper quartile", upper, "-"),
        ]
    return figures


def _pinned(make: Any, *arguments: Any) -> Any:
    """A player; batches run in one thread."""
    return make(*arguments, **({"threads": 1} if make is VectorPlayer else {}))


def _environment(off: str) -> dict[str, str]:
    """Environment variables of a variant: what is switched off, and a folder for its compiled code."""
    if not off:
        return {VARIABLE: ""}
    folder = Path(tempfile.gettempdir()) / f"slipgym-without-{off}-{os.getuid()}"
    return {VARIABLE: off, "NUMBA_CACHE_DIR": str(folder)}
