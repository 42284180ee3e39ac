"""Measures the speed of the vector environment: near the slip limit, in a firm hold, and of its parts."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from statistics import median
from time import process_time

import numpy as np

from lab.benchmarking.measure import Player
from lab.benchmarking.processors import on_either
from lab.benchmarking.split import COMPILED, RESETS, parts, watched
from lab.benchmarking.timing import Comparison, compare
from lab.benchmarking.twins import Twins
from slipgym.benchmarking.report import Figure
from slipgym.benchmarking.run import SLIP_LIMIT, VectorPlayer
from slipgym.threads import Threads

SIZES = 1, 16, 256, 4096
EVERY_FORCE = 0.0, 100.0
"""All forces that the gripper can be commanded: mostly a firm hold [N]."""
WORKLOADS = {"about the slip limit": SLIP_LIMIT, "all forces, mostly a firm hold": EVERY_FORCE}
REQUIRED = dict(zip(WORKLOADS, (">= 700000", ""), strict=True))
CACHED = 256
"""Environments that fit into a processor's own cache: their parts are timed apart from the memory's."""


def slipping(player: VectorPlayer, turns: int = 120) -> float:
    """Fraction of environments whose pads slip at the end of a step, mean over some steps [-]."""
    rng, count = np.random.default_rng(0), 0
    for _ in range(turns):
        player.env.step(rng.uniform(*player.actions, (player.n, 1)).astype(np.float32))
        count += np.count_nonzero(player.env.simulation.plant.pads["slip_rate"][:, 0])
    return count / (turns * player.n)


def headline(env_id: str, repeats: int = 7, estimator: str = "") -> list[Figure]:
    """Steps per second of the largest batch about the slip limit, and beside it in a firm hold.

    Also per second of CPU time in one thread, which other work on the machine disturbs less.

    Args:
        env_id: Id of the environment.
        repeats: Blocks of each workload.
        estimator: Name of the estimator; empty: the default.
    """
    figures, n = [], SIZES[-1]
    more, ending = ({"estimator": estimator}, f', "{estimator}"') if estimator else ({}, "")
    players = {name: VectorPlayer(env_id, n, forces, **more) for name, forces in WORKLOADS.items()}
    single = {name: VectorPlayer(env_id, n, forces, threads=1, **more) for name, forces in WORKLOADS.items()}
    for player in (*players.values(), *single.values()):
        player.block(20 * n)  # warm up
    rates: dict[str, list[float]] = {name: [] for name in WORKLOADS}
    for _ in range(repeats):
        for name, player in players.items():
            seconds, steps = player.block(16 * n)
            rates[name].append(steps / seconds)
    per_cpu: dict[str, list[float]] = {name: [] for name in WORKLOADS}
    compiled: dict[str, list[float]] = {name: [] for name in WORKLOADS}
    resets: dict[str, list[float]] = {name: [] for name in WORKLOADS}
    for _ in range(repeats):
        for name, player in single.items():
            with watched(player) as watches:
                start = process_time()
                _, steps = player.block(16 * n)
                per_cpu[name].append(steps / (process_time() - start))
            compiled[name].append(watches.spent[COMPILED] / steps)
            resets[name].append(watches.spent[RESETS] / steps)
    for name in WORKLOADS:
        title = f"batch of {n}, {name}{ending}"
        figures += [
            Figure(f"{title}: steps per second", median(rates[name]), "1/s", REQUIRED[name]),
            Figure(f"{title}: the same, one thread, per second of CPU time", median(per_cpu[name]), "1/s"),
            Figure(f"{title}: the compiled step, one thread, CPU time", 1e9 * median(compiled[name]), "ns"),
            Figure(f"{title}: resets, one thread, CPU time", 1e9 * median(resets[name]), "ns"),
            Figure(f"{title}: slipping rows", slipping(players[name]), "-"),
        ]
    about, firm = WORKLOADS
    pace, required = median(rates[about]) / median(rates[firm]), ">= 0.6"
    own = median(a / b for a, b in zip(per_cpu[about], per_cpu[firm], strict=True))
    figures += [
        Figure(
            f"batch of {n}{ending}: about the slip limit / firm hold, steps per second", pace, "-", required
        ),
        Figure(f"batch of {n}{ending}: the same, one thread, per second of CPU time", own, "-"),
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
    two, one = (partial(_shared_block, many, crew, block) for crew in crews)
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


def headline_and_parts(env_id: str, pairs: int, estimators: Sequence[str] = ()) -> list[Figure]:
    """The headline, and how the time of a step divides among its stages.

    Args:
        env_id: Id of the environment.
        pairs: Pairs of blocks of the parts.
        estimators: Further estimators, of which only the headline is measured.
    """
    others = (headline(env_id, estimator=name) for name in estimators)
    return [*headline(env_id), *(figure for figures in others for figure in figures), *_split(env_id, pairs)]


def _split(env_id: str, pairs: int) -> list[Figure]:
    """`lab.benchmarking.split.parts` of a vector environment that fits into the cache."""
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


def _shared_block(player: VectorPlayer, threads: Threads, steps: int) -> tuple[float, int]:
    """A block by other threads, in the same memory: where that lies changes its speed."""
    player.env.simulation._threads = threads
    return player.block(steps)
