"""Measures the environment with PyBullet, its contact models and its start-up; one function each."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from functools import partial
from statistics import median
from time import perf_counter, process_time
from typing import Any

import gymnasium as gym
import numpy as np

from lab.benchmarking.bare import BareLoop
from lab.benchmarking.numpy_patch import NumpyPatch
from lab.benchmarking.stopwatches import Stopwatches, per_call
from lab.benchmarking.timing import compare
from slipgym.benchmarking.report import Figure
from slipgym.contact import DistributedContact, EllipsoidContact
from slipgym.envs import bullet_simulation as loops
from slipgym.envs.slip_env import SlipEnv
from slipgym.world.plant import Plant

BLOCK = 50  # control steps
ACTIONS = -0.97, -0.7  # 1 to 4.3 N; the default box needs 2 to 3 N, so that it slips a fifth of the time
SOFT_PADS = {
    "load_exponent": 0.2,
    "radius_exponent": 0.2,
    "cop_lever": 0.002,
    "shear_compliance": 5e-5,
    "creep": 0.3,
    "aging": 0.05,
    "anisotropy": 0.1,
}
"""Values of `contact.pad` that switch every effect on."""
FINGERS = {
    "contact": {"pad": SOFT_PADS, "finger_friction": [0.95, 1.05], "finger_radius": [0.95, 1.0]},
    "gripper": {"finger_lag": [0.9, 1.1], "force_gain": [0.98, 1.02]},
}
OPTIONS: dict[str, dict[str, Any]] = {
    "disc": {"contact": "disc"},
    "soft pads": {"config": {"contact": {"pad": SOFT_PADS}}},
    "physics.tilt": {"config": {"physics": {"tilt": True}}},
    "all of these and unlike fingers": {
        "contact": "disc",
        "config": {**FINGERS, "physics": {"tilt": True}},
    },
}
"""Options of the physics, each against the default."""
_FIRST_STEP = (
    "import gymnasium as gym; env = gym.make('slipgym:{env_id}'); env.reset(seed=0); "
    "env.step(env.action_space.sample())"
)
PARTS = (
    "Bullet and its calls",
    "kernel",
    "action, disturbances, wrist",
    "sensors, estimator, task, observation",
    "copies of the observation",
    "info",
)


class Player:
    """Plays one environment with random grip forces about the slip limit: the box sticks and slips."""

    def __init__(self, env_id: str, **arguments: Any) -> None:
        env = gym.make(env_id, **arguments).unwrapped
        assert isinstance(env, SlipEnv)
        self.env = env
        self._rng = np.random.default_rng(0)
        self._over = True

    def rest(self) -> Plant:
        """State of a newly gripped box."""
        self.env.reset(seed=0)
        return self.env.simulation.plant

    def begin(self) -> None:
        """Start an episode if the last one is over."""
        if self._over:
            self.env.reset(seed=int(self._rng.integers(2**31)))
            self._over = False

    def block(self, clock: Callable[[], float] = perf_counter) -> tuple[float, int]:
        """Time of some control steps [s] by a clock and the engine steps in them; resets are not timed."""
        self.begin()
        actions = self._rng.uniform(*ACTIONS, (BLOCK, 1)).astype(np.float32)
        step, steps = self.env.step, 0
        start = clock()
        for action in actions:
            _, _, terminated, truncated, _ = step(action)
            steps += 1
            if terminated or truncated:
                self._over = True
                break
        return clock() - start, steps * self.env.config.physics.engine_steps


def against_bare(player: Player, pairs: int) -> list[Figure]:
    """The whole environment against the bare loop of the same scene, in the same run: CPU time."""
    config = player.env.config
    bare = BareLoop(config)
    steps = BLOCK * config.physics.engine_steps

    def block() -> tuple[float, int]:
        start = process_time()
        bare.run(steps)
        return process_time() - start, steps

    own = partial(player.block, process_time)
    compare(block, own, 10)  # warm up
    result = compare(block, own, pairs)
    bare.close()
    lower, middle, upper = result.quartiles
    real_time = 1.0 / (config.physics.engine_rate * result.second)
    return [
        Figure("bare Bullet loop, per engine step", 1e6 * result.first, "us"),
        Figure("environment, per engine step", 1e6 * result.second, "us"),
        Figure("environment / bare loop", middle, "-", "<= 1.3"),
        Figure("environment / bare loop, lower quartile", lower, "-"),
        Figure("environment / bare loop, upper quartile", upper, "-"),
        Figure("real-time factor of env.step", real_time, "-", ">= 40"),
    ]


def breakdown(player: Player, blocks: int) -> list[Figure]:
    """CPU time of the parts of one env.step, by stopwatches around them."""
    env = player.env
    simulation = env.simulation
    assert isinstance(simulation, loops.BulletSimulation)
    player.block()  # the first step finds the calls that are watched
    rows: list[list[float]] = []
    with Stopwatches(clock=process_time) as watches:
        watches.watch("kernel", simulation.world.rows, "loads")
        watches.watch("Bullet and its calls", simulation.world, "move")
        watches.watch("action, disturbances, wrist", simulation._calls, "begin")
        watches.watch("sensors, estimator, task, observation", simulation._calls, "finish")
        watches.watch("copies of the observation", env._observer, "first")
        watches.watch("info", env, "_report")
        for _ in range(blocks):
            watches.running = False
            player.begin()
            watches.spent.update(dict.fromkeys(PARTS, 0.0))
            watches.running = True
            seconds, steps = player.block(process_time)
            parts = [watches.spent[label] for label in PARTS]
            samples = steps / env.config.physics.engine_steps
            rows.append([part / samples for part in (*parts, seconds - sum(parts))])
    times = (median(column) for column in zip(*rows, strict=True))
    return [
        Figure(f"env.step: {label}", 1e6 * time, "us")
        for label, time in zip((*PARTS, "checks, watches"), times, strict=True)
    ]


def life(env_id: str, repeats: int) -> list[Figure]:
    """Import, make, reset, picture."""
    fresh = max(3, repeats // 5)
    imports = [_in_new_process("import slipgym") for _ in range(fresh)]
    starts = [_in_new_process(_FIRST_STEP.format(env_id=env_id)) for _ in range(fresh)]
    env = gym.make(env_id, render_mode="rgb_array").unwrapped
    env.reset(seed=0)
    env.render()
    makes = []
    for _ in range(repeats):
        start = perf_counter()
        other = gym.make(env_id)
        makes.append(perf_counter() - start)
        other.close()
    figures = [
        Figure("import slipgym", median(imports), "s", "<= 1"),
        Figure("new process to the end of the first step", median(starts), "s"),
        Figure("gym.make", 1e3 * median(makes), "ms"),
        Figure("env.reset", 1e3 * per_call(env.reset, 3, repeats), "ms"),
        Figure("env.render", 1e3 * per_call(env.render, 3, repeats), "ms"),
    ]
    env.close()
    return figures


def distributed(player: Player, env_id: str, pairs: int) -> list[Figure]:
    """The environment with distributed contact against the same with ellipsoids, in the same run."""
    figures = []
    for cells in (11, 21):
        other = Player(env_id, contact="distributed", config={"contact": {"cells": cells}})
        compare(player.block, other.block, 3)  # warm up
        result = compare(player.block, other.block, pairs)
        other.env.close()
        name = f"environment, {cells} x {cells} cells"
        figures.append(Figure(f"{name}, per engine step", 1e6 * result.second, "us"))
        figures.append(Figure(f"{name} / ellipsoid", result.quartiles[1], "-"))
    return figures


def options(player: Player, env_id: str, pairs: int) -> list[Figure]:
    """The environment with options of the physics against the same without, and against the bare loop."""
    figures = []
    for name, arguments in OPTIONS.items():
        other = Player(env_id, **arguments)
        compare(player.block, other.block, 3)  # warm up
        result = compare(player.block, other.block, pairs)
        bare = {figure.name: figure for figure in against_bare(other, pairs)}["environment / bare loop"]
        other.env.close()
        figures += [
            Figure(f"environment, {name}, per engine step", 1e6 * result.second, "us"),
            Figure(f"environment, {name} / without", result.quartiles[1], "-"),
            Figure(f"environment, {name} / bare loop", bare.value, "-"),
        ]
    return figures


def contact(calls: int = 2000) -> list[Figure]:
    """One step of the contact object, called from Python."""
    twist, figures = (0.003, -0.02, 0.5), []
    for pad, required in ((EllipsoidContact(), ""), (DistributedContact(), "<= 25")):
        pad.step(twist, 10.0, 1e-3)
        seconds = per_call(partial(pad.step, twist, 10.0, 1e-3), calls)
        figures.append(Figure(f"{type(pad).__name__}.step", 1e6 * seconds, "us", required))
    return figures


def patch(pairs: int, steps: int = 500) -> list[Figure]:
    """The distributed contact's cells, and the same in plain numpy, in the same run.

    Numpy makes a twentieth of the steps: its blocks last as long, and are interrupted as seldom.
    """
    twist = (0.003, -0.02, 0.5)
    whole, single = DistributedContact(), DistributedContact(cells=1)
    plain = NumpyPatch(whole.positions, whole.shares)

    def block(pad: DistributedContact | NumpyPatch) -> tuple[float, int]:
        count = steps if isinstance(pad, DistributedContact) else steps // 20
        start = perf_counter()
        for _ in range(count):
            pad.step(twist, 10.0, 1e-3)
        return perf_counter() - start, count

    compare(partial(block, single), partial(block, plain), 3)  # warm up
    cells = compare(partial(block, single), partial(block, whole), pairs)
    against = compare(partial(block, whole), partial(block, plain), pairs)
    return [
        Figure("DistributedContact.step, its cells alone", 1e6 * (cells.second - cells.first), "us"),
        Figure("patch in numpy, per step", 1e6 * against.second, "us"),
        Figure("patch in numpy / DistributedContact.step", against.quartiles[1], "-", ">= 20"),
        Figure("patch in numpy / its cells alone", against.second / (cells.second - cells.first), "-"),
    ]


def _in_new_process(statement: str) -> float:
    """Time of a statement in an interpreter of its own [s]."""
    code = f"from time import perf_counter as now; start = now(); {statement}; print(now() - start)"
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    return float(done.stdout)
