"""Measures the speed of the vector environment: near the slip limit, in a firm hold, and of its parts."""

from __future__ import annotations

from functools import partial
from statistics import median
from time import perf_counter, process_time
from typing import Any

import gymnasium as gym
import numpy as np

from slipgym.benchmarking.measure import Player
from slipgym.benchmarking.processors import on_either
from slipgym.benchmarking.report import Figure
from slipgym.benchmarking.split import parts
from slipgym.benchmarking.timing import Comparison, compare
from slipgym.benchmarking.twins import Twins
from slipgym.config.hardware import GripperConfig
from slipgym.envs.threads import Threads
from slipgym.envs.vector_env import SlipVectorEnv

SIZES = 1, 16, 256, 4096
SLIP_LIMIT = 1.0, 4.0
"""Commanded forces of the headline workload, about the slip limit [N]."""
EVERY_FORCE = 0.0, 100.0
"""All forces that the gripper can be commanded: mostly a firm hold [N]."""
WORKLOADS = {"about the slip limit": SLIP_LIMIT, "all forces, mostly a firm hold": EVERY_FORCE}
STEPS = 4000
"""Steps of all environments together in a timed block, at least `TURNS` vector steps."""
TURNS = 16
CACHED = 256
"""Environments that fit into a processor's own cache: their parts are timed apart from the memory's."""


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
        self._scatter()

    def block(self, steps: int = STEPS) -> tuple[float, int]:
        """Time of some vector steps [s], with the resets in them, and the environment steps."""
        turns = max(TURNS, steps // self.n)
        actions = self._rng.uniform(*self.actions, (turns, self.n, 1)).astype(np.float32)
        start = perf_counter()
        for action in actions:
            self.env.step(action)
        return perf_counter() - start, turns * self.n

    def shared_block(self, threads: Threads, steps: int) -> tuple[float, int]:
        """A block by other threads, in the same memory: where that lies changes its speed."""
        self.env.simulation._threads = threads
        return self.block(steps)

    def slipping(self, turns: int = 120) -> float:
        """Fraction of environments whose pads slip at the end of a step, mean over some steps [-]."""
        count = 0
        for _ in range(turns):
            self.env.step(self._rng.uniform(*self.actions, (self.n, 1)).astype(np.float32))
            count += np.count_nonzero(self.env.simulation.plant.pads["slip_rate"][:, 0])
        return count / (turns * self.n)

    def _scatter(self) -> None:
        """Spread the episodes' ends evenly over time, as they are after a while: their steps differ."""
        episode = self.env.simulation.episode
        episode["step"] = np.arange(self.n) * episode["steps"] // self.n


def headline(env_id: str, repeats: int = 7) -> list[Figure]:
    """Steps per second of the largest batch about the slip limit, and beside it in a firm hold.

    Also per second of CPU time in one thread, which other work on the machine disturbs less.
    """
    figures, n = [], SIZES[-1]
    players = {name: VectorPlayer(env_id, n, forces) for name, forces in WORKLOADS.items()}
    single = {name: VectorPlayer(env_id, n, forces, threads=1) for name, forces in WORKLOADS.items()}
    for player in (*players.values(), *single.values()):
        player.block(20 * n)  # warm up
    rates: dict[str, list[float]] = {name: [] for name in WORKLOADS}
    for _ in range(repeats):
        for name, player in players.items():
            seconds, steps = player.block(16 * n)
            rates[name].append(steps / seconds)
    per_cpu: dict[str, list[float]] = {name: [] for name in WORKLOADS}
    for _ in range(repeats):
        for name, player in single.items():
            start = process_time()
            _, steps = player.block(16 * n)
            per_cpu[name].append(steps / (process_time() - start))
    for name in WORKLOADS:
        title = f"batch of {n}, {name}"
        figures += [
            Figure(f"{title}: steps per second", median(rates[name]), "1/s"),
            Figure(f"{title}: the same, one thread, per second of CPU time", median(per_cpu[name]), "1/s"),
            Figure(f"{title}: slipping rows", players[name].slipping(), "-"),
        ]
    for player in (*players.values(), *single.values()):
        player.env.close()
    return figures


def batch(player: Player, env_id: str, pairs: int) -> list[Figure]:
    """The headline, steps per second at several sizes against PyBullet in the same run, scaling, parts."""
    figures = headline(env_id)
    for n in SIZES:
        many = VectorPlayer(env_id, n)
        compare(partial(_samples, player), many.block, 2)  # warm up
        result = compare(partial(_samples, player), many.block, pairs)
        figures.append(Figure(f"batch of {n}: steps per second", 1.0 / result.second, "1/s"))
        ratio = 1.0 / result.quartiles[1]
        figures.append(Figure(f"batch of {n} / environment with PyBullet", ratio, "-"))
        many.env.close()
    many, block = VectorPlayer(env_id, SIZES[-1]), 4 * SIZES[-1]
    crews = Threads(SIZES[-1], 2), Threads(SIZES[-1], 1)
    two, one = (partial(many.shared_block, crew, block) for crew in crews)
    result, anywhere = compare(two, partial(on_either, one), pairs), compare(two, one, pairs)
    for crew in crews:
        crew.close()
    many.env.close()
    figures += _scaling("batch of 4096: two threads / one", result, ">= 1.8")
    figures.append(Figure("the same, one where the system puts it", anywhere.quartiles[1], "-"))
    with Twins(_single, env_id) as twins:
        compare(partial(twins.both, block), partial(twins.alone, block), 2)
        result = compare(partial(twins.both, block), partial(twins.alone, block), pairs)
    figures += _scaling("the same: two processes / one", result)
    return figures + _split(env_id, pairs)


def headline_and_parts(env_id: str, pairs: int) -> list[Figure]:
    """The headline, and how the time of a step divides among its stages.

    Args:
        env_id: Id of the environment.
        pairs: Pairs of blocks of the parts.
    """
    return headline(env_id) + _split(env_id, pairs)


def _split(env_id: str, pairs: int) -> list[Figure]:
    """`slipgym.benchmarking.split.parts` of a vector environment that fits into the cache."""
    player = VectorPlayer(env_id, CACHED, threads=1)
    figures = parts(player, pairs)
    player.env.close()
    return figures


def _scaling(name: str, result: Comparison, required: str = "") -> list[Figure]:
    lower, middle, upper = result.quartiles
    return [
        Figure(name, middle, "-", required),
        Figure(f"{name}, lower quartile", lower, "-"),
        Figure(f"{name}, upper quartile", upper, "-"),
    ]


def _single(env_id: str) -> VectorPlayer:
    return VectorPlayer(env_id, SIZES[-1], threads=1)


def _samples(player: Player) -> tuple[float, int]:
    seconds, steps = player.block()
    return seconds, steps // player.env.config.physics.engine_steps
