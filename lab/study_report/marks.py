"""Draws what the figures share: a colour for each source, and dots with intervals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from policies.evaluation.plots.style import STYLE

COLOURS = {
    "none": STYLE.palette[1],
    "nominal": STYLE.palette[4],
    "estimated": STYLE.palette[0],
    "true": STYLE.palette[2],
}
"""Friction source -> its colour."""


def panels(names: Sequence[str], rows: int, height: float) -> tuple[Figure, list[Axes]]:
    """A column for each name, its rows from top to bottom.

    Args:
        names: Titles of the columns.
        rows: How many rows each has.
        height: Of a row [inch].
    """
    figure = Figure(figsize=(8.6, 0.9 + height * rows))
    axes = figure.subplots(1, len(names), sharey=True, squeeze=False)[0]
    for each, name in zip(axes, names, strict=True):
        each.set_title(name)
        each.set_ylim(rows - 0.5, -0.5)
        each.tick_params(axis="y", length=0, pad=9)
        each.spines["left"].set_visible(False)
        each.grid(axis="x", color=STYLE.band, linewidth=0.8)
        each.set_axisbelow(True)
    return figure, list(axes)


def dot(
    axes: Axes, row: Mapping[str, Any], name: str, at: float, colour: str, scale: float = 1.0, **options: Any
) -> None:
    """A figure with its interval at a height."""
    value, low, high = (scale * row[column] for column in (name, f"{name}_low", f"{name}_high"))
    axes.plot([low, high], [at, at], color=colour, linewidth=2.2, alpha=0.45, zorder=2)
    axes.plot(value, at, "o", color=colour, markersize=5.5, zorder=3, clip_on=False, **options)


def stripes(axes: Axes, rows: int) -> None:
    """A pale band behind every second row."""
    for row in range(0, rows, 2):
        axes.axhspan(row - 0.5, row + 0.5, color=STYLE.band, alpha=0.45, linewidth=0, zorder=0)
