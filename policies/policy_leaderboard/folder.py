"""Writes the leaderboard of policies: the table, and what each one solves of every task and level."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

from policies.evaluation.folder import stamped
from policies.evaluation.frames import distinct
from policies.evaluation.plots.style import STYLE, styled
from policies.policy_leaderboard.run import kinds
from policies.versions import write_versions
from slipgym.atomic_io import new_folder

BAND = 3
"""Tasks beside each other."""
WIDTH = 6.7
"""Of the picture: its words keep their size on a page 670 pixels wide [inches]."""
COLOURS = LinearSegmentedColormap.from_list("solved", ["#A33B00", "#E9A26A", "#F7F4E9", "#7FC8A9", "#00644A"])


def write(table: pd.DataFrame, output: Path) -> Path:
    """Writes the table and the picture, whole or not at all.

    Args:
        table: Of all tasks and levels, from `policies.policy_leaderboard.run.outcomes`.
        output: Folder of the run's own folder.

    Returns:
        The folder: `policies.csv`, `policies.png`, `versions.json`.
    """
    return write_table(table, output, "policies", plot_policies)


def write_table(
    table: pd.DataFrame, output: Path, name: str, plot: Callable[[pd.DataFrame], Figure] | None = None
) -> Path:
    """Writes a table, its picture if there is one, and `versions.json` into a folder of their own."""
    place = stamped(output, name)
    with new_folder(place) as folder:
        table.to_csv(folder / f"{name}.csv", index=False, float_format="%.3f")
        if plot is not None:
            with styled():
                plot(table).savefig(folder / f"{name}.png", dpi=STYLE.dpi)
        write_versions(folder)
    return place


def plot_policies(table: pd.DataFrame) -> Figure:
    """A row for each policy, the best on average on top; a column for each task and level.

    Args:
        table: From `policies.policy_leaderboard.run.outcomes`, of several tasks and levels.
    """
    table = table.assign(kind=kinds(table))
    tasks = distinct(table, "task")
    bands = [table.loc[table["task"].isin(tasks[k : k + BAND])] for k in range(0, len(tasks), BAND)]
    heights = [len(set(band["kind"])) + 3 for band in bands]
    figure = Figure(figsize=(WIDTH, 0.23 * sum(heights)), layout="constrained")
    rows = figure.subplots(len(bands), squeeze=False, gridspec_kw={"height_ratios": heights})
    for axes, band in zip(rows[:, 0], bands, strict=True):
        plot_band(axes, band)
    end = max(axes.get_xlim()[1] for axes in rows[:, 0])
    for axes in rows[:, 0]:
        axes.set_xlim(right=end)
    rows[-1, 0].set_xlabel("episodes solved [%]")
    return figure


def plot_band(axes: Axes, table: pd.DataFrame) -> None:
    """The rows and columns of a few tasks, all of whose levels stand beside each other."""
    cells = list(dict.fromkeys(zip(table["task"], table["level"], strict=True)))
    grid = table.pivot_table(index="kind", columns=["task", "level"], values="solved [%]")[cells]
    grid = grid.loc[grid.mean(axis=1).sort_values(ascending=False).index]
    tasks, names = distinct(table, "task"), list(grid.index)
    starts = [next(k for k, cell in enumerate(cells) if cell[0] == task) for task in tasks]
    places = np.arange(len(cells)) + 0.4 * np.searchsorted(starts, np.arange(len(cells)), side="right")
    rows = np.arange(len(names) + 1) - 0.5
    for place, column in zip(places, grid.to_numpy().T, strict=True):
        values = np.ma.masked_invalid(column[:, None])
        axes.pcolormesh([place - 0.48, place + 0.48], rows, values, vmin=0, vmax=100, cmap=COLOURS)
        for row, value in enumerate(column):
            if np.isfinite(value):
                colour = STYLE.ink if 20 < value < 80 else "white"
                axes.text(place, row, f"{value:.0f}", ha="center", va="center", size=8, color=colour)
    for task, start in zip(tasks, starts, strict=True):
        axes.text(places[start] - 0.48, -0.75, task, size=9, weight="bold", ha="left", va="bottom")
    axes.set_xticks(places, [level for _, level in cells], rotation=30, ha="right", rotation_mode="anchor")
    axes.set_yticks(range(len(names)), names)
    axes.invert_yaxis()
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
