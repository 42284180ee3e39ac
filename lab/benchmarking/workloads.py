"""Speed of a batch under the workloads that it is used for: slipgym benchmark-parts workloads.

What acts is not timed: the figures are those of the environments' step, per second of CPU time in one thread.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from statistics import median
from time import process_time
from typing import Any

import gymnasium as gym
import numpy as np

import policies
from lab.benchmarking.batch import EVERY_FORCE
from slipgym.benchmarking import report
from slipgym.benchmarking.report import Figure
from slipgym.benchmarking.run import SLIP_LIMIT, action_bounds
from slipgym.registration import TASK_MODULES
from slipgym.tasks import find

SIZE = 1024
"""Environments."""
BLOCKS, STEPS = 5, 40
"""Timed blocks of a workload, and steps of all environments in one."""

RANDOM = {"held firmly": (15.0, 25.0), "about the slip limit": SLIP_LIMIT, "all forces": EVERY_FORCE}
"""Bounds of the random forces of a workload [N]."""

Act = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""Actions for observations, and for which rows begin an episode."""


def benchmark(env_id: str, pairs: int, json: Path | None = None) -> None:
    """Measure and print all tasks.

    Args:
        env_id: Id of the environment whose workloads come first.
        pairs: A twentieth as many blocks of each workload, at least `BLOCKS`.
        json: File to write the figures to.
    """
    print(report.line(report.machine()))
    ids = [env_id, *(other for other in TASK_MODULES if other != env_id)]
    figures = [figure for one in ids for figure in workloads(one, max(BLOCKS, pairs // 20))]
    report.publish(figures, json)


def workloads(env_id: str, blocks: int = BLOCKS, size: int = SIZE, steps: int = STEPS) -> list[Figure]:
    """Steps per second of CPU time and the share of slipping rows, for each workload of a task.

    Args:
        env_id: Id of the environment.
        blocks: Timed blocks of each workload; the median counts.
        size: Environments.
        steps: Steps of all environments in a block.
    """
    figures = []
    for name, act, arguments in _players(env_id, size):
        env: Any = gym.make_vec(env_id, num_envs=size, threads=1, **arguments).unwrapped
        seconds, slipping = _blocks(env, act, blocks, steps)
        env.close()
        skip = arguments.get("frame_skip", 1)
        title = f"{find(env_id).name}, {name}"
        figures += [
            Figure(f"{title}: control steps per second", skip * size * steps / seconds, "1/s"),
            Figure(f"{title}: slipping rows", slipping, "-"),
        ]
    return figures


def _players(env_id: str, size: int) -> Iterator[tuple[str, Act, dict[str, Any]]]:
    """Name, actions for observations, and arguments of the environments of each workload."""
    task = find(env_id)
    for name, forces in RANDOM.items():
        yield name, _random(env_id, forces, size), {}
    kinds = {task.key: "controller", f"{task.key}_scratch": "learned policy"}
    for name in sorted(kinds.keys() & {*policies.names()}):  # not every task has a learned policy
        policy = policies.make(name)
        yield f"{kinds[name]} {name}", _Acting(policy), policies.modes(policy)


def _random(env_id: str, forces: tuple[float, float], size: int) -> Act:
    """Random forces within bounds [N]; the wrist, where an action can move it, stays."""
    env: Any = gym.make(env_id, engine="planar").unwrapped
    width, bounds = env.action_space.shape[0], action_bounds(env.config.gripper, forces)
    env.close()
    rng = np.random.default_rng(0)

    def act(_: np.ndarray, __: np.ndarray) -> np.ndarray:
        actions = np.zeros((size, width))
        actions[:, 0] = rng.uniform(*bounds, size)
        return actions.astype(np.float32)

    return act


class _Acting:
    """A policy with its memory."""

    def __init__(self, policy: policies.Policy) -> None:
        self._policy, self._state = policy, None

    def __call__(self, observations: np.ndarray, begun: np.ndarray) -> np.ndarray:
        actions, self._state = self._policy.predict(observations, self._state, begun)
        return actions


def _blocks(env: Any, act: Act, blocks: int, steps: int) -> tuple[float, float]:
    """Median CPU time of a block [s], and the mean share of rows that slip at the end of a step [-]."""
    observations, _ = env.reset(seed=0)
    episode = env.simulation.episode
    begun, over = np.ones(len(episode), bool), np.zeros(len(episode), bool)
    times, slipping = [], 0
    for block in range(blocks + 1):
        spent = 0.0
        for _ in range(steps):
            actions = act(observations, begun)
            start = process_time()
            observations, _, terminated, truncated, _ = env.step(actions)
            spent += process_time() - start
            begun, over = over, terminated | truncated  # the step after an episode's end resets
            if block > 0:
                slipping += np.count_nonzero(env.simulation.plant.pads["slip_rate"][:, 0])
        if block > 0:  # the first warms up
            times.append(spent)
    return median(times), slipping / (blocks * steps * len(episode))
