"""The common style of the figures."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any

import matplotlib
from matplotlib.axes import Axes


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
