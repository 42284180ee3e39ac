"""Columns of the table of trials, and measures of a task that only names its motion."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from policies.evaluation.recording import Recording
from slipgym.tasks import Task
from slipgym.tasks.motion import Motion


class Metric(NamedTuple):
    """A column of the table of trials that the summary reports."""

    column: str
    """Its name in the table."""
    heading: str
    """Its heading in the summary, with the unit."""
    share: bool = False
    """Whether it is yes or no; else a quantity with a mean."""
    brief: bool = False
    """Whether the compact table on the terminal has it."""


class Tolerance(NamedTuple):
    """An option of the task, its column in the table of trials and the factor to the unit of the table."""

    option: str
    column: str
    scale: float


class Measures(NamedTuple):
    """Measures of the trials of a task."""

    measure: Callable[[Recording], dict[str, Any]]
    """The task's own columns."""
    tolerances: tuple[Tolerance, ...]
    """What the trials' figures are held against."""
    summary: tuple[Metric, ...]
    """What the summary reports."""
    compared: Metric
    """What paired trials are compared by."""


OUTCOME = (
    Metric("success", "success [%]", share=True, brief=True),
    Metric("dropped", "dropped [%]", share=True),
)
FORCE = Metric("mean_force_N", "grip force [N]", brief=True)
ROTATION = Metric("max_rotation_deg", "largest rotation [°]")
SLIP = Metric("largest_slip_mm", "largest slip [mm]", brief=True)


_UNITS = {"m": ("mm", "mm", 1e3), "rad": ("deg", "°", math.degrees(1.0))}  # in columns, in words, factor


def measures_by_motion(task: Task) -> Measures:
    """Final and rms error where the motion has a reference, and the largest slip.

    The tolerances are the task's options that end in "tolerance" and are in [m] or [rad].
    """
    motion = task.motion
    measure = partial(measure_motion, motion=motion)
    if motion.axis is None:
        return Measures(measure, _tolerances(task), (*OUTCOME, SLIP, ROTATION, FORCE), FORCE)
    errors = tracking(motion.unit)
    return Measures(measure, _tolerances(task), (*OUTCOME, *errors, SLIP, FORCE), errors[1])


def tracking(unit: str) -> tuple[Metric, ...]:
    """Final error, its size and the rms error of a motion in [m] or [rad]."""
    unit, word, _ = _UNITS[unit]
    names = {"final_error": "final error, signed", "final_error_abs": "final error, size"}
    names |= {"rms_error": "rms tracking error"}
    return tuple(Metric(f"{name}_{unit}", f"{words} [{word}]", brief=True) for name, words in names.items())


def measure_motion(recording: Recording, motion: Motion) -> dict[str, Any]:
    """Slip of the object, and error of its motion where it has a reference."""
    row = {"largest_slip_mm": largest_slip(recording)}
    if motion.axis is None:
        return row
    error = motion.path(recording.slip) - motion.target(recording.reference[:, 0])
    unit = _UNITS[motion.unit][0]
    return {**final_error(error[-1].item(), unit), f"rms_error_{unit}": math.sqrt(np.mean(error**2)), **row}


def final_error(error: float, unit: str) -> dict[str, float]:
    """An error at the end and its size, in the columns of a unit."""
    return {f"final_error_{unit}": error, f"final_error_abs_{unit}": abs(error)}


def largest_slip(recording: Recording) -> float:
    """Largest distance from the grasp [mm]."""
    return 1e3 * np.hypot(recording.slip[:, 0], recording.slip[:, 1]).max().item()


def _tolerances(task: Task) -> tuple[Tolerance, ...]:
    found = []
    for name, field in task.options.model_fields.items():
        unit = _UNITS.get((field.description or "").rpartition("[")[2].rstrip("]"))
        if name.endswith("tolerance") and unit is not None:
            found.append(Tolerance(name, f"{name}_{unit[0]}", unit[2]))
    return tuple(found)
