"""The common style of the figures, and a table as a grid of coloured cells."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, Normalize


@dataclass(frozen=True)
class Style:
    """Colours that the colour-blind tell apart (Okabe and Ito), and sizes."""

    palette: tuple[str, ...] = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
    ink: str = "#222222"
    muted: str = "#767676"
    band: str = "#E9EEF2"
    dpi: int = 150


STYLE = Style()
_RC: Any = {
    "figure.constrained_layout.use": True,
    "figure.facecolor": "white",
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelcolor": STYLE.ink,
    "axes.edgecolor": STYLE.muted,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.color": STYLE.muted,
    "ytick.color": STYLE.muted,
    "xtick.labelcolor": STYLE.ink,
    "ytick.labelcolor": STYLE.ink,
    "lines.linewidth": 1.4,
    "lines.solid_capstyle": "round",
    "legend.frameon": False,
}


def styled() -> AbstractContextManager[None]:
    """Applies the style to the figures made within."""
    return matplotlib.rc_context(_RC)


def colours(names: Sequence[str]) -> dict[str, str]:
    """A colour for each name, in order."""
    return {name: STYLE.palette[k % len(STYLE.palette)] for k, name in enumerate(names)}


def note(axes: Axes, x: float, y: float, words: str, colour: str, **options: Any) -> None:
    """A label at a point of the data, beside what it names."""
    axes.annotate(words, (x, y), color=colour, **{"fontsize": 8.0, **options})


COLOURS = LinearSegmentedColormap.from_list("cells", ["#A33B00", "#E9A26A", "#F7F4E9", "#7FC8A9", "#00644A"])
"""From bad to good, where large figures are good."""


def places(groups: Sequence[str], gap: float) -> np.ndarray:
    """Places of columns of these groups, (n,), with a gap between groups."""
    return np.arange(len(groups)) + gap * np.cumsum([False, *(a != b for a, b in pairwise(groups))])


def heat(
    axes: Axes,
    grid: np.ndarray,
    at: np.ndarray,
    names: Sequence[str],
    norm: Normalize,
    words: Callable[[float], str],
    smallest: bool = False,
) -> None:
    """Draws a row for each name, the first on top; NaN stays empty.

    Args:
        axes: Where.
        grid: The figures, (rows, columns).
        at: Where each column stands, (columns,).
        names: Of the rows.
        norm: From figures to the range of the colours, 0 to 1.
        words: Writes a figure.
        smallest: Whether small figures are good; then the smallest of a column is bold.
    """
    rows, colours = np.arange(len(names) + 1) - 0.5, COLOURS.reversed() if smallest else COLOURS
    for place, column in zip(at, grid.T, strict=True):
        sides = [place - 0.48, place + 0.48]
        axes.pcolormesh(sides, rows, np.ma.masked_invalid(column[:, None]), norm=norm, cmap=colours)
        for row in np.flatnonzero(np.isfinite(column)).tolist():
            value = float(column[row])
            colour = STYLE.ink if 0.25 < norm(value) < 0.8 else "white"
            weight = "bold" if smallest and value <= np.nanmin(column) else "normal"
            centred = {"ha": "center", "va": "center", "size": 7.5}
            axes.text(place, row, words(value), color=colour, weight=weight, **centred)
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(len(names) - 0.5, -0.5)
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
