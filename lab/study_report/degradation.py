"""Plots how success falls as one thing gets worse."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from lab.study_report.marks import COLOURS
from policies.evaluation.frames import distinct, values, where
from policies.evaluation.plots.style import STYLE
from policies.study.conditions import TITLES
from policies.study.config import SOURCES

_LABELS = {
    "noise_scale": "sensor noise [times]",
    "slip_latency": "velocity's age [samples]",
    "friction_jump": "friction after / before",
}

_APART = 0.022  # sources, over the span of the levels


def plot_degradation(outcomes: pd.DataFrame) -> Figure:
    """A row for each task, a column for each change, a line for each source.

    Args:
        outcomes: Of one kind of policy, with changes only.
    """
    tasks = distinct(outcomes, "task")
    names = [name for name in TITLES if name in distinct(outcomes, "change")]
    figure = Figure(figsize=(8.6, 0.8 + 1.35 * len(tasks)))
    grid = figure.subplots(len(tasks), len(names), sharey=True, sharex="col", squeeze=False)
    for row, task in zip(grid, tasks, strict=True):
        for axes, name in zip(row, names, strict=True):
            _lines(axes, where(outcomes, task=task, change=name), falls=name == "friction_jump")
        row[0].set_ylabel(f"{task}\nsolved [%]")
    for axes, name in zip(grid[-1], names, strict=True):
        axes.set_xlabel(_LABELS[name])
    sources = [source for source in SOURCES if source in distinct(outcomes, "source")]
    handles = [Line2D([], [], color=COLOURS[source], marker="o") for source in sources]
    figure.legend(handles, sources, loc="outside upper right", ncols=len(sources))
    return figure


def _lines(axes: Axes, outcomes: pd.DataFrame, falls: bool) -> None:
    """A line for each source, side by side where they agree."""
    sources, span = distinct(outcomes, "source"), np.ptp(values(outcomes, "level"))
    for k, source in enumerate(sources):
        line = where(outcomes, source=source).sort_values("level")
        level = values(line, "level") + _APART * span * (k - (len(sources) - 1) / 2.0)
        solved, low, high = (
            100.0 * values(line, name) for name in ("success", "success_low", "success_high")
        )
        colour = COLOURS[source]
        axes.vlines(level, low, high, color=colour, linewidth=2.0, alpha=0.4)
        axes.plot(level, solved, "o-", color=colour, markersize=3.5, linewidth=1.0, clip_on=False, zorder=3)
    axes.set_ylim(0.0, 100.0)
    axes.grid(color=STYLE.band, linewidth=0.8)
    axes.xaxis.set_inverted(falls)
