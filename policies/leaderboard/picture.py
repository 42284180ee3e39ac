"""The leaderboard as a picture: errors of each estimator in each scenario."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from policies.evaluation.plots.heat import COLOURS, heat, places
from policies.evaluation.plots.style import STYLE, note
from policies.leaderboard.scenario import FIELDS

TITLES = {"mu_c": "μ$_c$", "r": "r", "mu_s": "μ$_s$"}
NORM = LogNorm(0.5, 100.0, clip=True)  # of errors [%]


def plot_leaderboard(table: pd.DataFrame, ranking: pd.DataFrame) -> Figure:
    """A panel for each quantity: estimators, the best on top, by scenarios; numbers are errors in %.

    The table has a row per scenario and estimator, the ranking one per estimator, the best first.
    """
    names = list(ranking["estimator"])
    scenarios = list(dict.fromkeys(zip(table["group"], table["scenario"], strict=True)))
    at = places([group for group, _ in scenarios], 0.35)
    figure = Figure(figsize=(0.44 * at[-1] + 2.4, 0.36 * len(FIELDS) * len(names) + 2.6))
    panels = figure.subplots(len(FIELDS), 1, sharex=True)
    labels = [f"{k}  {name}" for k, name in enumerate(names, start=1)]
    for ax, field in zip(panels, FIELDS, strict=True):
        grid = table.pivot(index="estimator", columns=["group", "scenario"], values=f"error_{field}")
        errors = grid.loc[names, scenarios].to_numpy()
        heat(ax, errors, at, labels, NORM, _words, smallest=True)
        ax.set_xlim(at[0] - 0.6, at[-1] + 1.8)
        for row, value in enumerate(ranking[field]):
            ax.text(at[-1] + 1.2, row, f"{value:.1f}", ha="center", va="center", weight="bold", size=8)
        ax.set_title(f"{TITLES[field]}: error [%]", fontsize=10)
    _groups(panels[0], scenarios, at)
    names_below = [*(name for _, name in scenarios), "typical"]
    slanted = {"rotation": 60, "ha": "right", "rotation_mode": "anchor"}
    panels[-1].set_xticks([*at, at[-1] + 1.2], names_below, **slanted)
    scale = ScalarMappable(NORM, COLOURS.reversed())
    bar = figure.colorbar(scale, ax=panels, shrink=0.6, aspect=30, pad=0.01)
    bar.set_ticks([0.5, 1, 2, 5, 10, 20, 50, 100], labels=["0.5 %", "1", "2", "5", "10", "20", "50", "100"])
    bar.outline.set_visible(False)  # type: ignore[operator]
    return figure


def _words(error: float) -> str:
    return f"{error:.1f}" if error < 9.95 else f"{error:.0f}"


def _groups(ax: Axes, scenarios: list[tuple[str, str]], at: np.ndarray) -> None:
    """The groups' names over the first panel."""
    groups = [group for group, _ in scenarios]
    above = {"xycoords": ax.get_xaxis_transform(), "textcoords": "offset points", "xytext": (0, 20)}
    for group in dict.fromkeys(groups):
        middle = at[[name == group for name in groups]].mean()
        words = group.replace(" ", "\n")
        note(ax, middle, 1.0, words, STYLE.muted, fontsize=8.5, ha="center", va="bottom", **above)
