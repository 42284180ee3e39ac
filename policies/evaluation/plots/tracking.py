"""One trial of each friction choice over time: slip, grip force, estimated friction."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from policies.evaluation.plots.style import STYLE, note

_SLIP, _FORCE, _MU_C, _MU_S = STYLE.palette[0], STYLE.ink, STYLE.palette[1], STYLE.palette[2]


def plot_tracking(task: str, trials: pd.DataFrame, series: pd.DataFrame) -> Figure:
    """The first trial of the first scenario, a column for each friction choice.

    Args:
        task: The task.
        trials: The table of trials of one policy.
        series: Steps of the first trials, by row of that table.
    """
    chosen = trials[trials["trial"] == 0].drop_duplicates("friction")
    figure = Figure(figsize=(max(7.0, 3.0 * len(chosen)), 6.2))
    grid = figure.subplots(3, len(chosen), sharex=True, sharey="row", squeeze=False)
    rows: list[Callable[..., None]] = [_slip, _force, _friction]
    for column, (row, trial) in enumerate(chosen.iterrows()):
        steps = series[series["row"] == row]
        grid[0, column].set_title(f"{trial['friction']}")
        for axes, panel in zip(grid[:, column], rows, strict=True):
            panel(axes, task, steps, trial, column == 0)
        grid[-1, column].set_xlabel("time [s]")
    figure.suptitle(_scenario(task, chosen.iloc[0]), x=0.01, ha="left", color=STYLE.muted, fontsize=9.0)
    figure.align_ylabels()
    return figure


def _slip(axes: Axes, task: str, steps: pd.DataFrame, trial: Any, first: bool) -> None:
    time = steps["time"].to_numpy()
    if task == "LinearSlip":
        slip, label = -1e3 * steps["slip_y"], "slip along gravity [mm]"
        reference = 1e3 * steps["reference"].to_numpy()
        axes.plot(time, reference, "--", color=STYLE.ink, linewidth=1.0, zorder=3)
        if first:
            middle = len(time) // 2
            note(axes, time[middle], reference[middle], "reference ", STYLE.ink, ha="right", va="bottom")
        outcome = f"final error {trial['final_error_mm']:+.2f} mm"
    else:
        slip, label = 1e3 * np.hypot(steps["slip_x"], steps["slip_y"]), "slip [mm]"
        axes.axhspan(0.0, trial["tolerance_mm"], color=STYLE.band, linewidth=0)
        outcome = f"largest slip {trial['largest_slip_mm']:.2f} mm"
    axes.plot(time, slip, color=_SLIP)
    axes.annotate(
        outcome + (", dropped" if trial["dropped"] else ""), (0.98, 0.04), xycoords="axes fraction",
        ha="right", color=_SLIP, fontsize=8.0,
    )  # fmt: skip
    if first:
        axes.set_ylabel(label)


def _force(axes: Axes, task: str, steps: pd.DataFrame, trial: Any, first: bool) -> None:
    time = steps["time"].to_numpy()
    needed = steps["needed_force"].to_numpy()
    axes.fill_between(time, needed, color=STYLE.band, linewidth=0)
    axes.plot(time, 0.5 * (steps["force_1"] + steps["force_2"]), color=_FORCE)
    axes.set_ylim(bottom=0.0)
    if first:
        axes.set_ylabel("grip force [N]")
        note(axes, time[-1], 0.0, "least that would hold the load", STYLE.muted, ha="right", va="bottom")


def _friction(axes: Axes, task: str, steps: pd.DataFrame, trial: Any, first: bool) -> None:
    time = steps["time"].to_numpy()
    for name, symbol, colour in (("mu_c", "μ$_c$", _MU_C), ("mu_s", "μ$_s$", _MU_S)):
        for finger, width in ((1, 1.4), (2, 0.8)):
            axes.plot(time, steps[f"{name}_{finger}"], color=colour, linewidth=width)
        axes.axhline(trial[f"true_{name}"], color=colour, linestyle="--", linewidth=1.0)
        note(
            axes, 1.01, trial[f"true_{name}"], symbol, colour, xycoords=axes.get_yaxis_transform(),
            va="center", annotation_clip=False,
        )  # fmt: skip
    axes.set_ylim(0.0, 1.6)
    if first:
        axes.set_ylabel("friction [–]")


def _scenario(task: str, trial: Any) -> str:
    options = ", ".join(f"{name} {value:g}" if isinstance(value, float) else f"{name} {value}"
                        for name, value in json.loads(trial["options"]).items())  # fmt: skip
    words = [task, trial["policy"], trial["material"], options, f"seed {trial['seed']}"]
    return "   ".join(word for word in words if word)
