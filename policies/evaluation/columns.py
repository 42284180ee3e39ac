"""Columns of the table of trials, and which of them a task's summary reports."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from policies.evaluation.recording import Recording


@dataclass(frozen=True)
class Metric:
    """A column of the table of trials that the summary reports."""

    column: str
    """Its name in the table."""
    heading: str
    """Its heading in the summary, with the unit."""
    share: bool = False
    """Whether it is yes or no; else a quantity with a mean."""
    brief: bool = False
    """Whether the compact table on the terminal has it."""


@dataclass(frozen=True)
class Tolerance:
    """A tolerance of the task in the unit of the table of trials."""

    option: str
    """Its name among the task's options."""
    column: str
    """Its name in the table."""
    scale: float
    """From the option's unit to the table's."""


@dataclass(frozen=True)
class Measures:
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
