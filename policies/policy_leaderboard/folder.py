"""Writes the leaderboard of policies: the table, and what each one solves of every task and level."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from policies.evaluation.frames import distinct
from policies.evaluation.plots.style import STYLE, heat, places, styled
from policies.policy_leaderboard.run import kinds
from policies.versions import stamped, versions, write_versions
from slipgym import atomic_io
from slipgym.atomic_io import new_folder

BAND = 3
"""Tasks beside each other."""
WIDTH = 6.7
"""Of the picture: its words keep their size on a page 670 pixels wide [inches]."""


def write(
    table: pd.DataFrame, output: Path, played: Mapping[str, Any] | None = None, name: str = "policies"
) -> Path:
    """Writes a table into a run's own folder, whole or not at all.

    Args:
        table: Of all tasks and levels, from `policies.policy_leaderboard.run.outcomes` or another.
        output: Folder of the run's own folder.
        played: How the outcomes were played: their number, the engine, arguments of the environments. With it
            there are a picture and `leaderboard.json`.
        name: Of the table.

    Returns:
        The folder: `policies.csv`, `versions.json`, and `policies.png` and `leaderboard.json`.
    """
    place = stamped(output, name)
    with new_folder(place) as folder:
        table.to_csv(folder / f"{name}.csv", index=False, float_format="%.3f")
        if played is not None:
            with styled():
                plot_policies(table).savefig(folder / f"{name}.png", dpi=STYLE.dpi)
            rows = json.loads(table.to_json(orient="records", double_precision=3) or "[]")
            board = {"played": dict(played), "versions": versions(), "rows": rows}
            atomic_io.write(folder / "leaderboard.json", (json.dumps(board, indent=1) + "\n").encode())
        write_versions(folder)
    return place


def plot_policies(table: pd.DataFrame) -> Figure:
    """A row for each policy, the best on average on top; a column for each task and level."""
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
    groups, levels = zip(*cells, strict=True)
    at = places(groups, 0.4)
    heat(axes, grid.to_numpy(), at, list(grid.index), Normalize(0, 100), "{:.0f}".format)
    for task in dict.fromkeys(groups):
        left = at[groups.index(task)] - 0.48
        axes.text(left, -0.75, task, size=9, weight="bold", ha="left", va="bottom")
    axes.set_xticks(at, levels, rotation=30, ha="right", rotation_mode="anchor")
