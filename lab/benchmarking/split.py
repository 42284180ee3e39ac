"""Splits the time of a step of the vector environment among its stages.

The stages are the programs of the step itself, called one after the other for all environments. What else the
machine does changes their speed, so every figure is CPU time, and a median over pairs of short blocks: some
steps of the environment, then as many stage by stage from where these have ended. Few episodes end in so few
steps, so the contacts of both are alike.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from statistics import median, quantiles
from time import process_time

import numpy as np

from lab.benchmarking.stopwatches import Stopwatches
from slipgym._numba.compiled import unlocked
from slipgym._numba.rows import row_of
from slipgym.benchmarking.report import Figure
from slipgym.benchmarking.run import VectorPlayer
from slipgym.contact.coupled import step_pads
from slipgym.world.planar_engine import step_world

STEPS = 16
"""Steps of all environments in a block."""
WORLD = "world, contact and force loop"
STAGES = {
    "actions, plan": "begin",
    WORLD: "",
    "sensors": "measure",
    "estimators": "estimate",
    "reward, success, drops": "evaluate",
    "observation": "look",
    "infos": "report",
}
"""Part of a step -> its program in `slipgym.envs.stages.Stages.calls`; that of the world counts sub-steps."""
BETWEEN = "prefetching, checks, calls of the stages"
RESETS = "resets"
REST = "Gymnasium"
COMPILED = "all of these, the compiled step"
FLOOR = "their contact kernel alone"
REGIMES = "stick", "stick near break-away", "slide", "slip begins or ends"
"""What a contact does in a step. Near break-away it takes more sub-steps than an object that rests needs."""


def watched(player: VectorPlayer) -> Stopwatches:
    """Stopwatches of CPU time for the compiled step (`COMPILED`) and the resets (`RESETS`) of a player."""
    watches = Stopwatches(process_time)
    watches.watch(COMPILED, player.env.simulation, "_drive")
    watches.watch(RESETS, player.env.simulation, "reset_rows")
    return watches


class Split:
    """Steps a vector environment stage by stage.

    Args:
        player: Plays the environment in one thread.

    Attributes:
        tally: Steps and sub-steps of each of `REGIMES` since the start, (4, 2).
    """

    def __init__(self, player: VectorPlayer) -> None:
        self._player, self._rng = player, np.random.default_rng(0)
        simulation, n = player.env.simulation, player.n
        stages, state, rows = simulation.stages, simulation.state, (0, n)
        linked, calls = stages.linked, stages.calls
        self.tally = np.zeros((len(REGIMES), 2))
        self._action = np.empty((n, 1)), player.env._actions.table, np.ones(n, dtype=bool)
        sensors, buffers, infos = (
            simulation.plant.force_torque,
            player.env._observer.buffers,
            simulation.infos,
        )
        self._run: dict[str, Callable[[], None]] = {
            "begin": partial(calls["begin"], linked.script_wrist, state, self._action, *rows),
            "": self._advance,
            "measure": partial(calls["measure"], state, simulation.plant.cells, sensors, *rows),
            "estimate": partial(calls["estimate"], linked.update, state, *rows),
            "evaluate": partial(calls["evaluate"], linked.evaluate_step, state, *rows),
            "look": partial(calls["look"], state, buffers, *rows),
            "report": partial(calls["report"], state, infos.numbers, infos.flags, *rows),
        }

    def pair(self) -> dict[str, float]:
        """CPU time of a step and of its parts, per environment [s], and the number of its sub-steps."""
        n, player = self._player.n, self._player
        with watched(player) as watches:
            start = process_time()
            _, steps = player.block(STEPS * n)
            whole, before = (process_time() - start) / steps, self.tally[:, 1].sum()
        compiled, resets = (watches.spent[label] / steps for label in (COMPILED, RESETS))
        spent = dict.fromkeys(STAGES, 0.0)
        for _ in range(STEPS):
            self._action[0][:] = self._rng.uniform(*player.actions, (n, 1))
            for part, program in STAGES.items():
                start = process_time()
                self._run[program]()
                spent[part] += (process_time() - start) / (STEPS * n)
        substeps = (self.tally[:, 1].sum() - before) / (STEPS * n)
        floor = substeps * self._contact_step()
        rest = {BETWEEN: compiled - sum(spent.values()), RESETS: resets, REST: whole - compiled - resets}
        return {"": whole, **spent, **rest, COMPILED: compiled, "sub-steps": substeps, FLOOR: floor}

    def _advance(self) -> None:
        simulation = self._player.env.simulation
        plant = simulation.plant
        bodies = plant.world, plant.pads, plant.cells, plant.fingers, plant.force_torque, plant.slip_sensors
        _advance(*bodies, simulation.commands, self.tally)

    def _contact_step(self, repeats: int = 4) -> float:
        """CPU time of a contact step of an environment [s], the median of some; the state stays as it is."""
        plant, times = self._player.env.simulation.plant, []
        for _ in range(repeats):
            cells = None if plant.cells is None else plant.cells.copy()
            pads = plant.pads.copy()
            start = process_time()
            _contacts(plant.world, pads, cells, plant.fingers)
            times.append((process_time() - start) / self._player.n)
        return median(times)


def parts(player: VectorPlayer, pairs: int) -> list[Figure]:
    """CPU time of the parts of a step in one thread, and of the contact kernel alone.

    Args:
        player: Plays the environment, in one thread.
        pairs: Pairs of blocks.
    """
    split = Split(player)
    for _ in range(3):  # the first compiles; the next ones bring the environments about the slip limit
        split.pair()
    rows = [split.pair() for _ in range(max(pairs, 3))]
    middle = {name: median(row[name] for row in rows) for name in rows[0]}
    ratios = quantiles((row[""] / row[FLOOR] for row in rows), method="inclusive")
    ends = zip(("lower quartile", "upper quartile"), (ratios[0], ratios[2]), strict=True)
    return [
        Figure("batch step, one thread, environments in the cache", 1e9 * middle[""], "ns"),
        *(Figure(f"batch step: {name}", 1e9 * middle[name], "ns") for name in (*STAGES, BETWEEN)),
        Figure(f"batch step: {COMPILED}", 1e9 * middle[COMPILED], "ns"),
        *(Figure(f"batch step: {name}", 1e9 * middle[name], "ns") for name in (RESETS, REST)),
        Figure("sub-steps per step", middle["sub-steps"], "-"),
        *_regimes(split.tally),
        Figure(FLOOR, 1e9 * middle[FLOOR], "ns"),
        Figure("batch step / its contact kernel", ratios[1], "-"),
        *(Figure(f"batch step / its contact kernel, {name}", ratio, "-") for name, ratio in ends),
    ]


def _regimes(tally: np.ndarray) -> list[Figure]:
    """Fraction of the steps and sub-steps per step of each of `REGIMES`."""
    steps, figures = tally[:, 0].sum(), []
    for regime, (count, substeps) in zip(REGIMES, tally.tolist(), strict=True):
        figures.append(Figure(f"sub-steps per step, {regime}", substeps / max(count, 1.0), "-"))
        figures.append(Figure(f"fraction of the steps, {regime}", count / steps, "-"))
    return figures


@unlocked
def _advance(worlds, pads, cells, fingers, force_torque, slip_sensors, commands, tally):
    """A control step of all worlds; the sub-steps that it took are added to a `Split.tally`."""
    for i in range(worlds.shape[0]):
        before = pads[i, 0].slip_rate != 0.0
        done = step_world(worlds, pads, cells, fingers, force_torque, slip_sensors, commands[i, 0], i)
        after = pads[i, 0].slip_rate != 0.0
        if before != after:
            regime = 3
        elif after:
            regime = 2
        else:
            regime = 1 if done * worlds[i].calm_ticks > worlds[i].control_ticks else 0
        tally[regime, 0] += 1
        tally[regime, 1] += done


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
