"""Steps and resets one environment with PyBullet: two compiled calls before and after it moves the bodies."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import nullcontext
from dataclasses import replace
from functools import cache, partial
from types import SimpleNamespace
from typing import Any

import numpy as np
from numba import types

from slipgym._numba.compiled import compiled, patience
from slipgym._numba.fixed import Fixed, FixedType, entry_point, opened
from slipgym.config import Config, Randomization, TaskConfig
from slipgym.envs.actions import COMPONENT
from slipgym.envs.control_step import F2, F3, array
from slipgym.envs.nan_guard import Guard
from slipgym.envs.observation import SENSORS, ObservationBuffers
from slipgym.envs.reset_kernels import HARDWARE, START, WARM_UP_STEPS
from slipgym.envs.simulation import Simulation
from slipgym.envs.stages import (
    ACTION,
    BUFFERS,
    FRESH,
    INFOS,
    STATE,
    VALUES_TYPE,
    WHOLE,
    cells_type,
    compiled_stages,
)
from slipgym.envs.states import SimulationState
from slipgym.sensors.force_torque import roomier
from slipgym.tasks import Task
from slipgym.tasks.disturbance import bear_all, shake_tilt
from slipgym.world.bullet_engine import BulletWorld
from slipgym.world.bullet_rows import PAIR, POSE, VECTOR, queue, read_engine


@compiled
def _begin(fixed, action, fresh):
    """Begin a control step and queue the commanded grip force.

    Args:
        fixed: `Fixed` pointers to the stages, `BatchState`, FORCE_TORQUE (1, 2), where observations and infos
            are written, rows of the guard, and `slipgym.world.plant.Plant.cells`.
        action: Actions, their meaning and flags, as in `slipgym.envs.control_step.begin`; `Fixed`, so that
            its arrays are not taken apart at each call.
        fresh: Whether the reward terms start at 0.

    Returns:
        Mass of the object [kg].
    """
    stages, state, _, _, infos, _, _ = opened(fixed)
    if fresh:
        infos.terms[:] = 0.0
    stages.begin(stages.script_wrist, state, opened(action), 0, 1)
    queue(state.worlds, state.fingers, state.commands[0, 0])
    return state.worlds[0].mass


@compiled
def _finish(fixed, pose, wrist, normals, at):
    """End a control step: take over the engine's reading, measure, estimate, evaluate, observe.

    Args:
        fixed: As in `_begin`.
        pose: As in `slipgym.world.bullet_rows.read_engine`, like `wrist` and `normals`.
        wrist: Positions of the joints.
        normals: Normal forces.
        at: Row that `slipgym.envs.nan_guard.note` writes, whose value is returned; -1: a step of a world that
            settles, which is only measured.
    """
    stages, state, force_torque, buffers, infos, kept, cells = opened(fixed)
    read_engine(state.worlds, state.fingers, pose, wrist, normals)
    stages.measure(state, cells, force_torque, 0, 1)
    if at < 0:
        return 0
    stages.estimate(stages.update, state, 0, 1)
    stages.evaluate(stages.evaluate_step, state, 0, 1)
    for k in range(infos.terms.shape[1]):
        infos.terms[0, k] += state.episodes[0].terms[k]
    stages.look(state, buffers, 0, 1)
    stages.report(state, infos.numbers, infos.flags, 0, 1)
    return stages.note(kept, at, state, 0)


@compiled
def _equip(fixed, starts, values, hardware, patches):
    """Prepare an episode, see `slipgym.envs.reset_kernels.equip_rows`; `fixed` as in `_begin`."""
    stages, state, force_torque, _, _, _, cells = opened(fixed)
    stages.equip(starts, values, hardware, patches, state, cells, force_torque)


@compiled
def _open(fixed, starts, fresh):
    """Begin an episode of a world that has settled, see `slipgym.envs.reset_kernels.open_episodes`."""
    stages, state, force_torque, _, infos, _, _ = opened(fixed)
    stages.open(stages.update, starts, fresh, state, force_torque, infos.terms)
    stages.evaluate(stages.evaluate_step, state, 0, 1)
    stages.report(state, infos.numbers, infos.flags, 0, 1)


@cache
def _compiled_step(
    task: Any, update: tuple[Any, Any], force_torque: np.dtype, cells: int
) -> tuple[Any, Any, dict[str, Any]]:
    """Pointers to the stages, the type of what is fixed, and the four programs of this file by name."""
    stages = compiled_stages(task, update, force_torque, cells)
    kind = types.Tuple([stages.kind, STATE, array(force_torque, 2), BUFFERS, INFOS, F2, cells_type(cells)])
    starts = array(START)
    arguments = {
        _begin: (FixedType(ACTION), types.boolean),
        _finish: (POSE, VECTOR, PAIR, WHOLE),
        _equip: (starts, VALUES_TYPE, array(HARDWARE), F3),
        _open: (starts, FRESH),
    }
    programs = {}
    with patience(f"the control step of {task.name} with PyBullet", len(arguments)) as one_more:
        for function, others in arguments.items():
            name = function.py_func.__name__.lstrip("_")
            programs[name] = entry_point(function, (FixedType(kind), *others))
            one_more()
    return stages.linked, kind, programs


_NO_ACTION = np.zeros((1, 0)), np.zeros(0, COMPONENT), np.ones(1, dtype=bool)
"""Changes no command."""


class BulletSimulation(Simulation):
    """`Simulation` of one environment; PyBullet moves the bodies.

    Attributes:
        world: The PyBullet world, which moves the bodies of `plant`.
    """

    def __init__(
        self,
        config: Config,
        settings: TaskConfig,
        task: Task,
        estimator: str | Mapping[str, Any] | None,
        randomization: Randomization | None = None,
    ) -> None:
        super().__init__(config, settings, task, estimator, randomization)
        self.world = BulletWorld(config, self.plant)
        self._guard = Guard()
        self._first = True
        self._given: tuple[np.ndarray, ...] = _NO_ACTION
        self._action = self._no_action = Fixed(_NO_ACTION, ACTION)
        m = len(SENSORS) + len(task.columns)
        low, high = np.full((2, m), [[-np.inf], [np.inf]], dtype=np.float32)
        out, none = np.zeros((1, m), dtype=np.float32), np.zeros(0, dtype=np.int64)
        self._bind(ObservationBuffers(none, self.estimated, low, high, none, out, none))

    def step(
        self,
        actions: np.ndarray,
        components: np.ndarray,
        skip: int,
        active: np.ndarray,
        buffers: ObservationBuffers,
    ) -> None:
        """See `Simulation.step`."""
        if buffers is not self._buffers:
            self._bind(buffers)
        if not active.item(0):
            self.infos.terms[:] = 0.0
            return
        if actions is not self._given[0] or components is not self._given[1] or active is not self._given[2]:
            self._given = actions, components, active
            self._action = Fixed(self._given, ACTION)
        for k in range(skip):
            self._control_step(self._action, k == 0)
            if k + 1 < skip and self.over:
                break

    def keep_samples(self, count: int) -> None:
        """Have the force/torque sensors keep their newest samples for the caller to read; they keep none yet.

        At most `slipgym.sensors.force_torque.HISTORY` of them.
        """
        self.plant.force_torque = roomier(self.plant.force_torque, count)
        self._choose_programs()
        self._bind(self._buffers)
        self.world.bind()

    def sample(self, force: float) -> None:
        """One control step with a grip force per finger [N], the wrist as the task scripts it.

        Raises:
            FloatingPointError: A quantity is not finite; the environment needs a reset.
        """
        self.commands[0] = force, 0.0, 0.0, 0.0
        self._control_step(self._no_action, False)

    def get_state(self) -> SimulationState:
        """See `Simulation.get_state`."""
        return replace(super().get_state(), engine=self.world.get_state())

    def set_state(self, state: SimulationState, ready: np.ndarray) -> None:
        """See `Simulation.set_state`.

        Raises:
            ValueError: PyBullet does not accept its part of the state.
        """
        self.check_open()
        assert state.engine is not None
        self.world.set_state(state.engine)
        super().set_state(state, ready)

    @property
    def closed(self) -> bool:
        """Whether it was closed."""
        return self.world.closed

    def close(self) -> None:
        """Release the physics client; closing twice is harmless."""
        self.world.close()

    def _begin(self, starts: np.ndarray, values: np.ndarray) -> None:
        with patience(f"the reset of {self.task.name} with PyBullet") if self._first else nullcontext():
            self._reset(starts, values)
        self._first = False

    def _reset(self, starts: np.ndarray, values: np.ndarray) -> None:
        force, episode = starts["force"].item(), self.episode
        self._calls.equip(starts, values, *self._hardware)
        x, z, pitch = episode["wrist_start"][0].tolist()
        self.world.reset(self.boxes[0], force, (x, z, pitch), episode["wrist_roll"].item())
        bear_all(episode, self.plant.world)
        self._guard.reset()
        for _ in range(WARM_UP_STEPS):
            self._settle(force)
        self._calls.open(starts, self._fresh)

    def _bind(self, buffers: ObservationBuffers) -> None:
        """Have control steps write the observations to these buffers."""
        linked, kind, programs = _compiled_step(*self._kinds)
        own = self.state, self.plant.force_torque, buffers, self.infos, self._guard.rows, self.plant.cells
        fixed = Fixed((linked, *own), kind)
        self._buffers = buffers
        self._calls = SimpleNamespace(**{name: partial(each, fixed) for name, each in programs.items()})

    def _control_step(self, action: Fixed, fresh: bool) -> None:
        """The stages of `slipgym.envs.control_step`; PyBullet moves the bodies. Arguments as of `_begin`."""
        world, calls = self.world, self._calls
        mass = calls.begin(action, fresh)
        if self.plant.tilt is not None:
            shake_tilt(self.episode, self.plant.tilt)
        pose, _, wrist, normals, _ = world.move(mass)
        bad = calls.finish(pose, wrist, normals, self._guard.next())
        if bad > 0:
            world.discard()
            self._guard.check(bad)

    def _settle(self, force: float) -> None:
        """One control step of the world and its sensors alone, with a grip force per finger [N]."""
        self.world.command(force)
        pose, _, wrist, normals, _ = self.world.move()
        self._calls.finish(pose, wrist, normals, -1)
