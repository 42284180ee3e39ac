"""Grip force of Hold against the least that could have done."""

from __future__ import annotations

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from policies.evaluation.frames import distinct, values, where
from policies.evaluation.plots.style import STYLE, note

_HELD, _SLIPPED = STYLE.palette[0], STYLE.palette[1]


def plot_grip(trials: pd.DataFrame) -> Figure:
    """A panel for each friction choice: mean grip force over the largest force that the load needed.

    Args:
        trials: The table of trials of one policy.
    """
    choices = distinct(trials, "friction")
    figure = Figure(figsize=(max(4.0, 2.7 * len(choices)), 3.4))
    panels = figure.subplots(1, len(choices), sharex=True, sharey=True, squeeze=False)[0]
    right = 1.05 * values(trials, "needed_force_peak_N").max()
    for axes, choice in zip(panels, choices, strict=True):
        axes.plot([0.0, right], [0.0, right], color=STYLE.muted, linewidth=0.8)
        _points(axes, where(trials, friction=choice))
        axes.set_title(f"friction: {choice}")
        axes.set_xlim(0.0, right)
        axes.set_ylim(0.0, 1.12 * max(right, values(trials, "mean_force_N").max()))
    panels[0].set_ylabel("grip force, mean [N]")
    note(panels[0], right, 0.05 * right, "below the line:\nless than the peak needs", STYLE.muted, ha="right")
    figure.supxlabel("least force that holds the peak load [N]", fontsize=9.0)
    return figure


def _points(axes: Axes, trials: pd.DataFrame) -> None:
    """A point for each trial, and how many held."""
    shares = {}
    for success, colour, marker in ((True, _HELD, "o"), (False, _SLIPPED, "X")):
        some = where(trials, success=success)
        needed, force = values(some, "needed_force_peak_N"), values(some, "mean_force_N")
        axes.scatter(needed, force, s=18, color=colour, marker=marker, alpha=0.65, linewidths=0)
        shares[success] = 100.0 * len(some) / len(trials)
    at = {"xycoords": "axes fraction", "va": "top"}
    note(axes, 0.03, 0.98, f"held {shares[True]:.0f} %", _HELD, **at)
    if shares[False]:
        note(axes, 0.03, 0.91, f"slipped {shares[False]:.0f} %", _SLIPPED, **at)
