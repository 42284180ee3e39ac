"""Final error of the tasks with a reference, trial by trial."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from policies.evaluation.frames import distinct, values, where
from policies.evaluation.plots.style import STYLE, colours, note

_SPREAD = 0.30  # half the height that a friction choice's points take


def plot_errors(trials: pd.DataFrame, unit: str, label: str) -> Figure:
    """A row of points for each friction choice, coloured by material, over the tolerance band.

    Args:
        trials: The table of trials of one policy.
        unit: Unit in the names of the columns, "mm" or "deg".
        label: What the error is.
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
