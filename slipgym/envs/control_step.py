"""The stages of a control step of many environments: act, move, measure, estimate, evaluate.

Functions that differ between tasks and estimators are called through function pointers, so that one compiled
function serves all of them. `BulletSimulation` goes through the same stages, with PyBullet's in the middle.
"""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numba import from_dtype, types

from estimator.estimate import ESTIMATE
from slipgym._numba.compiled import unlocked
from slipgym._numba.pointers import Known, Pointer
from slipgym.contact.records import PAD
from slipgym.envs.observation import combine
from slipgym.sensors.measure import measure
from slipgym.sensors.slip_velocity import SLIP_SENSOR
from slipgym.tasks.disturbance import disturb
from slipgym.tasks.episode import EPISODE, begin_step
from slipgym.world.records import FINGER, WORLD


class BatchState(NamedTuple):
    """The arrays of n environments that a control step reads and writes."""

    worlds: np.ndarray
    """WORLD (n,): bodies and wrist."""
    pads: np.ndarray
    """PAD (n, 2): friction state."""
    cells: np.ndarray | None
    """Patches (n, 2, CELL_FIELDS, m) of distributed contacts; None for ellipsoids."""
    fingers: np.ndarray
    """FINGER (n, 2): actuators."""
    force_torque: np.ndarray
    """FORCE_TORQUE (n, 2): sensors."""
    slip_sensors: np.ndarray
    """SLIP_SENSOR (n, 2): sensors."""
    parameters: np.ndarray
    """Parameters of the estimators, (2 n,), or (1,) for all."""
    estimator_states: np.ndarray
    """States of the estimators, (2 n,)."""
    estimates: np.ndarray
    """ESTIMATE (2 n,), finger by finger."""
    episodes: np.ndarray
    """EPISODE (n,): task."""
    commands: np.ndarray
    """Commanded grip force and wrist velocity, (n, 4), see `slipgym.envs.actions.COMMANDS`."""
    wrenches: np.ndarray
    """Measured wrenches at the centre of pressure, (n, 2, 4) [N, N, N, N m]."""
    twists: np.ndarray
    """Measured slip twists at the centre of pressure, (n, 2, 3) [m/s, m/s, rad/s]."""
    per_finger: np.ndarray
    """Estimated mu_s, mu_c, r (n, 2, 3)."""
    estimated: np.ndarray
    """Both fingers' estimates merged: `FRICTION_COLUMNS` (n, 6)."""
    task_part: np.ndarray
    """The task's part of the observation, (n, k)."""
    ground_truth: np.ndarray
    """True friction now, columns as `estimated`, (n, 6)."""


@unlocked
def begin_control_step(script_wrist, state, lo, hi):
    """Take the commands, apply disturbances and script the wrist of rows lo to hi, before the bodies move.

    Args:
        script_wrist: Function of the task.
        state: `BatchState`.
        lo: First row.
        hi: Row after the last.
    """
    rows = slice(lo, hi)
    begin_step(state.episodes[rows], state.commands[rows])
    disturb(state.episodes[rows], state.worlds[rows], state.pads[rows], state.ground_truth[rows])
    script_wrist(state.episodes[rows], state.worlds[rows])


@unlocked
def measure_rows(state, lo, hi):
    """Read the sensors of rows lo to hi.

    Args:
        state: `BatchState`.
        lo: First row.
        hi: Row after the last.
    """
    rows = slice(lo, hi)
    measure(
        state.worlds[rows], state.force_torque[rows], state.slip_sensors[rows], state.wrenches[rows],
        state.twists[rows],
    )  # fmt: skip


@unlocked
def end_control_step(update, evaluate_step, state, lo, hi):
    """Measure, update the estimators and evaluate the task in rows lo to hi, after the bodies have moved.

    Args:
        update: Function of the estimator.
        evaluate_step: Function of the task.
        state: `BatchState`.
        lo: First row.
        hi: Row after the last.
    """
    measure_rows(state, lo, hi)
    for i in range(lo, hi):
        state.episodes[i].step += 1
        pair = slice(2 * i, 2 * i + 2)
        own = state.parameters[pair] if state.parameters.shape[0] > 1 else state.parameters
        time = state.episodes[i].step * state.episodes[i].step_time
        update(
            state.estimator_states[pair], own, time, state.wrenches[i], state.twists[i], state.estimates[pair]
        )
    evaluate(evaluate_step, state, lo, hi)


@unlocked
def evaluate(evaluate_step, state, lo, hi):
    """Merge the estimates and evaluate the task in rows lo to hi.

    Args:
        evaluate_step: Function of the task.
        state: `BatchState`.
        lo: First row.
        hi: Row after the last.
    """
    rows = slice(lo, hi)
    combine(state.estimates[2 * lo : 2 * hi], state.per_finger[rows], state.estimated[rows])
    evaluate_step(state.episodes[rows], state.worlds[rows], state.fingers[rows], state.task_part[rows])


def array(dtype: Any, ndim: int = 1) -> Any:
    """Type of a contiguous array of numbers or records."""
    return types.Array(from_dtype(dtype) if isinstance(dtype, np.dtype) else dtype, ndim, "C")


class Kernels:
    """Types and pointers of a task's and an estimator's compiled functions.

    Args:
        task: The task.
        update: The estimator's compiled `update_batch`.
        states: Dtype of its state.
        parameters: Dtype of its parameters.
        force_torque: Dtype of the force/torque sensors.
        cells: Dimensions of `slipgym.world.plant.Plant.cells`, 0 for None.

    Attributes:
        state: Type of `BatchState`.
        fresh: Types of the estimators' states and estimates.
        script_wrist: Type of the task's function; `evaluate_step` and `update` likewise.
    """

    def __init__(
        self,
        task: Any,
        update: Any,
        states: np.dtype,
        parameters: np.dtype,
        force_torque: np.dtype,
        cells: int,
    ) -> None:
        self._task, self._update = task, update
        episodes, worlds, fingers = array(EPISODE), array(WORLD), array(FINGER, 2)
        f2, f3 = array(types.float64, 2), array(types.float64, 3)
        estimator_states, estimates = array(states), array(ESTIMATE)
        fields = {
            "worlds": worlds,
            "pads": array(PAD, 2),
            "cells": array(types.float64, cells) if cells else types.none,
            "fingers": fingers,
            "force_torque": array(force_torque, 2),
            "slip_sensors": array(SLIP_SENSOR, 2),
            "parameters": array(parameters),
            "estimator_states": estimator_states,
            "estimates": estimates,
            "episodes": episodes,
            "commands": f2,
            "wrenches": f3,
            "twists": f3,
            "per_finger": f3,
            "estimated": f2,
            "task_part": f2,
            "ground_truth": f2,
        }
        self.state = types.NamedTuple([fields[name] for name in BatchState._fields], BatchState)
        self.fresh = estimator_states, estimates
        self._signatures = {
            "script_wrist": types.void(episodes, worlds),
            "evaluate_step": types.void(episodes, worlds, fingers, f2),
            "update": types.void(estimator_states, array(parameters), types.float64, f2, f2, estimates),
        }
        self.script_wrist, self.evaluate_step, self.update = map(Known, self._signatures.values())

    def pointers(self) -> dict[str, Pointer]:
        """Compiles the functions; their pointers by name."""
        functions = {
            "script_wrist": self._task.script_wrist,
            "evaluate_step": self._task.evaluate_step,
            "update": self._update,
        }
        for name in ("script_wrist", "evaluate_step"):
            functions[name].compile(self._signatures[name])
        return {name: Pointer(functions[name], self._signatures[name]) for name in functions}


def entry_point(function: Any, signature: Any, *pointers: Pointer) -> Any:
    """Compiles a function; returns it without its first arguments, called without numba's dispatch.

    Numba's dispatch looks at the type of every array at every call, which takes tens of microseconds for a
    `BatchState`.
    """
    function.compile(signature)
    return partial(function.overloads[signature.args].entry_point, *pointers)
