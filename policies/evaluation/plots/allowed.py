"""Two measures that both have to stay within what is allowed, trial by trial."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from policies.evaluation.frames import distinct, values, where
from policies.evaluation.plots.style import STYLE, note

_GOOD, _BAD = STYLE.palette[0], STYLE.palette[1]


def plot_allowed(trials: pd.DataFrame, across: tuple[str, str], up: tuple[str, str]) -> Figure:
    """A panel for each friction choice: a measure over another, and the box of what is allowed.

    Args:
        trials: The table of trials of one policy.
        across: Column of the measure in mm, and its label.
        up: Column of the measure in degrees, and its label.
    """
    choices = distinct(trials, "friction")
    figure = Figure(figsize=(max(4.0, 2.7 * len(choices)), 3.2))
    panels = figure.subplots(1, len(choices), sharex=True, sharey=True, squeeze=False)[0]
    slide, tilt = (values(trials, f"tolerance_{unit}").max() for unit in ("mm", "deg"))
    for axes, choice in zip(panels, choices, strict=True):
        axes.add_patch(Rectangle((0.0, 0.0), slide, tilt, color=STYLE.band, linewidth=0))
        group = where(trials, friction=choice)
        for success, colour, marker in ((True, _GOOD, "o"), (False, _BAD, "X")):
            some = where(group, success=success)
            axes.scatter(
                values(some, across[0]),
                values(some, up[0]),
                s=18,
                color=colour,
                marker=marker,
                alpha=0.65,
                linewidths=0,
            )
        share = 100.0 * values(group, "success").mean()
        note(axes, 0.03, 0.04, f"success {share:.0f} %", _GOOD, xycoords="axes fraction")
        axes.set_title(f"friction: {choice}")
    panels[0].set_xlim(0.0, 1.1 * max(slide, values(trials, across[0]).max()))
    panels[0].set_ylim(0.0, 1.1 * max(tilt, values(trials, up[0]).max()))
    panels[0].set_ylabel(up[1])
    note(panels[0], slide, tilt, "allowed ", STYLE.muted, ha="right", va="bottom")
    figure.supxlabel(across[1], fontsize=9.0)
    return figure
