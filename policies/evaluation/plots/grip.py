"""Grip force of Hold against the least that could have done."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure

from policies.evaluation.plots.style import STYLE, note


def plot_grip(trials: pd.DataFrame) -> Figure:
    """A panel for each friction choice: mean grip force over the largest force that the load needed.

    Args:
        trials: The table of trials of one policy.
    """
    choices = list(trials["friction"].unique())
    figure = Figure(figsize=(max(4.0, 2.7 * len(choices)), 3.4))
    panels = figure.subplots(1, len(choices), sharex=True, sharey=True, squeeze=False)[0]
    right = 1.05 * trials["needed_force_peak_N"].max()
    top = 1.05 * max(right, trials["mean_force_N"].max())
    for axes, choice in zip(panels, choices, strict=True):
        group = trials[trials["friction"] == choice]
        axes.plot([0.0, right], [0.0, right], color=STYLE.muted, linewidth=0.8)
        for success, colour, marker in ((True, STYLE.palette[0], "o"), (False, STYLE.palette[1], "X")):
            some = group[group["success"] == success]
            axes.scatter(some["needed_force_peak_N"], some["mean_force_N"], s=18, c=colour, marker=marker,
                         alpha=0.65, linewidths=0)  # fmt: skip
        share = 100.0 * group["success"].mean()
        axes.set_title(choice)
        note(axes, 0.03, 0.97, f"held {share:.0f} %", STYLE.palette[0], xycoords="axes fraction", va="top")
        if share < 100.0:
            note(axes, 0.03, 0.90, f"slipped {100.0 - share:.0f} %", STYLE.palette[1],
                 xycoords="axes fraction", va="top")  # fmt: skip
        axes.set_xlim(0.0, right)
        axes.set_ylim(0.0, top)
    panels[0].set_ylabel("grip force, mean [N]")
    note(panels[0], right, right, "just enough ", STYLE.muted, ha="right", va="bottom")
    figure.supxlabel("least force that holds the peak load [N]", fontsize=9.0)
    return figure
