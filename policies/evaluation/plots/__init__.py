"""Figures of an experiment."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from policies.evaluation.frames import groups, values
from policies.evaluation.gain import WITHOUT, Gain
from policies.evaluation.plots.outcome import outcome
from policies.evaluation.plots.style import STYLE, note, styled
from policies.evaluation.plots.tracking import plot_tracking
from policies.evaluation.statistics import share
from slipgym.tasks import find

_BLUE, _ORANGE, _GREEN = STYLE.palette[:3]
_PALE = "#B5BBC0"


def draw(task: str, trials: pd.DataFrame, series: pd.DataFrame, folder: Path) -> None:
    """Draws the figures of a task into a folder, each policy on its own.

    The tables hold the trials, and the steps of the first ones, whose "row" is their row among the trials.
    """
    for (policy,), group in groups(trials, ["policy"]):
        slug = "".join(c if c.isalnum() else "_" for c in policy)
        with styled():
            figures = {"tracking": plot_tracking(task, group, series), **outcome(find(task), group)}
            for name, figure in figures.items():
                figure.savefig(folder / f"{name}_{slug}.png", dpi=STYLE.dpi)


def draw_gain(
    task: str, trials: pd.DataFrame, gain: Gain, episode: Sequence[Mapping[str, np.ndarray]], folder: Path
) -> None:
    """Draws `gain.png`: bars of the episodes solved, with intervals; grip and motion in one episode.

    The episode holds the steps of `gain.episode()` as columns, of each of `gain.entries`.
    """
    with styled():
        _plot_gain(task, trials, gain, episode).savefig(folder / "gain.png", dpi=STYLE.dpi)


def _plot_gain(
    task: str, trials: pd.DataFrame, gain: Gain, episode: Sequence[Mapping[str, np.ndarray]]
) -> Figure:
    figure = Figure(figsize=(7.2, 3.4))
    grid = figure.add_gridspec(2, 2, width_ratios=(1.25, 1.0))
    colours = [_colour(gain, k) for k in range(len(gain.entries))]
    _bars(figure.add_subplot(grid[:, 0]), gain, colours)
    grip = figure.add_subplot(grid[0, 1])
    motion = figure.add_subplot(grid[1, 1], sharex=grip)
    way = find(task).motion
    for steps, colour in zip(episode, colours, strict=True):
        line = {"color": colour, "linewidth": 1.0 if colour == _PALE else 1.4}
        grip.plot(steps["time"], 0.5 * (steps["force_1"] + steps["force_2"]), **line)
        slip = np.column_stack([steps[f"slip_{axis}"] for axis in ("x", "y", "theta")])
        motion.plot(steps["time"], way.path(slip), **line)
    needed = episode[-1]
    grip.fill_between(needed["time"], needed["needed_force"], color=STYLE.band, linewidth=0, zorder=0)
    note(grip, 0.99, 0.0, "needed", STYLE.muted, va="bottom", **_at_right(grip))
    grip.set_title(f"Episode {gain.episode() + 1}: grip [N]")
    grip.set_ylim(bottom=0.0)
    grip.tick_params(labelbottom=False)
    if way.axis is None and "tolerance_mm" in trials:
        tolerance = float(values(trials, "tolerance_mm").max())
        motion.axhspan(0.0, tolerance, color=STYLE.band, linewidth=0, zorder=0)
        note(motion, 0.99, tolerance, "allowed", STYLE.muted, va="top", **_at_right(motion))
        motion.set_ylim(0.0, 2.0 * tolerance)
    motion.set_title(way.title.replace("slid [mm]", "slip [mm]"))
    motion.set_xlabel("time [s]")
    figure.suptitle("\n".join(textwrap.wrap(gain.words(), 96)), x=0.01, ha="left", fontsize=9.5)
    return figure


def _at_right(axes: Axes) -> dict[str, Any]:
    return {"ha": "right", "xycoords": axes.get_yaxis_transform()}


def _colour(gain: Gain, k: int) -> str:
    entry = gain.entries[k]
    if entry.source in WITHOUT:
        return _ORANGE if entry is gain.opponent else _PALE
    return _BLUE if entry is gain.estimated else _GREEN


def _bars(axes: Axes, gain: Gain, colours: Sequence[str]) -> None:
    for k, (entry, colour) in enumerate(zip(gain.entries, colours, strict=True)):
        value, low, high = share(entry.success).percent
        axes.barh(k, value, color=colour, height=0.62)
        axes.plot([low, high], [k, k], color=STYLE.ink, linewidth=1.2)
        note(axes, max(high, value) + 2.0, k, f"{value:.0f} %", STYLE.ink, va="center", fontsize=9.5)
    axes.set_yticks(range(len(gain.entries)), [entry.name.replace(", ", ",\n") for entry in gain.entries])
    axes.invert_yaxis()
    axes.tick_params(axis="y", length=0, labelcolor=STYLE.ink)
    axes.spines["left"].set_visible(False)
    axes.set(xlim=(0.0, 112.0), xticks=range(0, 101, 25), title="Episodes solved [%]")
