"""Measures the speed of the vector environment: near the slip limit, in a firm hold, and of its parts."""

from __future__ import annotations

from functools import partial
from statistics import median
from time import perf_counter, process_time
from typing import Any

import gymnasium as gym
import numpy as np

from slipgym._numba.compiled import unlocked
from slipgym._numba.rows import row_of
from slipgym.benchmarking.measure import Player
from slipgym.benchmarking.processors import on_either
from slipgym.benchmarking.report import Figure
from slipgym.benchmarking.timing import Comparison, compare, per_call
from slipgym.benchmarking.twins import Twins
from slipgym.config.hardware import GripperConfig
from slipgym.contact.coupled import step_pads
from slipgym.envs.actions import interpret
from slipgym.envs.observation import combine, observe
from slipgym.envs.threads import Threads
from slipgym.envs.vector_env import SlipVectorEnv
from slipgym.sensors.measure import measure
from slipgym.tasks.disturbance import disturb
from slipgym.tasks.episode import begin_step
from slipgym.world.planar_engine import step_world

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
    few = VectorPlayer(env_id, CACHED, threads=1)
    figures += parts(few)
    few.env.close()
    return figures


def parts(player: VectorPlayer, steps: int = 400) -> list[Figure]:
    """Time of the parts of a step, taken one after the other over all environments, in one thread."""
    env = player.env
    simulation, look = env.simulation, env._observer.buffers
    plant, n = simulation.plant, player.n
    bodies = plant.world, plant.pads, plant.cells, plant.fingers, plant.force_torque, plant.slip_sensors
    actions = np.random.default_rng(0).uniform(*player.actions, (steps, n, 1))
    time, counted = simulation.episode["step"].max() * simulation.step_time, 0

    def task(k: int) -> None:
        interpret(actions[k], env._actions.table, simulation.episode, simulation.commands)
        begin_step(simulation.episode, simulation.commands)
        disturb(simulation.episode, plant.world, plant.pads, simulation.ground_truth)
        simulation.task.script_wrist(simulation.episode, plant.world)

    def advance(_: int) -> None:
        nonlocal counted
        counted += _advance(*bodies, simulation.commands)

    def sense(_: int) -> None:
        measure(plant.world, plant.force_torque, plant.slip_sensors, simulation.wrenches, simulation.twists)

    def learn(k: int) -> None:
        simulation.estimator.update(time + (k + 1) * simulation.step_time, *rows)
        combine(simulation.estimator.estimates, simulation.per_finger, simulation.estimated)

    def evaluate(_: int) -> None:
        simulation.episode["step"] += 1
        simulation.task.evaluate_step(simulation.episode, plant.world, plant.fingers, simulation.task_part)

    def see(_: int) -> None:
        arrays = (
            simulation.wrenches,
            simulation.twists,
            plant.slip_sensors,
            simulation.episode,
            simulation.task_part,
            plant.world,
        )
        observe(*arrays, *look)

    rows = simulation.wrenches.reshape(-1, 4), simulation.twists.reshape(-1, 3)
    stages = [
        ("actions, plan", task),
        ("world, contact and force loop", advance),
        ("sensors", sense),
        ("estimators", learn),
        ("reward, success, drops", evaluate),
        ("observation", see),
    ]
    whole = min(player.block(20 * n)[0] / 20 for _ in range(5)) / n
    spent = dict.fromkeys((name for name, _ in stages), 0.0)
    _advance(*bodies, simulation.commands)
    for k in range(steps):
        for name, stage in stages:
            start = perf_counter()
            stage(k)
            spent[name] += perf_counter() - start
    spent = {name: seconds / (steps * n) for name, seconds in spent.items()}
    contact = per_call(partial(_contacts, *bodies[:4]), 20) / n
    floor = contact * counted / (steps * n)
    return [
        Figure("batch step, one thread, environments in the cache", 1e9 * whole, "ns"),
        *(Figure(f"batch step: {name}", 1e9 * seconds, "ns") for name, seconds in spent.items()),
        Figure("batch step: resets, infos, Gymnasium", 1e9 * (whole - sum(spent.values())), "ns"),
        Figure("sub-steps per step", counted / (steps * n), "-"),
        Figure("their contact kernel alone", 1e9 * floor, "ns"),
        Figure("batch step / its contact kernel", whole / floor, "-"),
    ]


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


@unlocked
def _advance(worlds, pads, cells, fingers, force_torque, slip_sensors, commands):
    """A control step of all worlds; sub-steps that it took."""
    done = 0
    for i in range(worlds.shape[0]):
        done += step_world(worlds, pads, cells, fingers, force_torque, slip_sensors, commands[i, 0], i)
    return done


@unlocked
def _contacts(worlds, pads, cells, fingers):
    """A contact step of all worlds, of the length that calm contacts have."""
    for i in range(worlds.shape[0]):
        world = worlds[i]
        h = world.calm_ticks * world.tick_length
        vx, vy, omega = world.relative_velocity
        motion = (h * vx, h * vy, h * omega)
        free = (motion[0], motion[1] - h * h * world.gravity, motion[2])
        pads[i, 0].normal = fingers[i, 0].force
        centre = (world.relative[0], world.relative[1])
        patch = row_of(cells, i)
        half = 0.5 * world.mass, 0.5 * world.inertia  # pads that are alike are solved as one
        step_pads((pads[i, 0],), patch, half, centre, free, motion, h)
