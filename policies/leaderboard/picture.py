"""The leaderboard as a picture: errors of each estimator in each scenario."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, LogNorm
from matplotlib.figure import Figure

from policies.evaluation.plots.style import STYLE
from policies.leaderboard.scenario import FIELDS

TITLES = {"mu_c": "μ$_c$", "r": "r", "mu_s": "μ$_s$"}
NORM = LogNorm(0.5, 100.0, clip=True)  # of errors [%]
COLOURS = LinearSegmentedColormap.from_list("error", ["#00644A", "#7FC8A9", "#F7F4E9", "#E9A26A", "#A33B00"])


def plot_leaderboard(table: pd.DataFrame, ranking: pd.DataFrame) -> Figure:
    """A panel for each quantity: estimators, the best on top, by scenarios; numbers are errors in %.

    Args:
        table: A row per scenario and estimator.
        ranking: A row per estimator, the best first.
    """
    names = list(ranking["estimator"])
    scenarios = list(dict.fromkeys(zip(table["group"], table["scenario"], strict=True)))
    places = _places([group for group, _ in scenarios])
    figure = Figure(figsize=(0.44 * places[-1] + 2.4, 0.36 * len(FIELDS) * len(names) + 2.6))
    panels = figure.subplots(len(FIELDS), 1, sharex=True)
    labels = [f"{k}  {name}" for k, name in enumerate(names, start=1)]
    for ax, field in zip(panels, FIELDS, strict=True):
        grid = table.pivot(index="estimator", columns=["group", "scenario"], values=f"error_{field}")
        errors = grid.loc[names, scenarios].to_numpy()
        _heat(ax, errors, places, labels)
        for row, value in enumerate(ranking[field]):
            ax.text(places[-1] + 1.2, row, f"{value:.1f}", ha="center", va="center", weight="bold", size=8)
        ax.set_title(f"{TITLES[field]}: error [%]", fontsize=10)
    _groups(panels[0], scenarios, places)
    names_below = [*(name for _, name in scenarios), "typical"]
    panels[-1].set_xticks([*places, places[-1] + 1.2], names_below, rotation=60)
    for label in panels[-1].get_xticklabels():
        label.set(ha="right", rotation_mode="anchor")
    bar = figure.colorbar(ScalarMappable(NORM, COLOURS), ax=panels, shrink=0.6, aspect=30, pad=0.01)
    bar.set_ticks([0.5, 1, 2, 5, 10, 20, 50, 100], labels=["0.5 %", "1", "2", "5", "10", "20", "50", "100"])
    bar.outline.set_visible(False)  # type: ignore[operator]
    return figure


def _places(groups: list[str]) -> np.ndarray:
    """Where each scenario stands; a gap between groups."""
    new = np.array([0.0] + [0.35 * (a != b) for a, b in pairwise(groups)])
    return np.arange(len(groups)) + np.cumsum(new)


def _heat(ax: Axes, errors: np.ndarray, places: np.ndarray, names: list[str]) -> None:
    """One panel; the best of a scenario is bold."""
    rows = np.arange(len(names) + 1) - 0.5
    for column, place in zip(errors.T, places, strict=True):
        sides = [place - 0.48, place + 0.48]
        ax.pcolormesh(sides, rows, np.ma.masked_invalid(column[:, None]), norm=NORM, cmap=COLOURS)
        for row, value in enumerate(column):
            if np.isfinite(value):
                words = f"{value:.1f}" if value < 9.95 else f"{value:.0f}"
                colour = STYLE.ink if 0.25 < NORM(value) < 0.8 else "white"
                weight = "bold" if value <= np.nanmin(column) else "normal"
                ax.text(place, row, words, ha="center", va="center", size=7.5, color=colour, weight=weight)
    ax.set_yticks(range(len(names)), names)
    ax.set_ylim(len(names) - 0.5, -0.5)
    ax.set_xlim(places[0] - 0.6, places[-1] + 1.8)
    ax.tick_params(length=0)
    for spine in ax.spines.values():
        spine.set_visible(False)


def _groups(ax: Axes, scenarios: list[tuple[str, str]], places: np.ndarray) -> None:
    """The groups' names over the first panel."""
    groups = [group for group, _ in scenarios]
    for group in dict.fromkeys(groups):
        mine = places[[name == group for name in groups]]
        ax.annotate(
            group.replace(" ", "\n"),
            (mine.mean(), 1.0),
            (0, 20),
            xycoords=ax.get_xaxis_transform(),
            textcoords="offset points",
            ha="center",
            va="bottom",
            size=8.5,
            color=STYLE.muted,
        )
