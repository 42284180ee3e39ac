"""What the batch costs, beside the environment with PyBullet and its own parts."""

from __future__ import annotations

from functools import partial
from time import perf_counter
from typing import Any

import gymnasium as gym
import numpy as np

from slipgym._numba.compiled import unlocked
from slipgym.benchmarking.measure import ACTIONS, Player
from slipgym.benchmarking.processors import on_either
from slipgym.benchmarking.report import Figure
from slipgym.benchmarking.timing import Comparison, compare, per_call
from slipgym.benchmarking.twins import Twins
from slipgym.contact.coupled import step_pads
from slipgym.envs.actions import interpret
from slipgym.envs.observation import combine, observe
from slipgym.envs.threads import Threads
from slipgym.envs.vector_env import SlipVectorEnv
from slipgym.sensors.measure import measure
from slipgym.tasks.disturbance import disturb
from slipgym.tasks.episode import begin_step
from slipgym.world.planar_engine import move

SIZES = 1, 16, 256, 4096
EVERY_ACTION = -1.0, 1.0
STEPS = 4000
"""Steps of all environments together in a timed block, at least `TURNS` vector steps."""
TURNS = 16
CACHED = 256
"""Environments that fit into a processor's own cache: their parts are timed apart from the memory's."""


class VectorPlayer:
    """Plays a batch with random grip forces, asking for infos where episodes end, as a learner does.

    Args:
        env_id: Id of the environment.
        n: Environments.
        actions: Between which actions; as `Player` plays one environment, or all there are.
        **arguments: Of the batch.
    """

    def __init__(self, env_id: str, n: int, actions: tuple[float, float] = ACTIONS, **arguments: Any) -> None:
        env = gym.make_vec(env_id, num_envs=n, infos="ends", **arguments).unwrapped
        assert isinstance(env, SlipVectorEnv)
        self.env, self.n, self._actions = env, n, actions
        self._rng = np.random.default_rng(0)
        self.env.reset(seed=0)
        self._scatter()

    def block(self, steps: int = STEPS) -> tuple[float, int]:
        """Time of some vector steps [s], with the resets in them, and the environment steps."""
        turns = max(TURNS, steps // self.n)
        actions = self._rng.uniform(*self._actions, (turns, self.n, 1)).astype(np.float32)
        start = perf_counter()
        for action in actions:
            self.env.step(action)
        return perf_counter() - start, turns * self.n

    def shared_block(self, threads: Threads, steps: int) -> tuple[float, int]:
        """A block by other threads, in the same memory: where that lies changes its speed."""
        self.env.simulation._threads = threads
        return self.block(steps)

    def _scatter(self) -> None:
        """Spread the episodes' ends evenly over time, as they are after a while: their steps differ."""
        episode = self.env.simulation.episode
        episode["step"] = np.arange(self.n) * episode["steps"] // self.n


def batch(player: Player, env_id: str, pairs: int) -> list[Figure]:
    """Steps per second at several sizes, against PyBullet in the same run, and from one thread to two."""
    figures = []
    for n in SIZES:
        many = VectorPlayer(env_id, n, EVERY_ACTION)
        compare(partial(_samples, player), many.block, 2)  # warm up
        result = compare(partial(_samples, player), many.block, pairs)
        most = n == SIZES[-1]
        figures.append(
            Figure(f"batch of {n}: steps per second", 1.0 / result.second, "1/s", ">= 1e6" if most else "")
        )
        ratio = 1.0 / result.quartiles[1]
        figures.append(
            Figure(f"batch of {n} / environment with PyBullet", ratio, "-", ">= 200" if most else "")
        )
        many.env.close()
    many, block = VectorPlayer(env_id, SIZES[-1], EVERY_ACTION), 4 * SIZES[-1]
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
    few = VectorPlayer(env_id, CACHED, EVERY_ACTION, threads=1)
    figures += parts(few)
    few.env.close()
    slipping = VectorPlayer(env_id, SIZES[-1])
    seconds, steps = slipping.block(20 * SIZES[-1])
    figures.append(Figure("batch of 4096 about the slip limit: steps per second", steps / seconds, "1/s"))
    slipping.env.close()
    return figures


def parts(player: VectorPlayer, steps: int = 400) -> list[Figure]:
    """Time of the parts of a step, taken one after the other over all environments, in one thread."""
    env = player.env
    simulation, look = env.simulation, env._observer.sight
    plant, n = simulation.plant, player.n
    bodies = plant.world, plant.pads, plant.cells, plant.fingers, plant.force_torque, plant.slip_sensors
    actions = np.random.default_rng(0).uniform(*EVERY_ACTION, (steps, n, 1))
    time, counted = simulation.episode["step"].max() * simulation.step_time, 0

    def task(k: int) -> None:
        interpret(actions[k], env._actions.table, simulation.episode, simulation.commands)
        begin_step(simulation.episode, simulation.commands)
        disturb(simulation.episode, plant.world, plant.pads, simulation.truth)
        simulation.task.script_wrist(simulation.episode, plant.world)

    def advance(_: int) -> None:
        nonlocal counted
        counted += _advance(*bodies, simulation.commands)

    def sense(_: int) -> None:
        measure(plant.world, plant.force_torque, plant.slip_sensors, simulation.wrenches, simulation.twists)

    def learn(k: int) -> None:
        simulation.estimator.update(time + (k + 1) * simulation.step_time, *rows)
        combine(simulation.estimator.estimates, simulation.per_finger, simulation.estimated)

    def judge(_: int) -> None:
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
        ("reward, success, drops", judge),
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
    return VectorPlayer(env_id, SIZES[-1], EVERY_ACTION, threads=1)


def _samples(player: Player) -> tuple[float, int]:
    seconds, steps = player.block()
    return seconds, steps // player.env.config.physics.engine_steps


@unlocked
def _advance(worlds, pads, cells, fingers, force_torque, slip_sensors, commands):
    """A control step of all worlds; sub-steps that it took."""
    done = 0
    for i in range(worlds.shape[0]):
        done += move(worlds, pads, cells, fingers, force_torque, slip_sensors, commands[i, 0], i)
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
        patch = None if cells is None else cells[i]
        half = 0.5 * world.mass, 0.5 * world.inertia  # pads that are alike are solved as one
        step_pads((pads[i, 0],), patch, half, centre, free, motion, h)
