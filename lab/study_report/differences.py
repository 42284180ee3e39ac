"""Plots what the estimate recovers, and what the change of engine costs."""

from __future__ import annotations

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from lab.study_report.marks import dot, panels, stripes
from policies.evaluation.frames import distinct, records, where
from policies.evaluation.plots.style import STYLE, note
from policies.study.tables import ENOUGH

TRANSFER_MOST = 3.0
"""Points of success that PyBullet may cost against the planar engine."""
_NAMES = {"success": "of the episodes solved", "return": "of the return"}
_KINDS = {"classic": (STYLE.palette[0], -0.17), "learned": (STYLE.palette[3], 0.17)}
_SPAN = (-50.0, 200.0)


def plot_shares(shares: pd.DataFrame) -> Figure:
    """(estimated - none) / (true - none), a row for each task; what leaves the axis is cut at its end.

    Args:
        shares: Of one world and preset.
    """
    tasks, figures = distinct(shares, "task"), distinct(shares, "figure")
    figure, columns = panels([_NAMES[name] for name in figures], len(tasks), 0.5)
    ends = ["share", "share_low", "share_high"]
    for axes, name in zip(columns, figures, strict=True):
        stripes(axes, len(tasks))
        axes.axvline(100.0 * ENOUGH, color=STYLE.palette[2], linestyle="--", linewidth=1.0)
        for row in records(where(shares, figure=name)):
            colour, shift = _KINDS[row["kind"]]
            height = tasks.index(row["task"]) + shift
            if row["share"] != row["share"]:
                words = f"{row['kind']}: {row['verdict']}"
                note(axes, _SPAN[0] + 4.0, height, words, STYLE.muted, va="center", fontsize=7.0)
                continue
            cut = {end: min(max(row[end], _SPAN[0] / 100.0), _SPAN[1] / 100.0) for end in ends}
            dot(axes, cut, "share", height, colour, 100.0)
        axes.set_xlim(*_SPAN)
        axes.set_xlabel("(estimated − none) / (true − none) [%]")
    columns[0].set_yticks(range(len(tasks)), tasks)
    _legend(figure, shares)
    return figure


def plot_transfer(transfer: pd.DataFrame) -> Figure:
    """Success on PyBullet less that on the planar engine, a row for each task, a column for each preset."""
    tasks = distinct(transfer, "task")
    figure, columns = panels(distinct(transfer, "preset"), len(tasks), 0.5)
    for axes in columns:
        stripes(axes, len(tasks))
        axes.axvline(0.0, color=STYLE.muted, linewidth=0.8)
        axes.axvline(-TRANSFER_MOST, color=STYLE.palette[1], linestyle="--", linewidth=1.0)
        for row in records(where(transfer, preset=axes.get_title(loc="left"))):
            colour, shift = _KINDS[row["kind"]]
            dot(axes, row, "difference", tasks.index(row["task"]) + shift, colour)
        _at_least(axes, 2.0 * TRANSFER_MOST)
        axes.set_xlabel("solved on PyBullet less on the planar engine [points]")
    columns[0].set_yticks(range(len(tasks)), tasks)
    _legend(figure, transfer)
    return figure


def _at_least(axes: Axes, half: float) -> None:
    """An axis that is symmetric about 0 and not narrower than this."""
    most = max(half, *(abs(end) for end in axes.get_xlim()))
    axes.set_xlim(-most, most)


def _legend(figure: Figure, table: pd.DataFrame) -> None:
    kinds = distinct(table, "kind")
    handles = [Line2D([], [], color=_KINDS[kind][0], marker="o", linewidth=2.2) for kind in kinds]
    figure.legend(handles, kinds, loc="outside upper right", ncols=len(kinds))
