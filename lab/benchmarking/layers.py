"""Measures what each layer of an environment adds to the bare PyBullet loop.

The same motion is played with fewer and fewer layers: the whole environment, its simulation without what
Gymnasium asks for, its world alone. A motion is also replayed in the bare loop, with the loads of the first.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from statistics import quantiles
from time import process_time

import numpy as np

from lab.benchmarking.bare import BareLoop
from slipgym.benchmarking.report import Figure
from slipgym.envs.bullet_simulation import BulletSimulation
from slipgym.envs.slip_env import SlipEnv
from slipgym.world.scene import save_engine

_ACTIVE = np.ones(1, dtype=bool)


class Layers:
    """An environment that plays the same episode with all or only some of its layers.

    Args:
        env: The environment, with PyBullet; its action is the grip force.
        actions: Range of the random actions.
        steps: Control steps of an episode that are played.
    """

    def __init__(self, env: SlipEnv, actions: tuple[float, float], steps: int) -> None:
        assert isinstance(env.simulation, BulletSimulation)
        self._env, self._simulation = env, env.simulation
        self._actions = np.random.default_rng(0).uniform(*actions, (steps, 1)).astype(np.float32)
        self.loads: list[tuple] = []
        self.start = b""

    def environment(self) -> Callable[[], None]:
        """Reset; return a function that plays the episode with `env.step`."""
        self._env.reset(seed=0)
        return partial(self._play, self._env.step, self._actions)

    def simulation(self) -> Callable[[], None]:
        """Reset; return a function that plays it without Gymnasium's part: action check, info, copies."""
        self._env.reset(seed=0)
        env = self._env
        table, buffers = env._actions.table, env._observer.buffers
        batch = env._actions.checked(self._actions[0])

        def step(action: float) -> None:
            batch[0, 0] = action
            self._simulation.step(batch, table, 1, _ACTIVE, buffers)

        return partial(self._play, step, self._actions[:, 0].tolist())

    def world(self) -> Callable[[], None]:
        """Reset; return a function that moves the bodies with friction, and nothing else."""
        self._env.reset(seed=0)
        column, world = self._env.action_columns[0], self._simulation.world
        forces = column.low + 0.5 * (1.0 + self._actions[:, 0].astype(float)) * (column.high - column.low)

        def step(force: float) -> None:
            world.command(force)
            world.move()

        return partial(self._play, step, forces.tolist())

    def record(self) -> None:
        """Play the episode; keep `start`, the engine's state before it, and `loads` of its engine steps."""
        play, rows = self.environment(), self._simulation.world.rows
        self.loads, self.start = [], save_engine(self._simulation.world.client)
        original = rows.loads

        def keep(*arguments: object) -> tuple:
            self.loads.append(original(*arguments))
            return self.loads[-1]

        rows.loads = keep
        try:
            play()
        finally:
            rows.loads = original

    @staticmethod
    def _play(step: Callable[..., object], actions: Iterable[object]) -> None:
        for action in actions:
            step(action)


def layers(env: SlipEnv, actions: tuple[float, float], pairs: int, steps: int = 50) -> list[Figure]:
    """Ratios of the CPU time to the bare loop's, medians over rounds in which every loop has a block.

    Args:
        env: The environment, with PyBullet.
        actions: Range of the random actions.
        pairs: Rounds.
        steps: Control steps of a block.
    """
    bare, played = BareLoop(env.config), Layers(env, actions, steps)
    played.record()
    count = len(played.loads)

    def replay() -> Callable[[], None]:
        bare.load(played.start)
        return partial(bare.replay, played.loads)

    loops: dict[str, Callable[[], Callable[[], None]]] = {
        "": lambda: partial(bare.run, count),
        "bare loop with the loads of the environment": replay,
        "bodies and friction": played.world,
        "the same with sensors, estimator, task": played.simulation,
        "the same with Gymnasium's part": played.environment,
    }
    rounds: dict[str, list[float]] = {name: [] for name in loops}
    for _ in range(pairs + 3):
        for name, prepare in loops.items():
            run = prepare()
            start = process_time()
            run()
            rounds[name].append(process_time() - start)
    bare.close()
    reference, *others = (np.array(times[3:]) for times in rounds.values())
    names = [name for name in loops if name]
    return [
        Figure(f"{name} / bare loop", quantiles(times / reference, method="inclusive")[1], "-")
        for name, times in zip(names, others, strict=True)
    ]
