"""Two measures that both have to stay within what is allowed, trial by trial."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from policies.evaluation.frames import distinct, values, where
from policies.evaluation.plots.style import STYLE, note

_GOOD, _BAD = STYLE.palette[0], STYLE.palette[1]
_FARTHEST = 4.0
"""End of an axis, in what is allowed; what lies beyond is drawn there."""


class Limited(NamedTuple):
    """A measure that has to stay within what is allowed."""

    column: str
    """Its column in the table of trials."""
    label: str
    """Its label."""
    allowed: str | float
    """What is allowed: a column, or a number."""

    def most(self, trials: pd.DataFrame) -> float:
        """Largest allowed value in the trials."""
        return float(values(trials, self.allowed).max()) if isinstance(self.allowed, str) else self.allowed


def plot_allowed(trials: pd.DataFrame, across: Limited, up: Limited) -> Figure:
    """A panel for each friction choice: a measure over another, and the box of what is allowed.

    Trials beyond `_FARTHEST` times what is allowed are drawn at the edge.

    Args:
        trials: The table of trials of one policy.
        across: Measure along the horizontal axis.
        up: Measure along the vertical axis.
    """
    choices = distinct(trials, "friction")
    figure = Figure(figsize=(max(4.0, 2.7 * len(choices)), 3.2))
    panels = figure.subplots(1, len(choices), sharex=True, sharey=True, squeeze=False)[0]
    width, height = across.most(trials), up.most(trials)
    ends = _end(trials, across.column, width), _end(trials, up.column, height)
    for axes, choice in zip(panels, choices, strict=True):
        axes.add_patch(Rectangle((0.0, 0.0), width, height, color=STYLE.band, linewidth=0))
        group = where(trials, friction=choice)
        for success, colour, marker in ((True, _GOOD, "o"), (False, _BAD, "X")):
            some = where(group, success=success)
            axes.scatter(
                np.minimum(values(some, across.column), ends[0]),
                np.minimum(values(some, up.column), ends[1]),
                s=18,
                clip_on=False,
                color=colour,
                marker=marker,
                alpha=0.65,
                linewidths=0,
            )
        share = 100.0 * values(group, "success").mean()
        note(
            axes, 0.97, 0.94, f"success {share:.0f} %", _GOOD, xycoords="axes fraction", ha="right", va="top"
        )
        axes.set_title(f"friction: {choice}")
    panels[0].set_xlim(0.0, ends[0])
    panels[0].set_ylim(0.0, ends[1])
    panels[0].set_ylabel(up.label)
    note(panels[0], width, height, "allowed ", STYLE.muted, ha="right", va="bottom")
    beyond = values(trials, across.column).max() > ends[0] or values(trials, up.column).max() > ends[1]
    figure.supxlabel(across.label + ("; at the edge: beyond" if beyond else ""), fontsize=9.0)
    return figure


def _end(trials: pd.DataFrame, column: str, allowed: float) -> float:
    """End of an axis: all trials, or `_FARTHEST` times what is allowed."""
    return max(1.1 * allowed, min(1.1 * float(values(trials, column).max()), _FARTHEST * allowed))
