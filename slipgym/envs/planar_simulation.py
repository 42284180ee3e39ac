"""Steps and resets n environments with the planar engine: one compiled call for all of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache, partial
from typing import Any

import numpy as np
from numba import types

from estimator._numba.memory import lent
from slipgym._numba.compiled import patience, pointed, unlocked
from slipgym._numba.fixed import Fixed, FixedType, entry_point, opened
from slipgym._numba.prefetch import fetch
from slipgym.config import Config, Randomization, TaskConfig
from slipgym.envs.control_step import F1, F3, array
from slipgym.envs.nan_guard import Guard, sound
from slipgym.envs.observation import ObservationBuffers
from slipgym.envs.reset_kernels import HARDWARE, START, WARM_UP_STEPS, grip
from slipgym.envs.simulation import Simulation
from slipgym.envs.stages import (
    ACTION,
    BUFFERS,
    FLAGS,
    FRESH,
    INFOS,
    STATE,
    VALUES_TYPE,
    WHOLE,
    Program,
    cells_type,
    compiled_stages,
)
from slipgym.tasks import Task
from slipgym.threads import Threads
from slipgym.world.planar_engine import step_world

BLOCK = 16
"""Number of rows that are stepped together: few enough to stay in the processor's caches, and enough for it
to prefetch each array."""


@pointed
def _move(state, cells, force_torque, lo, hi):
    """Move the bodies of rows lo to hi with the planar engine, and prefetch those of the next block."""
    state, cells, force_torque = lent((state, cells, force_torque))
    for i in range(lo, hi):
        ahead = i + hi - lo  # the same row of the next block
        fetch(state.worlds, ahead, ahead + 1)
        fetch(state.pads, ahead, ahead + 1)
        fetch(state.fingers, ahead, ahead + 1)
        fetch(force_torque, ahead, ahead + 1)
        fetch(state.slip_sensors, ahead, ahead + 1)
        step_world(
            state.worlds, state.pads, cells, state.fingers, force_torque, state.slip_sensors,
            state.commands[i, 0], i,
        )  # fmt: skip


@unlocked
def _drive(fixed, buffers, action, results, skip, lo, hi):
    """Make `skip` control steps in the active rows among lo to hi; a row stops when its episode ends.

    Rewards, ends of episodes and infos are gathered here, while the rows are in the cache: gathering them
    later from thousands of records would cost a cache miss each.

    Args:
        fixed: `Fixed` pointers to the stages and to `_move`, and the arguments of `_move`. References to its
            arrays are not counted, which would take longer than a sub-step.
        buffers: `ObservationBuffers`.
        action: Actions (n, m), their meaning COMPONENT (m,), and which rows are active (n,).
        results: Output: infos as in `InfoBuffer`, the sums of the reward terms (n,), and whether each episode
            was terminated and truncated (n,).
        skip: Number of control steps.
        lo: First row.
        hi: Row after the last.

    Returns:
        The first row with a number that is not finite; -1 if there is none.
    """
    stages, move, state, cells, force_torque = opened(fixed)
    buffers, action, results = lent((buffers, action, results))
    active = action[2]
    numbers, flags, terms, rewards, terminated, truncated = results
    episodes = state.episodes
    bad = -1
    size = BLOCK if skip == 1 else 1
    start = lo
    while start < hi:
        stop = start
        while stop < hi and active[stop] and stop - start < size:
            for k in range(terms.shape[1]):
                terms[stop, k] = 0.0
            stop += 1
        if stop == start:
            start += 1
            continue
        for _ in range(skip):
            stages.begin(stages.script_wrist, state, action, start, stop)
            move(state, cells, force_torque, start, stop)
            stages.measure(state, cells, force_torque, start, stop)
            stages.estimate(stages.update, state, start, stop)
            stages.evaluate(stages.evaluate_step, state, start, stop)
            over = False
            for i in range(start, stop):
                ahead = i + stop - start  # the same row of the next block
                fetch(state.estimator_states[:, 0], 2 * ahead, 2 * ahead + 2)
                fetch(state.estimates, 2 * ahead, 2 * ahead + 2)
                fetch(episodes, ahead, ahead + 1)
                for k in range(terms.shape[1]):
                    terms[i, k] += episodes[i].terms[k]
                if bad < 0 and not sound(i, state):
                    bad = i
                over = episodes[i].dropped or episodes[i].ended or episodes[i].step >= episodes[i].steps
            if over:  # a block of several rows has a single control step anyway
                break
        stages.look(state, buffers, start, stop)
        for i in range(start, stop):
            rewards[i] = 0.0
            for k in range(terms.shape[1]):
                rewards[i] += terms[i, k]
            terminated[i] = episodes[i].dropped or episodes[i].ended
            truncated[i] = episodes[i].step >= episodes[i].steps and not terminated[i]
        stages.report(state, numbers, flags, start, stop)
        start = stop
    return bad


@unlocked
def _start(fixed, starts, values, begun, infos):
    """Begin episodes of START (m,) and VALUES (m,), and write their infos; `fixed` as in `_drive`.

    `begun` holds hardware and patches of `equip_rows`, and `fresh` of `open_episodes`.
    """
    stages, move, state, cells, force_torque = opened(fixed)
    hardware, patches, fresh = begun
    stages.equip(starts, values, hardware, patches, state, cells, force_torque)
    grip(starts, state.episodes, state.worlds, state.pads, cells, state.fingers)
    for k in range(starts.shape[0]):
        i = starts[k].row
        state.commands[i, 0] = starts[k].force
        for _ in range(WARM_UP_STEPS):
            move(state, cells, force_torque, i, i + 1)
            stages.measure(state, cells, force_torque, i, i + 1)
    stages.open(stages.update, starts, fresh, state, force_torque, infos.terms)
    for k in range(starts.shape[0]):
        i = starts[k].row
        stages.evaluate(stages.evaluate_step, state, i, i + 1)
        stages.report(state, infos.numbers, infos.flags, i, i + 1)


@cache
def _compiled_batch(
    task: Any, update: tuple[Any, Any], force_torque: np.dtype, cells: int
) -> tuple[tuple[Any, ...], Any, Callable[..., Any], Callable[..., Any]]:
    """Pointers to the stages and `_move`, the type of what is fixed, and programs of the other two."""
    stages = compiled_stages(task, update, force_torque, cells)
    plant = STATE, cells_type(cells), array(force_torque, 2)
    rows = WHOLE, WHOLE
    with patience(f"the batch of {task.name}", 3) as one_more:
        move = Program(_move, types.void(*plant, *rows))
        one_more()
        kind = types.Tuple([stages.kind, move.known, *plant])
        results = types.Tuple([*INFOS.types, F1, FLAGS, FLAGS])
        drive = entry_point(_drive, (FixedType(kind), BUFFERS, ACTION, results, WHOLE, *rows))
        one_more()
        begun = types.Tuple([array(HARDWARE), F3, FRESH])
        start = entry_point(_start, (FixedType(kind), array(START), VALUES_TYPE, begun, INFOS))
    return (stages.linked, move.pointer), kind, drive, start


class PlanarSimulation(Simulation):
    """`Simulation` of n environments with the planar engine.

    It takes the number of threads, too; None: one per processor, each with at least 32 environments.

    Attributes:
        rewards: Sum of the last step's reward terms, (n,); 0 for environments that made no step.
        terminated: Whether the object was dropped in the last step, (n,).
        truncated: Whether the last step reached the time limit without a drop, (n,).

    Raises:
        ValueError: The configuration lets the object tilt, or a value is not allowed.
    """

    def __init__(
        self,
        config: Config,
        settings: TaskConfig,
        task: Task,
        estimator: str | Mapping[str, Any] | None,
        randomization: Randomization | None = None,
        n: int = 1,
        threads: int | None = None,
    ) -> None:
        if config.physics.tilt:
            raise ValueError('physics.tilt = true needs engine="bullet": the planar engine has no tilt')
        super().__init__(config, settings, task, estimator, randomization, n)
        self._threads = Threads(n, threads)
        self._closed = False
        self._blank()
        pointers, kind, drive, start = _compiled_batch(*self._kinds)
        fixed = Fixed((*pointers, self.state, self.plant.cells, self.plant.force_torque), kind)
        self._drive, self._start = partial(drive, fixed), partial(start, fixed)
        self._begun = *self._hardware, self._fresh

    def step(
        self,
        actions: np.ndarray,
        components: np.ndarray,
        skip: int,
        active: np.ndarray,
        buffers: ObservationBuffers,
        meanwhile: Callable[[], None] | None = None,
    ) -> None:
        """Make `skip` control steps, see `Simulation.step`; results are written to new arrays.

        `meanwhile` is called while threads step; it may change the environments that take no part.
        """
        self.check_open()
        self._blank()
        action = actions, components, active
        results = *self.infos, self.rewards, self.terminated, self.truncated

        def part(lo: int, hi: int) -> int:
            return self._drive(buffers, action, results, skip, lo, hi)

        for bad in self._threads.run(part, meanwhile):
            if bad >= 0:
                self._explain(bad)

    @property
    def closed(self) -> bool:
        """Whether it was closed."""
        return self._closed

    def close(self) -> None:
        """End the threads; closing twice is harmless."""
        self._threads.close()
        self._closed = True

    def _begin(self, starts: np.ndarray, values: np.ndarray) -> None:
        self._start(starts, values, self._begun, self.infos)

    def _blank(self) -> None:
        """Make new arrays for the results of a step: the caller owns those of the last step."""
        self.rewards, (self.terminated, self.truncated) = np.zeros(self.n), np.zeros((2, self.n), dtype=bool)

    def _explain(self, bad: int) -> None:
        """Raise FloatingPointError that names the first quantity of an environment that is not finite."""
        guard, where = Guard(), f"environment {bad}: " if self.n > 1 else ""
        guard.check(self.stages.note(guard.rows, guard.next(), self.state, bad), where)
