"""A control step of many environments in one compiled call, without an engine.

What differs between tasks and estimators is called through function pointers, so that one source serves
all; what each does is the same function that the environment with PyBullet calls.
"""

from __future__ import annotations

from functools import cache, partial
from typing import Any

import numpy as np
from numba import from_dtype, types

from estimator.estimate import ESTIMATE
from slipgym._numba.borrowing import borrowed
from slipgym._numba.compiled import patience, unlocked
from slipgym._numba.pointers import Known, Pointer
from slipgym._numba.prefetch import fetch
from slipgym.contact.records import PAD
from slipgym.envs.actions import COMPONENT, interpret
from slipgym.envs.guard import sound
from slipgym.envs.observation import combine, observe
from slipgym.envs.start import START, WARM_UP_STEPS, equip, grip, open_episodes
from slipgym.envs.told import tell
from slipgym.sensors.measure import measure
from slipgym.sensors.slip_velocity import SLIP_SENSOR
from slipgym.tasks.disturbance import disturb
from slipgym.tasks.episode import EPISODE, begin_step
from slipgym.world.planar_engine import move
from slipgym.world.records import FINGER, WORLD

BLOCK = 64
"""Rows that go through a control step together: few enough to stay in the processor's caches, and enough
for it to fetch each array ahead."""


@unlocked
def _sample(
    plan, judge, update,
    worlds, pads, cells, fingers, force_torque, slip_sensors,
    parameters, states, estimates,
    episodes, commands, wrenches, twists, per_finger, estimated, task_part, truth,
    lo, hi,
):  # fmt: skip
    """One slip-velocity sample of rows lo to hi: act, move, measure, estimate, judge."""
    rows, fingers_of = slice(lo, hi), slice(2 * lo, 2 * hi)
    begin_step(episodes[rows], commands[rows])
    disturb(episodes[rows], worlds[rows], pads[rows], truth[rows])
    plan(episodes[rows], worlds[rows])
    for i in range(lo, hi):
        ahead = i + hi - lo  # the same row of the next block
        fetch(worlds, ahead, ahead + 1)
        fetch(pads, ahead, ahead + 1)
        fetch(fingers, ahead, ahead + 1)
        fetch(force_torque, ahead, ahead + 1)
        fetch(slip_sensors, ahead, ahead + 1)
        fetch(states, 2 * ahead, 2 * ahead + 2)
        fetch(estimates, 2 * ahead, 2 * ahead + 2)
        fetch(episodes, ahead, ahead + 1)
        move(worlds, pads, cells, fingers, force_torque, slip_sensors, commands[i, 0], i)
    measure(worlds[rows], force_torque[rows], slip_sensors[rows], wrenches[rows], twists[rows])
    for i in range(lo, hi):
        episodes[i].step += 1
        pair = slice(2 * i, 2 * i + 2)
        own = parameters[pair] if parameters.shape[0] > 1 else parameters
        time = episodes[i].step * episodes[i].step_time
        update(states[pair], own, time, wrenches[i], twists[i], estimates[pair])
    combine(estimates[fingers_of], per_finger[rows], estimated[rows])
    judge(episodes[rows], worlds[rows], fingers[rows], task_part[rows])


@unlocked
def _drive(plan, judge, update, arrays, sight, action, results, tells_all, skip, lo, hi):
    """A step, that is `skip` samples, of the active rows among lo to hi; an episode that ends stops its row.

    What it was worth, whether the episode ended and what infos tell stands in arrays of their own: gathered
    later, from the records of thousands of rows, each would be a miss of the cache.

    Args:
        plan: The task's.
        judge: The task's.
        update: The estimator's.
        arrays: State of the rows, see `PlanarSimulation`.
        sight: See `Sight`.
        action: What is done (n, m), COMPONENT (m,), what it means, and which rows are active (n,).
        results: Output: what is told, as in `Told`, the sums of the reward terms (n,), and whether an episode
            was terminated and whether truncated (n,).
        tells_all: Whether it is noted of all rows what infos tell, or only of those whose episode ends.
        skip: Samples.
        lo: First row.
        hi: Row after the last.

    Returns:
        The first row with a number that is not finite; -1 without one.
    """
    (
        worlds, pads, cells, fingers, force_torque, slip_sensors,
        parameters, states, estimates,
        episodes, commands, wrenches, twists, per_finger, estimated, task_part, truth,
    ) = borrowed(arrays)  # fmt: skip
    wrist, friction, low, high, out = borrowed(sight)
    actions, components, active = borrowed(action)
    numbers, flags, terms, rewards, terminated, truncated = borrowed(results)
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
            interpret(actions[rows], components, episodes[rows], commands[rows])
            _sample(
                plan, judge, update,
                worlds, pads, cells, fingers, force_torque, slip_sensors,
                parameters, states, estimates,
                episodes, commands, wrenches, twists, per_finger, estimated, task_part, truth,
                start, stop,
            )  # fmt: skip
            over = False
            for i in range(start, stop):
                for k in range(terms.shape[1]):
                    terms[i, k] += episodes[i].terms[k]
                if bad < 0 and not sound(i, worlds, pads, fingers, per_finger, episodes):
                    bad = i
                over = episodes[i].dropped or episodes[i].step >= episodes[i].steps
            if over:  # a block of several rows has a single sample anyway
                break
        observe(
            wrenches[rows], twists[rows], slip_sensors[rows], episodes[rows], task_part[rows], worlds[rows],
            wrist, friction[rows], low, high, out[rows],
        )  # fmt: skip
        for i in range(start, stop):
            rewards[i] = 0.0
            for k in range(terms.shape[1]):
                rewards[i] += terms[i, k]
            terminated[i] = episodes[i].dropped
            truncated[i] = episodes[i].step >= episodes[i].steps and not terminated[i]
            if tells_all or terminated[i] or truncated[i]:
                row = slice(i, i + 1)
                tell(
                    numbers[row], flags[row], worlds[row], pads[row], fingers[row], episodes[row],
                    truth[row], estimated[row], per_finger[row],
                )  # fmt: skip
        start = stop
    return bad


@unlocked
def _start(judge, starts, arrays, begun, told):
    """Begin episodes.

    Args:
        judge: The task's.
        starts: START (m,).
        arrays: State of all rows, see `PlanarSimulation`.
        begun: What they begin with: states and estimates of both fingers, spread and noise of `equip`.
        told: Output, see `Told`.
    """
    (
        worlds, pads, cells, fingers, force_torque, slip_sensors,
        _, states, estimates,
        episodes, commands, wrenches, twists, per_finger, estimated, task_part, truth,
    ) = borrowed(arrays)  # fmt: skip
    numbers, flags, terms = borrowed(told)
    fresh_states, fresh_estimates, spread, noise = begun
    grip(starts, episodes, worlds, pads, cells, fingers)
    equip(starts, spread, noise, pads, force_torque, slip_sensors, truth)
    for k in range(starts.shape[0]):
        i, force = starts[k].row, starts[k].force
        row = slice(i, i + 1)
        for _ in range(WARM_UP_STEPS):
            move(worlds, pads, cells, fingers, force_torque, slip_sensors, force, i)
            measure(worlds[row], force_torque[row], slip_sensors[row], wrenches[row], twists[row])
    open_episodes(
        starts, fresh_states, fresh_estimates, slip_sensors, states, estimates, episodes, commands, terms
    )
    for k in range(starts.shape[0]):
        i = starts[k].row
        row = slice(i, i + 1)
        combine(estimates[2 * i : 2 * i + 2], per_finger[row], estimated[row])
        judge(episodes[row], worlds[row], fingers[row], task_part[row])
        tell(
            numbers[row], flags[row], worlds[row], pads[row], fingers[row], episodes[row],
            truth[row], estimated[row], per_finger[row],
        )  # fmt: skip


def _row(dtype: Any, ndim: int = 1) -> Any:
    return types.Array(from_dtype(dtype) if isinstance(dtype, np.dtype) else dtype, ndim, "C")


@cache
def compiled_batch(
    task: Any, update: Any, states: np.dtype, parameters: np.dtype, force_torque: np.dtype, patches: bool
) -> tuple[Any, Any]:
    """What steps and what starts the environments of a task, an estimator and a kind of contact, compiled.

    The first call on a machine compiles it, which takes about half a minute; the result is kept beside the
    sources.

    Args:
        task: The task.
        update: The estimator's compiled `update_batch`.
        states: Dtype of its state.
        parameters: Dtype of its parameters.
        force_torque: Dtype of the force/torque sensors.
        patches: Whether pads have cells.

    Returns:
        Functions of the arguments of `_drive` but the first three, and of `_start` but the first.
    """
    state, parameter, estimate = _row(states), _row(parameters), _row(ESTIMATE)
    episode, world, finger = _row(EPISODE), _row(WORLD), _row(FINGER, 2)
    f1, f2, f3 = (types.Array(types.float64, k, "C") for k in (1, 2, 3))
    single, flags = types.Array(types.float32, 1, "C"), types.Array(types.boolean, 1, "C")
    plan = types.void(episode, world)
    judge = types.void(episode, world, finger, f2)
    learn = types.void(state, parameter, types.float64, f2, f2, estimate)
    for function, signature in ((task.script_wrist, plan), (task.evaluate_step, judge)):
        function.compile(signature)
    cells = types.Array(types.float64, 4, "C") if patches else types.none
    arrays = types.Tuple([
        world, _row(PAD, 2), cells, finger, _row(force_torque, 2), _row(SLIP_SENSOR, 2),
        parameter, state, estimate,
        episode, f2, f3, f3, f3, f2, f2, f2,
    ])  # fmt: skip
    kinds = [Known(kind) for kind in (plan, judge, learn)]
    sight = types.Tuple(
        [types.Array(types.int64, 1, "C"), f2, single, single, types.Array(types.float32, 2, "C")]
    )
    action, told = types.Tuple([f2, _row(COMPONENT), flags]), [f2, types.Array(types.boolean, 2, "C"), f2]
    results = types.Tuple([*told, f1, flags, flags])
    whole = types.int64
    drive = whole(*kinds, arrays, sight, action, results, types.boolean, whole, whole, whole)
    start = types.void(
        kinds[1], _row(START), arrays, types.Tuple([state, estimate, f1, f1]), types.Tuple(told)
    )
    with patience(f"the batch of {task.name}"):
        _drive.compile(drive)
        _start.compile(start)
        pointers = [
            Pointer(*function)
            for function in ((task.script_wrist, plan), (task.evaluate_step, judge), (update, learn))
        ]
    return (
        partial(_drive.overloads[drive.args].entry_point, *pointers),
        partial(_start.overloads[start.args].entry_point, pointers[1]),
    )
