"""Figures of an experiment."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from policies.evaluation.frames import groups, values
from policies.evaluation.gain import Gain
from policies.evaluation.plots.allowed import Limited, plot_allowed
from policies.evaluation.plots.errors import plot_errors
from policies.evaluation.plots.gain import plot_gain
from policies.evaluation.plots.grip import plot_grip
from policies.evaluation.plots.style import STYLE, styled
from policies.evaluation.plots.tracking import plot_tracking
from slipgym.tasks import Task, find

_OUTCOME: dict[str, tuple[str, Callable[[pd.DataFrame], Figure]]] = {
    "LinearSlip": (
        "errors",
        partial(plot_errors, unit="mm", label="final error of the slip [mm]; negative: too short"),
    ),
    "RotationalSlip": (
        "errors",
        partial(plot_errors, unit="deg", label="final error of the turn [°]; negative: too short"),
    ),
    "Hinge": (
        "outcome",
        partial(
            plot_allowed,
            across=Limited("largest_slip_mm", "largest slip [mm]", "tolerance_mm"),
            up=Limited("largest_tilt_deg", "largest tilt [°]", "tolerance_deg"),
        ),
    ),
    "PlanarSlip": (
        "outcome",
        partial(
            plot_allowed,
            across=Limited("final_error_mm", "final distance to the target [mm]", "tolerance_mm"),
            up=Limited("final_error_abs_deg", "final error in theta, size [°]", "tolerance_deg"),
        ),
    ),
    "Hold": ("grip", plot_grip),
    "FragileHold": (
        "outcome",
        partial(
            plot_allowed,
            across=Limited("largest_slip_mm", "largest slip [mm]", "tolerance_mm"),
            up=Limited("peak_force_ratio", "largest grip / breaking force", 1.0),
        ),
    ),
    "PivotTo": (
        "outcome",
        partial(
            plot_allowed,
            across=Limited("largest_slip_mm", "largest slip [mm]", "tolerance_mm"),
            up=Limited("final_error_abs_deg", "final error of the angle, size [°]", "tolerance_deg"),
        ),
    ),
}
"""Task -> name and figure of how its trials ended, where it is not the final error alone."""


def draw(task: str, trials: pd.DataFrame, series: pd.DataFrame, folder: Path) -> list[Path]:
    """Draws the figures of a task, each policy on its own.

    Args:
        task: The task.
        trials: The table of trials.
        series: Steps of the first trials; its column "row" is the row in the table of trials.
        folder: Where the pictures go.

    Returns:
        The pictures.
    """
    written = []
    for (policy,), group in groups(trials, ["policy"]):
        slug = "".join(c if c.isalnum() else "_" for c in policy)
        with styled():
            figures = {f"tracking_{slug}": plot_tracking(task, group, series)}
            for name, plot in _outcome(find(task), group):
                figures[f"{name}_{slug}"] = plot(group)
            written += [_save(figure, folder / f"{name}.png") for name, figure in figures.items()]
    return written


def draw_gain(
    task: str, trials: pd.DataFrame, gain: Gain, episode: Sequence[Mapping[str, np.ndarray]], folder: Path
) -> Path:
    """Draws `gain.png`; arguments as for `draw` and `plot_gain`."""
    has_limit = find(task).motion.axis is None and "tolerance_mm" in trials
    tolerance = float(values(trials, "tolerance_mm").max()) if has_limit else math.nan
    with styled():
        return _save(plot_gain(task, gain, episode, tolerance), folder / "gain.png")


def _outcome(task: Task, trials: pd.DataFrame) -> list[tuple[str, Callable[[pd.DataFrame], Figure]]]:
    """The task's own figure; else the final errors, if there are errors and a tolerance."""
    if task.name in _OUTCOME:
        return [_OUTCOME[task.name]]
    unit = "mm" if task.motion.unit == "m" else "deg"
    if not {f"final_error_{unit}", f"tolerance_{unit}"} <= set(trials):
        return []
    return [("errors", partial(plot_errors, unit=unit, label=f"final error: {task.motion.title}"))]


def _save(figure: Figure, path: Path) -> Path:
    figure.savefig(path, dpi=STYLE.dpi)
    return path
