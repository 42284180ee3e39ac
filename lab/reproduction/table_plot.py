"""The paper's table as points, beside ours."""

from __future__ import annotations

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from lab.reproduction.published import TABLES, TITLES
from policies.evaluation.frames import distinct, values, where
from policies.evaluation.plots.style import STYLE, colours

_PANELS = (("mu_c", "μ$_c$ [–]", 1.0), ("mu_s", "μ$_s$ [–]", 1.0), ("r", "r [mm]", 1e3))


def plot_table(table: pd.DataFrame, experiment: str) -> Figure:
    """Mean and spread between trials for each material; dashes at the truth.

    Args:
        table: From `nine_columns`.
        experiment: A key of `published.TABLES`.
    """
    figure = Figure(figsize=(10.0, 3.6))
    materials, estimators = distinct(table, "material"), distinct(table, "estimator")
    colour = colours(estimators)
    width = 0.8 / (len(TITLES) + len(estimators))
    for k, (quantity, label, scale) in enumerate(_PANELS):
        axes = figure.add_subplot(1, len(_PANELS), k + 1)
        for m, material in enumerate(materials):
            at = iter(m - 0.4 + (i + 0.5) * width for i in range(len(TITLES) + len(estimators)))
            for title, numbers in zip(TITLES, TABLES[experiment][material], strict=True):
                filled = title == TITLES[1]
                mean, between = scale * numbers[3 * k], scale * numbers[3 * k + 1]
                _point(axes, next(at), mean, between, STYLE.ink, filled, title if m == 0 else "")
            for estimator in estimators:
                row = where(table, material=material, estimator=estimator, quantity=quantity)
                name = estimator if m == 0 else ""
                filled = "no heuristic" not in estimator
                mean, between = (scale * values(row, column)[0] for column in ("mean", "between"))
                _point(axes, next(at), mean, between, colour[estimator], filled, name)
            true = scale * values(where(table, material=material, quantity=quantity), "true")[0]
            axes.plot([m - 0.42, m + 0.42], [true, true], "--", color=STYLE.muted, linewidth=1.0, zorder=0)
        axes.set_xticks(range(len(materials)), materials)
        axes.set(ylabel=label, ylim=(0.0, None))
    handles, names = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower center", ncols=(len(names) + 1) // 2, fontsize=8.0)
    figure.suptitle(
        "mean over trials, bars: standard deviation between trials, dashed: true",
        x=0.01,
        ha="left",
        color=STYLE.muted,
        fontsize=9.0,
    )
    return figure


def _point(axes: Axes, x: float, mean: float, spread: float, colour: str, filled: bool, label: str) -> None:
    style = {"color": colour, "markerfacecolor": colour if filled else "white", "linewidth": 1.2}
    axes.errorbar(x, mean, spread, fmt="o", markersize=4.5, label=label, **style)
