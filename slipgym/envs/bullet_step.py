"""The stages of a control step with PyBullet, before and after it moves the bodies, and of a reset."""

from __future__ import annotations

from functools import cache, partial
from typing import Any

import numpy as np
from numba import types

from slipgym._numba.calls import entry_point
from slipgym._numba.compiled import compiled, patience
from slipgym._numba.fixed import Fixed, FixedType, opened
from slipgym.envs.control_step import BatchState
from slipgym.envs.infos import InfoBuffer
from slipgym.envs.observation import ObservationBuffers
from slipgym.envs.reset_kernels import HARDWARE, START
from slipgym.envs.stages import (
    ACTION,
    BUFFERS,
    F2,
    F3,
    FRESH,
    INFOS,
    STATE,
    VALUES_TYPE,
    WHOLE,
    array,
    cells_type,
    compiled_stages,
)
from slipgym.world.bullet_rows import PAIR, POSE, VECTOR, queue, read_engine


@compiled
def _begin(fixed, action, fresh):
    """Begin a control step and queue the commanded grip force.

    Args:
        fixed: See `BulletStep`.
        action: `fixed_action`.
        fresh: Whether the reward terms start at 0.

    Returns:
        Mass of the object [kg].
    """
    stages, state, _, _, infos, _ = opened(fixed)
    if fresh:
        infos.terms[:] = 0.0
    stages.begin(stages.script_wrist, state, opened(action), 0, 1)
    queue(state.worlds, state.fingers, state.commands[0, 0])
    return state.worlds[0].mass


@compiled
def _finish(fixed, pose, wrist, normals, at):
    """End a control step: take over the engine's reading, measure, estimate, evaluate, observe.

    Args:
        fixed: See `BulletStep`.
        pose: As in `slipgym.world.bullet_rows.read_engine`, like the next two.
        wrist: Positions of the joints.
        normals: Normal forces.
        at: Row of the guard's table that `slipgym.envs.nan_guard.note` writes; -1: a step of a world that
            settles, which is only measured.

    Returns:
        As `slipgym.envs.nan_guard.note`.
    """
    stages, state, force_torque, buffers, infos, kept = opened(fixed)
    read_engine(state.worlds, state.fingers, pose, wrist, normals)
    stages.measure(state, force_torque, 0, 1)
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
def _equip(fixed, starts, values, hardware, patches, cells):
    """Prepare an episode, see `slipgym.envs.reset_kernels.equip_rows`; `fixed` as in `BulletStep`."""
    stages, state, force_torque, _, _, _ = opened(fixed)
    stages.equip(starts, values, hardware, patches, state, cells, force_torque)


@compiled
def _open(fixed, starts, fresh):
    """Begin an episode of a world that has settled, see `slipgym.envs.reset_kernels.open_episodes`."""
    stages, state, force_torque, _, infos, _ = opened(fixed)
    stages.open(stages.update, starts, fresh, state, force_torque, infos.terms)
    stages.evaluate(stages.evaluate_step, state, 0, 1)
    stages.report(state, infos.numbers, infos.flags, 0, 1)


def fixed_action(actions: np.ndarray, components: np.ndarray, active: np.ndarray) -> Fixed:
    """An action as in `slipgym.envs.control_step.begin`, whose arrays are not taken apart at each call."""
    return Fixed((actions, components, active), ACTION)


class BulletStep:
    """The two calls of a control step, and those of a reset, for the arrays of one simulation.

    Args:
        kinds: Arguments of `slipgym.envs.stages.compiled_stages`.
        state: `BatchState` of one environment.
        force_torque: FORCE_TORQUE (1, 2).
        buffers: Where observations are written.
        infos: Where infos are written; reward terms are added to those that are there.
        kept: See `slipgym.envs.nan_guard.note`.

    Attributes:
        begin: Takes the arguments of `_begin` after the first.
        finish: Takes those of `_finish`.
        equip: Takes those of `_equip`.
        open: Takes those of `_open`.
        buffers: As given.
    """

    def __init__(
        self,
        kinds: tuple[Any, ...],
        state: BatchState,
        force_torque: np.ndarray,
        buffers: ObservationBuffers,
        infos: InfoBuffer,
        kept: np.ndarray,
    ) -> None:
        stages, kind, *programs = _compiled_step(*kinds)
        fixed = Fixed((stages.linked, state, force_torque, buffers, infos, kept), kind)
        self.begin, self.finish, self.equip, self.open = (partial(program, fixed) for program in programs)
        self.buffers = buffers


@cache
def _compiled_step(task: Any, update: Any, force_torque: np.dtype, cells: int) -> tuple[Any, ...]:
    """The stages, the type of what is fixed, and the machine code of the four functions of this file."""
    stages = compiled_stages(task, update, force_torque, cells)
    kind = types.Tuple([stages.kind, STATE, array(force_torque, 2), BUFFERS, INFOS, F2])
    starts = array(START)
    arguments = {
        _begin: (FixedType(ACTION), types.boolean),
        _finish: (POSE, VECTOR, PAIR, WHOLE),
        _equip: (starts, VALUES_TYPE, array(HARDWARE), F3, cells_type(cells)),
        _open: (starts, FRESH),
    }
    programs = []
    with patience(f"the control step of {task.name} with PyBullet", len(arguments)) as one_more:
        for function, others in arguments.items():
            programs.append(entry_point(function, (FixedType(kind), *others)))
            one_more()
    return stages, kind, *programs
