"""What the batch costs, beside the environment with PyBullet and its own parts."""

from __future__ import annotations

from functools import partial
from time import perf_counter
from typing import Any

import gymnasium as gym
import numpy as np

from slipgym.benchmarking.measure import ACTIONS, Player
from slipgym.benchmarking.report import Figure
from slipgym.benchmarking.timing import compare, per_call
from slipgym.compiled import unlocked
from slipgym.contact.coupled import step_pads
from slipgym.envs.observation import combine, observe
from slipgym.envs.vector import SlipVectorEnv
from slipgym.sensors.measure import measure
from slipgym.tasks.disturbance import disturb
from slipgym.world.alone import advance_alone

SIZES = 1, 16, 256, 4096
EVERY_ACTION = -1.0, 1.0
STEPS = 4000
"""Steps of all environments together in a timed block, at least one vector step."""


class VectorPlayer:
    """Plays a batch with random grip forces.

    Args:
        env_id: Id of the environment.
        n: Environments.
        actions: Between which actions; as `Player` plays one environment, or all there are.
        **arguments: Of the batch.
    """

    def __init__(self, env_id: str, n: int, actions: tuple[float, float] = ACTIONS, **arguments: Any) -> None:
        env = gym.make_vec(env_id, num_envs=n, **arguments).unwrapped
        assert isinstance(env, SlipVectorEnv)
        self.env, self.n, self._actions = env, n, actions
        self._rng = np.random.default_rng(0)
        self.env.reset(seed=0)

    def block(self, steps: int = STEPS) -> tuple[float, int]:
        """Time of some vector steps [s], with the resets in them, and the environment steps."""
        turns = max(1, steps // self.n)
        actions = self._rng.uniform(*self._actions, (turns, self.n, 1)).astype(np.float32)
        start = perf_counter()
        for action in actions:
            self.env.step(action)
        return perf_counter() - start, turns * self.n


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
    one, two = (VectorPlayer(env_id, SIZES[-1], EVERY_ACTION, threads=threads) for threads in (1, 2))
    block = 4 * SIZES[-1]
    result = compare(partial(two.block, block), partial(one.block, block), pairs)
    figures.append(Figure("batch of 4096: two threads / one", result.quartiles[1], "-", ">= 1.8"))
    figures += parts(one)
    slipping = VectorPlayer(env_id, SIZES[-1])
    seconds, steps = slipping.block(20 * SIZES[-1])
    figures.append(Figure("batch of 4096 about the slip limit: steps per second", steps / seconds, "1/s"))
    slipping.env.close()
    one.env.close()
    two.env.close()
    return figures


def parts(player: VectorPlayer, repeats: int = 9) -> list[Figure]:
    """Time of the parts of a step, each run over all environments as it stands, in one thread."""
    env = player.env
    loop, observer = env._loop, env._observer
    plant, n = loop.plant, player.n
    player.block(20 * n)  # away from the start
    seconds, _ = player.block(20 * n)
    whole = seconds / 20
    patches = plant.cells
    bodies = plant.world, plant.pads, patches, plant.fingers, plant.force_torque, plant.chips
    sensed = plant.world, plant.force_torque, plant.chips, loop.wrenches, loop.twists
    rows = loop.wrenches.reshape(-1, 4), loop.twists.reshape(-1, 3)
    time = 1e3  # later than any sample; every call a little later still

    def learn() -> None:
        nonlocal time
        time += loop.step_time
        loop.estimator.update(time, *rows)
        combine(loop.estimator.estimates, loop.per_finger, loop.estimated)

    def task() -> None:
        disturb(loop.episode, plant.world, plant.pads, loop.truth)
        loop.task.plan(loop.episode, plant.world)
        loop.task.judge(loop.episode, plant.world, plant.fingers, loop.task_part)

    def look() -> None:
        arrays = loop.wrenches, loop.twists, plant.chips, loop.episode, loop.task_part, plant.world
        observe(*arrays, *observer.sight)

    done = _contacts(plant.world, plant.pads, patches, plant.fingers)
    stages = {
        "contact kernel alone": partial(_contacts, plant.world, plant.pads, patches, plant.fingers),
        "world, contact and force loop": partial(_advance, *bodies),
        "sensors": partial(measure, *sensed),
        "estimators": learn,
        "task": task,
        "observation": look,
        "infos": partial(env._information.of, np.ones(n, dtype=bool)),
    }
    spent = {name: per_call(stage, 1, repeats) for name, stage in stages.items()}
    rest = whole - sum(seconds for name, seconds in spent.items() if name != "contact kernel alone")
    figures = [Figure(f"batch step: {name}", 1e9 * s / n, "ns") for name, s in spent.items()]
    return [
        Figure("batch step, one thread", 1e9 * whole / n, "ns"),
        *figures,
        Figure("batch step: resets, actions, copies, Gymnasium", 1e9 * rest / n, "ns"),
        Figure("sub-steps per step", done / n, "-"),
        Figure("batch step / its contact kernel", whole / spent["contact kernel alone"], "-"),
    ]


def _samples(player: Player) -> tuple[float, int]:
    seconds, steps = player.block()
    return seconds, steps // player.env.config.physics.engine_steps


@unlocked
def _advance(worlds, pads, cells, fingers, force_torque, chips):
    for i in range(worlds.shape[0]):
        patch = None if cells is None else cells[i]
        advance_alone(
            worlds[i],
            (pads[i, 0], pads[i, 1]),
            patch,
            (fingers[i, 0], fingers[i, 1]),
            (force_torque[i, 0], force_torque[i, 1]),
            (chips[i, 0], chips[i, 1]),
        )


@unlocked
def _contacts(worlds, pads, cells, fingers):
    """As many contact steps as a calm control step needs without samples and commands; how many that were."""
    done = 0
    for i in range(worlds.shape[0]):
        world = worlds[i]
        h = world.calm_ticks * world.tick_length
        weight = h * h * world.gravity
        vx, vy, omega = world.relative_velocity
        motion = (h * vx, h * vy, h * omega)
        for f in range(2):
            pads[i, f].normal = fingers[i, f].force
        held = pads[i, 0], pads[i, 1]
        for _ in range(-(-world.control_ticks // world.calm_ticks)):
            centre = (world.relative[0], world.relative[1])
            free = (motion[0], motion[1] - weight, motion[2])
            patch = None if cells is None else cells[i]
            motion = step_pads(held, patch, (world.mass, world.inertia), centre, free, motion, h)
            done += 1
    return done
