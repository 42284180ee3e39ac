"""Measures the environments on this machine: steps per second and memory."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields
from importlib.util import find_spec
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

import gymnasium as gym
import numpy as np

from slipgym.benchmarking import report
from slipgym.benchmarking.report import Figure
from slipgym.config.hardware import GripperConfig
from slipgym.envs.vector_env import SlipVectorEnv

SIZES = 1, 16, 256, 4096
FIRM = 15.0, 25.0
"""Commanded forces of a firm hold [N]."""
SLIP_LIMIT = 1.0, 4.0
"""Commanded forces of the headline workload, about the slip limit [N]."""
BATCH_STEPS = 4000
"""Steps of all environments together in a timed block, at least `TURNS` vector steps."""
TURNS = 16
STEPS = 200
"""Control steps of a single environment in a timed block."""


def benchmark(env_id: str, pairs: int, json: Path | None = None) -> None:
    """Measure an environment and print the figures, and write them to a file if one is given.

    `pairs` is ten times the timed blocks of each figure.
    """
    print(report.line(report.machine()))
    repeats = max(3, pairs // 10)
    report.publish([*single(env_id, repeats), *batches(env_id, repeats)], json)


def engines() -> tuple[str, ...]:
    """The engines that are installed."""
    return ("planar", "bullet") if find_spec("pybullet") else ("planar",)


def single(env_id: str, repeats: int) -> Iterator[Figure]:
    """Control steps per second of one environment about the slip limit, with the resets in them.

    The median of the timed blocks counts.
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
    """Steps per second of batches about the slip limit and in a firm hold, and memory per environment."""
    for n in SIZES:
        for name, forces in {"about the slip limit": SLIP_LIMIT, "held firmly": FIRM}.items():
            player = VectorPlayer(env_id, n, forces)
            player.block()  # the first steps compile and fill the caches
            rates = [steps / seconds for seconds, steps in (player.block() for _ in range(repeats))]
            yield Figure(f"batch of {n}, {name}: steps per second", median(rates), "1/s")
            size = bytes_per_environment(player.env)
            player.env.close()
        yield Figure(f"batch of {n}: memory per environment", size / 1024, "KiB")


def bytes_per_environment(env: SlipVectorEnv) -> float:
    """Bytes of all arrays that last from step to step, over the number of environments.

    Python's own objects come on top: a random generator, the description of the box, the name of the
    material and what the randomization drew.
    """
    state = env.get_state()
    plant = [getattr(state.simulation.plant, field.name) for field in fields(state.simulation.plant)]
    arrays = [*plant, *state.simulation.arrays.values(), state.frames]
    return sum(array.nbytes for array in arrays if array is not None) / env.num_envs


def action_bounds(gripper: GripperConfig, forces: tuple[float, float]) -> tuple[float, float]:
    """Actions of the mode "grip_force" for the bounds of a range of forces [N]."""
    low, high = gripper.force_min, gripper.force_max
    least, most = (min(max(2.0 * (force - low) / (high - low) - 1.0, -1.0), 1.0) for force in forces)
    return least, most


class VectorPlayer:
    """Plays a vector environment with a random commanded force for each environment and step.

    Args:
        env_id: Id of the environment.
        n: Environments.
        forces: Bounds of the commanded forces [N], within those of the gripper.
        **arguments: Of the batch.
    """

    def __init__(
        self, env_id: str, n: int, forces: tuple[float, float] = SLIP_LIMIT, **arguments: Any
    ) -> None:
        env = gym.make_vec(env_id, num_envs=n, **arguments).unwrapped
        assert isinstance(env, SlipVectorEnv)
        self.env, self.n, self.actions = env, n, action_bounds(env.config.gripper, forces)
        self._rng = np.random.default_rng(0)
        self.env.reset(seed=0)
        # spread the episodes' ends evenly over time, as they are after a while: their steps differ
        episode = self.env.simulation.episode
        episode["step"] = np.arange(n) * episode["steps"] // n

    def block(self, steps: int = BATCH_STEPS) -> tuple[float, int]:
        """Time of some vector steps [s], with the resets in them, and the environment steps."""
        turns = max(TURNS, steps // self.n)
        actions = self._rng.uniform(*self.actions, (turns, self.n, 1)).astype(np.float32)
        start = perf_counter()
        for action in actions:
            self.env.step(action)
        return perf_counter() - start, turns * self.n
