"""The stages of a control step of many environments: begin, move, measure, estimate, evaluate, report.

Each is a program of its own, see `slipgym.envs.stages`: the planar engine calls them for blocks of rows,
through pointers, PyBullet's simulation for one row. Functions that differ between tasks and estimators are
called through pointers, too, so that one program serves all of them: `script_wrist` and `evaluate_step` of
the task, `update` of the estimator.

`state` is a `BatchState`, `lo` the first of its rows that a stage works on, `hi` the row after the last;
`cells` is `slipgym.world.plant.Plant.cells`, `force_torque` FORCE_TORQUE (n, 2).
"""

from __future__ import annotations

from typing import Annotated, Any, NamedTuple

import numpy as np
from numba import from_dtype, types

from estimator._numba.memory import lent
from estimator.estimate import ESTIMATE
from slipgym._numba.compiled import compiled, pointed, unlocked
from slipgym._numba.fixed import opened
from slipgym.contact.records import PAD
from slipgym.envs.actions import interpret
from slipgym.envs.infos import write_infos
from slipgym.envs.observation import combine, guess, observe
from slipgym.sensors.markers import MARKERS
from slipgym.sensors.measure import measure
from slipgym.sensors.owned import GRIPPER, measure_owned
from slipgym.sensors.slip_velocity import SLIP_SENSOR
from slipgym.tasks.disturbance import disturb
from slipgym.tasks.episode import EPISODE, begin_step
from slipgym.world.records import FINGER, WORLD


def array(dtype: Any, ndim: int = 1, layout: str = "C") -> Any:
    """Type of an array of numbers or records."""
    return types.Array(from_dtype(dtype) if isinstance(dtype, np.dtype) else dtype, ndim, layout)


F1, F2, F3 = (array(types.float64, ndim) for ndim in (1, 2, 3))
BYTES = array(types.uint8, 2)


class BatchState(NamedTuple):
    """The arrays of n environments that a control step reads and writes, with their types, the same in all.

    Two that are not, the patches of the contacts and the force/torque sensors, are passed apart.
    """

    worlds: Annotated[np.ndarray, array(WORLD)]
    """WORLD (n,): bodies and wrist."""
    pads: Annotated[np.ndarray, array(PAD, 2)]
    """PAD (n, 2): friction state."""
    fingers: Annotated[np.ndarray, array(FINGER, 2)]
    """FINGER (n, 2): actuators."""
    slip_sensors: Annotated[np.ndarray, array(SLIP_SENSOR, 2)]
    """SLIP_SENSOR (n, 2): sensors."""
    grippers: Annotated[np.ndarray, array(GRIPPER)]
    """GRIPPER (n,): where sensors are, and the motor."""
    markers: Annotated[np.ndarray, array(MARKERS, 2)]
    """MARKERS (n, 2), or (0, 2) for none."""
    parameters: Annotated[np.ndarray, BYTES]
    """Bytes of the estimators' parameters, (2 n, p), or (1, p) for all."""
    estimator_states: Annotated[np.ndarray, BYTES]
    """Bytes of the estimators' states, (2 n, q)."""
    estimates: Annotated[np.ndarray, array(ESTIMATE)]
    """ESTIMATE (2 n,), finger by finger."""
    episodes: Annotated[np.ndarray, array(EPISODE)]
    """EPISODE (n,): task."""
    commands: Annotated[np.ndarray, F2]
    """Commanded grip force and wrist velocity, (n, 4), see `slipgym.envs.actions.COMMANDS`."""
    wrenches: Annotated[np.ndarray, F3]
    """Measured wrenches at the centre of pressure, (n, 2, 4) [N, N, N, N m]."""
    twists: Annotated[np.ndarray, F3]
    """Measured slip twists at the centre of pressure, (n, 2, 3) [m/s, m/s, rad/s]."""
    per_finger: Annotated[np.ndarray, F3]
    """Estimated mu_s, mu_c, r (n, 2, 3)."""
    estimated: Annotated[np.ndarray, F2]
    """Both fingers' estimates merged: `FRICTION_COLUMNS` and `DEVIATION_COLUMNS` (n, 11)."""
    task_part: Annotated[np.ndarray, F2]
    """The task's part of the observation, (n, k)."""
    ground_truth: Annotated[np.ndarray, F2]
    """True friction now, columns as `estimated`, (n, 11)."""


@pointed
def begin(script_wrist, state, action, lo, hi):
    """Take the actions, apply disturbances and script the wrist, before the bodies move.

    `action` holds actions (n, m), their meaning COMPONENT (m,), and flags (n,) that are not read.
    """
    rows = slice(lo, hi)
    actions, components, _ = action
    interpret(actions[rows], components, state.episodes[rows], state.commands[rows])
    begin_step(state.episodes[rows], state.commands[rows])
    disturb(state.episodes[rows], state.worlds[rows], state.pads[rows], state.ground_truth[rows])
    script_wrist(state.episodes[rows], state.worlds[rows])


@pointed
def measure_rows(state, cells, force_torque, lo, hi):
    """Read the sensors."""
    rows, (state, cells, force_torque) = slice(lo, hi), lent((state, cells, force_torque))
    if state.grippers[lo].usual:
        measure(
            state.worlds[rows], force_torque[rows], state.slip_sensors[rows], state.wrenches[rows],
            state.twists[rows],
        )  # fmt: skip
    else:
        measure_owned(state, cells, force_torque, lo, hi)


@compiled
def learn(update, state, i, time, wrenches, twists):
    """Update both estimators of environment i with wrenches (2, 4) and twists (2, 3) at a time [s].

    An estimator gets its records by their first bytes: its own types do not matter here.
    """
    pair = slice(2 * i, 2 * i + 2)
    own = pair if state.parameters.shape[0] > 1 else slice(0, 1)
    states, parameters = state.estimator_states[pair, 0], state.parameters[own, 0]
    update(states, parameters, time, wrenches, twists, state.estimates[pair])


@pointed
def estimate(update, state, lo, hi):
    """Count the control step, and update the estimators, after `measure_rows`."""
    state = lent(state)
    for i in range(lo, hi):
        state.episodes[i].step += 1
        time = state.episodes[i].step * state.episodes[i].step_time
        learn(update, state, i, time, state.wrenches[i], state.twists[i])


@pointed
def evaluate(evaluate_step, state, lo, hi):
    """Merge the estimates, which are the guess where the agent states none, and evaluate the task."""
    rows, state = slice(lo, hi), lent(state)
    combine(state.estimates[2 * lo : 2 * hi], state.per_finger[rows], state.estimated[rows])
    guess(state.estimated[rows], state.episodes[rows])
    evaluate_step(state.episodes[rows], state.worlds[rows], state.fingers[rows], state.task_part[rows])


@pointed
def look(state, buffers, lo, hi):
    """Write the observations to `ObservationBuffers`."""
    rows = slice(lo, hi)
    wrist, friction, low, high, load, out, sensors = buffers
    marked = rows if state.markers.shape[0] > 0 else slice(0, 0)
    observe(
        state.wrenches[rows], state.twists[rows], state.slip_sensors[rows], state.episodes[rows],
        state.grippers[rows], state.markers[marked], state.task_part[rows], state.worlds[rows], wrist,
        friction[rows], low, high, load, out[rows], sensors,
    )  # fmt: skip


@unlocked
def look_at(look_rows, rows, state, buffers):
    """`look`, passed as a pointer, for some rows (m,) of a `Fixed` `BatchState`."""
    arrays = opened(state)
    for i in rows:
        look_rows(arrays, buffers, i, i + 1)


@pointed
def report(state, numbers, flags, lo, hi):
    """Write the infos to `numbers` and `flags` of an `InfoBuffer`."""
    state = lent(state)
    for i in range(lo, hi):
        write_infos(state, numbers, flags, i)
