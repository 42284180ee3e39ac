"""Draws how trials ended: beside their tolerance, within what is allowed, or with how firm a grip."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from policies.evaluation.frames import distinct, values, where
from policies.evaluation.plots.style import STYLE, colours, note
from slipgym.tasks import Task

_SPREAD = 0.30  # half the height that a friction choice's points take
_GOOD, _BAD = STYLE.palette[0], STYLE.palette[1]
_FARTHEST = 4.0
"""End of an axis, in what is allowed; what lies beyond is drawn there."""


def outcome(task: Task, trials: pd.DataFrame) -> dict[str, Figure]:
    """The task's own figure of one policy's trials by its name; else errors, where there is a tolerance."""
    if task.name == "Hold":
        return {"grip": plot_grip(trials)}
    if task.name in _BOXES:
        return {"outcome": plot_allowed(trials, *_BOXES[task.name])}
    unit = "mm" if task.motion.unit == "m" else "deg"
    if not {f"final_error_{unit}", f"tolerance_{unit}"} <= set(trials):
        return {}
    sign = "" if task.motion.axis is None else "; negative: too short"
    return {"errors": plot_errors(trials, unit, f"final error: {task.motion.title}{sign}")}


def plot_errors(trials: pd.DataFrame, unit: str, label: str) -> Figure:
    """A row of points for each friction choice of a policy, coloured by material, over the tolerance band.

    The unit is that in the names of the columns, "mm" or "deg"; the label says what the error is.
    """
    choices = distinct(trials, "friction")
    materials = colours(distinct(trials, "material"))
    figure = Figure(figsize=(7.5, 1.2 + 0.75 * len(choices)))
    axes = figure.subplots()
    tolerance = values(trials, f"tolerance_{unit}").max()
    axes.axvspan(-tolerance, tolerance, color=STYLE.band, linewidth=0, zorder=0)
    axes.axvline(0.0, color=STYLE.muted, linewidth=0.8, zorder=1)
    for at, choice in enumerate(choices):
        group = where(trials, friction=choice)
        for k, (material, colour) in enumerate(materials.items()):
            errors = values(where(group, material=material), f"final_error_{unit}")
            lane = at + _SPREAD * ((k + 0.5) / len(materials) * 2.0 - 1.0)
            axes.scatter(errors, np.full(len(errors), lane), s=14, color=colour, alpha=0.6, linewidths=0)
        median = np.median(values(group, f"final_error_{unit}"))
        axes.plot([median, median], [at - _SPREAD, at + _SPREAD], color=STYLE.ink, linewidth=2.0)
    for material, colour in materials.items():
        axes.scatter([], [], s=24, color=colour, label=material)
    axes.plot([], [], color=STYLE.ink, linewidth=2.0, label="median")
    axes.legend(ncols=len(materials) + 1, loc="lower left", bbox_to_anchor=(0.0, 1.0), handletextpad=0.2)
    note(axes, tolerance, -0.55, " tolerance", STYLE.muted, va="center")
    axes.set_yticks(range(len(choices)), choices)
    axes.tick_params(axis="y", length=0)
    axes.set_ylim(len(choices) - 0.5, -0.7)
    axes.spines["left"].set_visible(False)
    axes.set_xlabel(label)
    return figure


class Limited(NamedTuple):
    """A column of the table of trials, its label, and what is allowed: a column too, or a number."""

    column: str
    label: str
    allowed: str | float

    def ends(self, trials: pd.DataFrame) -> tuple[float, float]:
        """Largest allowed value, and the end of an axis: all trials, or `_FARTHEST` times what is allowed."""
        most = float(values(trials, self.allowed).max()) if isinstance(self.allowed, str) else self.allowed
        return most, max(1.1 * most, min(1.1 * float(values(trials, self.column).max()), _FARTHEST * most))


def plot_allowed(trials: pd.DataFrame, across: Limited, up: Limited) -> Figure:
    """A panel for each friction choice of a policy: a measure over another, and the box of what is allowed.

    Trials beyond `_FARTHEST` times what is allowed are drawn at the edge.
    """
    (width, right), (height, top) = across.ends(trials), up.ends(trials)
    figure, panels = _panels(trials, 3.2)
    corner = {"xycoords": "axes fraction", "ha": "right", "va": "top"}
    for axes, group in panels:
        axes.add_patch(Rectangle((0.0, 0.0), width, height, color=STYLE.band, linewidth=0))
        _points(axes, group, across.column, up.column, right, top)
        note(axes, 0.97, 0.94, f"success {100.0 * values(group, 'success').mean():.0f} %", _GOOD, **corner)
    first = panels[0][0]
    first.set(xlim=(0.0, right), ylim=(0.0, top), ylabel=up.label)
    note(first, width, height, "allowed ", STYLE.muted, ha="right", va="bottom")
    beyond = values(trials, across.column).max() > right or values(trials, up.column).max() > top
    figure.supxlabel(across.label + ("; at the edge: beyond" if beyond else ""), fontsize=9.0)
    return figure


def plot_grip(trials: pd.DataFrame) -> Figure:
    """A panel for each friction choice: mean grip force over the largest force that the load needed."""
    right, most = (values(trials, name).max() for name in ("needed_force_peak_N", "mean_force_N"))
    right *= 1.05
    figure, panels = _panels(trials, 3.4)
    at = {"xycoords": "axes fraction", "va": "top"}
    for axes, group in panels:
        axes.plot([0.0, right], [0.0, right], color=STYLE.muted, linewidth=0.8)
        _points(axes, group, "needed_force_peak_N", "mean_force_N")
        held = 100.0 * values(group, "success").mean()
        note(axes, 0.03, 0.98, f"held {held:.0f} %", _GOOD, **at)
        if held < 100.0:
            note(axes, 0.03, 0.91, f"slipped {100.0 - held:.0f} %", _BAD, **at)
    first = panels[0][0]
    first.set(xlim=(0.0, right), ylim=(0.0, 1.12 * max(right, most)), ylabel="grip force, mean [N]")
    note(first, right, 0.05 * right, "below the line:\nless than the peak needs", STYLE.muted, ha="right")
    figure.supxlabel("least force that holds the peak load [N]", fontsize=9.0)
    return figure


def _panels(trials: pd.DataFrame, height: float) -> tuple[Figure, list[tuple[Axes, pd.DataFrame]]]:
    """A panel for each friction choice with its trials, all with the same axes; the height is in inches."""
    choices = distinct(trials, "friction")
    figure = Figure(figsize=(max(4.0, 2.7 * len(choices)), height))
    panels = figure.subplots(1, len(choices), sharex=True, sharey=True, squeeze=False)[0]
    for axes, choice in zip(panels, choices, strict=True):
        axes.set_title(f"friction: {choice}")
    return figure, [(axes, where(trials, friction=name)) for axes, name in zip(panels, choices, strict=True)]


def _points(
    axes: Axes, trials: pd.DataFrame, across: str, up: str, right: float = np.inf, top: float = np.inf
) -> None:
    """A point for each trial, a cross for each that failed; what lies beyond the ends is drawn there."""
    for success, colour, marker in ((True, _GOOD, "o"), (False, _BAD, "X")):
        some = where(trials, success=success)
        x, y = np.minimum(values(some, across), right), np.minimum(values(some, up), top)
        axes.scatter(x, y, s=18, clip_on=False, color=colour, marker=marker, alpha=0.65, linewidths=0)


_SLIP = Limited("largest_slip_mm", "largest slip [mm]", "tolerance_mm")
_BOXES = {
    "Hinge": (_SLIP, Limited("largest_tilt_deg", "largest tilt [°]", "tolerance_deg")),
    "PlanarSlip": (
        Limited("final_error_mm", "final distance to the target [mm]", "tolerance_mm"),
        Limited("final_error_abs_deg", "final error in theta, size [°]", "tolerance_deg"),
    ),
    "FragileHold": (_SLIP, Limited("peak_force_ratio", "largest grip / breaking force", 1.0)),
    "PivotTo": (_SLIP, Limited("final_error_abs_deg", "final error of the angle, size [°]", "tolerance_deg")),
}
"""Task -> the two measures of its trials that have limits, where it is not the final error alone."""
