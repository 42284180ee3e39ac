"""Steps and resets many environments of the planar engine in one compiled call."""

from __future__ import annotations

from functools import cache
from typing import Any

from numba import types

from slipgym._numba.compiled import patience, unlocked
from slipgym._numba.prefetch import fetch
from slipgym.envs.actions import COMPONENT, interpret
from slipgym.envs.control_step import (
    Kernels,
    array,
    begin_control_step,
    end_control_step,
    entry_point,
    evaluate,
    measure_rows,
)
from slipgym.envs.infos import write_infos
from slipgym.envs.nan_guard import sound
from slipgym.envs.observation import observe
from slipgym.envs.reset_kernels import START, WARM_UP_STEPS, equip, grip, open_episodes
from slipgym.world.planar_engine import step_world

BLOCK = 64
"""Number of rows that are stepped together: few enough to stay in the processor's caches, and enough for it
to prefetch each array."""


@unlocked
def _move_rows(state, lo, hi):
    """Move the bodies of rows lo to hi, and prefetch those of the next block."""
    for i in range(lo, hi):
        ahead = i + hi - lo  # the same row of the next block
        fetch(state.worlds, ahead, ahead + 1)
        fetch(state.pads, ahead, ahead + 1)
        fetch(state.fingers, ahead, ahead + 1)
        fetch(state.force_torque, ahead, ahead + 1)
        fetch(state.slip_sensors, ahead, ahead + 1)
        fetch(state.estimator_states, 2 * ahead, 2 * ahead + 2)
        fetch(state.estimates, 2 * ahead, 2 * ahead + 2)
        fetch(state.episodes, ahead, ahead + 1)
        _move(state, i, state.commands[i, 0])


@unlocked
def _move(state, i, force):
    """Move the bodies of row i by a control step, under a grip force commanded to both fingers [N]."""
    step_world(
        state.worlds, state.pads, state.cells, state.fingers, state.force_torque, state.slip_sensors, force, i
    )


@unlocked
def _drive(script_wrist, evaluate_step, update, batch, buffers, action, results, skip, lo, hi):
    """Make `skip` control steps in the active rows among lo to hi; a row stops when its episode ends.

    Rewards, ends of episodes and infos are gathered here, while the rows are in the cache: gathering them
    later from thousands of records would cost a cache miss each.

    Args:
        script_wrist: Function of the task.
        evaluate_step: Function of the task.
        update: Function of the estimator.
        batch: `BatchState`.
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
    state = batch
    wrist, friction, low, high, out = buffers
    actions, components, active = action
    numbers, flags, terms, rewards, terminated, truncated = results
    episodes = state.episodes
    bad = -1
    size = BLOCK if skip == 1 else 1
    start = lo
    while start < hi:
        stop = start
        while stop < hi and active[stop] and stop - start < size:
            terms[stop] = 0.0
            stop += 1
        if stop == start:
            start += 1
            continue
        rows = slice(start, stop)
        for _ in range(skip):
            interpret(actions[rows], components, episodes[rows], state.commands[rows])
            begin_control_step(script_wrist, state, start, stop)
            _move_rows(state, start, stop)
            end_control_step(update, evaluate_step, state, start, stop)
            over = False
            for i in range(start, stop):
                for k in range(terms.shape[1]):
                    terms[i, k] += episodes[i].terms[k]
                if bad < 0 and not sound(
                    i, state.worlds, state.pads, state.fingers, state.per_finger, episodes
                ):
                    bad = i
                over = episodes[i].dropped or episodes[i].step >= episodes[i].steps
            if over:  # a block of several rows has a single control step anyway
                break
        observe(
            state.wrenches[rows], state.twists[rows], state.slip_sensors[rows], episodes[rows],
            state.task_part[rows], state.worlds[rows], wrist, friction[rows], low, high, out[rows],
        )  # fmt: skip
        for i in range(start, stop):
            rewards[i] = 0.0
            for k in range(terms.shape[1]):
                rewards[i] += terms[i, k]
            terminated[i] = episodes[i].dropped
            truncated[i] = episodes[i].step >= episodes[i].steps and not terminated[i]
        _write_infos(state, numbers, flags, start, stop)
        start = stop
    return bad


@unlocked
def _write_infos(state, numbers, flags, lo, hi):
    """Write the infos of rows lo to hi."""
    rows = slice(lo, hi)
    write_infos(
        numbers[rows], flags[rows], state.worlds[rows], state.pads[rows], state.fingers[rows],
        state.episodes[rows], state.ground_truth[rows], state.estimated[rows], state.per_finger[rows],
    )  # fmt: skip


@unlocked
def _start(evaluate_step, starts, batch, begun, infos):
    """Begin episodes.

    Args:
        evaluate_step: Function of the task.
        starts: START (m,).
        batch: `BatchState` of all rows.
        begun: Initial estimator states and estimates of both fingers; spread and noise of `equip`.
        infos: Output, see `InfoBuffer`.
    """
    state = batch
    numbers, flags, terms = infos
    fresh_states, fresh_estimates, spread, noise = begun
    grip(starts, state.episodes, state.worlds, state.pads, state.cells, state.fingers)
    equip(starts, spread, noise, state.pads, state.force_torque, state.slip_sensors, state.ground_truth)
    for k in range(starts.shape[0]):
        i = starts[k].row
        for _ in range(WARM_UP_STEPS):
            _move(state, i, starts[k].force)
            measure_rows(state, i, i + 1)
    open_episodes(
        starts, fresh_states, fresh_estimates, state.slip_sensors, state.estimator_states, state.estimates,
        state.episodes, state.commands, terms,
    )  # fmt: skip
    for k in range(starts.shape[0]):
        i = starts[k].row
        evaluate(evaluate_step, state, i, i + 1)
        _write_infos(state, numbers, flags, i, i + 1)


@cache
def compiled_batch(*kinds: Any) -> tuple[Any, Any]:
    """Return the compiled functions that step and reset environments of the planar engine.

    The first call on a machine compiles them, which takes about half a minute; the result is cached beside
    the sources.

    Args:
        *kinds: Arguments of `slipgym.envs.control_step.Kernels`; the first is the task.

    Returns:
        Functions of the arguments of `_drive` but the first three, and of `_start` but the first.
    """
    kernels = Kernels(*kinds)
    f1, f2 = array(types.float64), array(types.float64, 2)
    single, flags = array(types.float32), array(types.boolean)
    functions = kernels.script_wrist, kernels.evaluate_step, kernels.update
    buffers = types.Tuple([array(types.int64), f2, single, single, array(types.float32, 2)])
    action, infos = types.Tuple([f2, array(COMPONENT), flags]), [f2, array(types.boolean, 2), f2]
    results = types.Tuple([*infos, f1, flags, flags])
    whole = types.int64
    drive = whole(*functions, kernels.state, buffers, action, results, whole, whole, whole)
    begun = types.Tuple([*kernels.fresh, f1, f1])
    start = types.void(kernels.evaluate_step, array(START), kernels.state, begun, types.Tuple(infos))
    with patience(f"the batch of {kinds[0].name}"):
        pointers = kernels.pointers()
        return (
            entry_point(_drive, drive, *pointers.values()),
            entry_point(_start, start, pointers["evaluate_step"]),
        )
