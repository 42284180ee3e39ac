"""The stages of a control step with PyBullet, in two calls: before and after it moves the bodies."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numba import types

from slipgym._numba.compiled import compiled, patience
from slipgym.envs.stages import ACTION, BUFFERS, F2, INFOS, STATE, WHOLE, array, compiled_stages
from slipgym.world.bullet_rows import PAIR, POSE, VECTOR, queue, read_engine


@compiled
def _begin(stages, state, action):
    """Begin a control step and queue the commanded grip force.

    Args:
        stages: `Linked`.
        state: `BatchState` of one environment.
        action: As in `slipgym.envs.control_step.begin`.

    Returns:
        Mass of the object [kg].
    """
    stages.begin(stages.script_wrist, state, action, 0, 1)
    queue(state.worlds, state.fingers, state.commands[0, 0])
    return state.worlds[0].mass


@compiled
def _finish(stages, state, force_torque, pose, wrist, normals, buffers, infos, kept, at):
    """End a control step: take over the engine's reading, measure, estimate, evaluate, observe.

    Args:
        stages: `Linked`.
        state: `BatchState` of one environment.
        force_torque: FORCE_TORQUE (1, 2).
        pose: As in `slipgym.world.bullet_rows.read_engine`, like the next two.
        wrist: Positions of the joints.
        normals: Normal forces.
        buffers: `ObservationBuffers`.
        infos: Output: `InfoBuffer`; reward terms are added to those that are there.
        kept: Output, see `slipgym.envs.nan_guard.note`.
        at: Row of it; -1: a step of a world that settles, which is only measured.

    Returns:
        As `slipgym.envs.nan_guard.note`.
    """
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


@cache
def compiled_step(task: Any, update: Any, force_torque: np.dtype, cells: int) -> tuple[Any, Any]:
    """Compile `_begin` and `_finish`.

    Args:
        task: As of `slipgym.envs.stages.Stages`, like the others.
        update: The estimator's.
        force_torque: Dtype of the sensors.
        cells: Dimensions of the patches.

    Returns:
        Functions of their arguments but the first.
    """
    stages = compiled_stages(task, update, force_torque, cells)
    arguments = STATE, array(force_torque, 2), POSE, VECTOR, PAIR, BUFFERS, INFOS, F2, WHOLE
    with patience(f"the control step of {task.name} with PyBullet"):
        begin = stages.program(_begin, types.float64, STATE, ACTION)
        return begin, stages.program(_finish, WHOLE, *arguments)
