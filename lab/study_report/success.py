"""Plots the success rate by friction information."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from lab.frames import among
from lab.study_report.marks import COLOURS, dot, panels, stripes
from policies.evaluation.frames import distinct, records, where
from policies.evaluation.plots.style import STYLE, note
from policies.study.config import SOURCES

_DROPPED = 0.005  # share from which drops are written beside the dot


def plot_success(outcomes: pd.DataFrame, estimator: str) -> Figure:
    """A row for each task, a column for each kind of policy, a dot for each source.

    Args:
        outcomes: Of one world and preset, without changes.
        estimator: The main estimator.
    """
    main = among(outcomes, "estimator", ("", estimator))
    known = [(source, source, COLOURS[source]) for source in SOURCES if source in distinct(main, "source")]
    return _dots(main.assign(known=main["source"]), known)


def plot_estimators(outcomes: pd.DataFrame, estimators: Sequence[str]) -> Figure:
    """The same with a dot for each estimator, and the truth.

    Args:
        outcomes: Of one world and preset, without changes.
        estimators: In order.
    """
    colours = [STYLE.palette[0], STYLE.palette[5], STYLE.palette[3], STYLE.palette[4], STYLE.palette[1]]
    known = [(name, name, colours[k % len(colours)]) for k, name in enumerate(estimators)]
    known.append(("true", "the truth", COLOURS["true"]))
    names = [row["estimator"] or row["source"] for row in records(outcomes)]
    return _dots(outcomes.assign(known=names), known)


def _dots(outcomes: pd.DataFrame, known: Sequence[tuple[str, str, str]]) -> Figure:
    """Dots by the column "known"; known holds its values, their names and colours."""
    tasks, kinds = distinct(outcomes, "task"), distinct(outcomes, "kind")
    figure, columns = panels(kinds, len(tasks), 0.62)
    for axes, kind in zip(columns, kinds, strict=True):
        stripes(axes, len(tasks))
        for at, task in enumerate(tasks):
            for k, (value, _, colour) in enumerate(known):
                for row in records(where(outcomes, task=task, kind=kind, known=value)):
                    height = at + 0.17 * (k - (len(known) - 1) / 2.0)
                    dot(axes, row, "success", height, colour, 100.0)
                    _drops(axes, row, height, colour)
        axes.set_xlim(0.0, 100.0)
        axes.set_xlabel("episodes solved [%]")
    columns[0].set_yticks(range(len(tasks)), tasks)
    handles = [Line2D([], [], color=colour, marker="o", linewidth=2.2) for *_, colour in known]
    figure.legend(handles, [name for _, name, _ in known], loc="outside upper right", ncols=len(known))
    return figure


def _drops(axes: Axes, row: Mapping[str, Any], height: float, colour: str) -> None:
    if row["dropped"] >= _DROPPED:
        words = f"{100.0 * row['dropped']:.0f} % dropped"
        left = row["success_low"] > 0.35
        x = 100.0 * (row["success_low"] if left else row["success_high"])
        offset = {"textcoords": "offset points", "xytext": (-6 if left else 6, 0)}
        note(
            axes,
            x,
            height,
            words,
            colour,
            va="center",
            ha="right" if left else "left",
            fontsize=6.5,
            **offset,
        )
