"""One trial of each friction choice over time: slip, grip force, estimated friction."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from policies.evaluation.frames import distinct, values, where
from policies.evaluation.plots.style import STYLE, note
from slipgym.tasks import find
from slipgym.tasks.motion import Motion

_SLIP, _MU_C, _MU_S = STYLE.palette[:3]
_TURN = STYLE.palette[3]
_CORNER: dict[str, Any] = {"xycoords": "axes fraction", "ha": "right"}


def plot_tracking(task: str, trials: pd.DataFrame, series: pd.DataFrame) -> Figure:
    """The first trial of a policy in the first scenario, a column for each friction choice.

    The steps of the first trials are by row of the table of trials.
    """
    choices = distinct(trials, "friction")
    figure = Figure(figsize=(max(7.0, 3.0 * len(choices)), 6.2))
    grid = figure.subplots(3, len(choices), sharex=True, sharey="row", squeeze=False)
    found = find(task)
    motion: Callable[..., None] = _MOTION.get(found.name) or partial(_path, found.motion)
    for column, choice in enumerate(choices):
        trial = where(trials, friction=choice, trial=0).iloc[0]
        steps = where(series, row=trial.name)
        grid[0, column].set_title(f"friction: {choice}")
        for axes, panel in zip(grid[:, column], (motion, _force, _friction), strict=True):
            panel(axes, steps, trial, column == 0)
        grid[-1, column].set_xlabel("time [s]")
    grid[1, 0].set_ylim(bottom=0.0)  # last, so that all panels have had their say in the shared scale
    figure.suptitle(_scenario(task, trials.iloc[0]), x=0.01, ha="left", color=STYLE.muted, fontsize=9.0)
    figure.align_ylabels()
    return figure


def _ended(axes: Axes, at: float, trial: Any, words: str, colour: str = _SLIP) -> None:
    """How the trial ended."""
    note(axes, 0.98, at, "dropped" if trial["dropped"] else words, colour, **_CORNER)


def _path(motion: Motion, axes: Axes, steps: pd.DataFrame, trial: Any, first: bool) -> None:
    slip = np.column_stack([values(steps, f"slip_{axis}") for axis in ("x", "y", "theta")])
    time, middle = values(steps, "time"), len(steps) // 2
    axes.plot(time, motion.path(slip), color=_SLIP)
    if first:
        axes.set_ylabel(motion.title)
    if motion.axis is None:
        if "tolerance_mm" in trial:
            axes.axhspan(0.0, trial["tolerance_mm"], color=STYLE.band, linewidth=0)
            if first:
                note(axes, 0.0, trial["tolerance_mm"], "tolerance", STYLE.muted, va="bottom")
            axes.margins(y=0.1)
            _ended(axes, 0.45, trial, f"largest slip {trial['largest_slip_mm']:.2f} mm")
        return
    reference = motion.target(1.0) * values(steps, "reference")
    axes.plot(time, reference, "--", color=STYLE.ink, linewidth=1.0)
    if first:
        note(axes, time[middle], reference[middle], "reference  ", STYLE.ink, ha="right", va="bottom")
    for column, unit in (("final_error_mm", " mm"), ("final_error_deg", "°")):
        if column in trial:
            _ended(axes, 0.05, trial, f"final error {trial[column]:+.2f}{unit}".replace("-", "−"))


def _tilt(axes: Axes, steps: pd.DataFrame, trial: Any, first: bool) -> None:
    time, tolerance = values(steps, "time"), trial["tolerance_deg"]
    pitch, turned = (np.degrees(values(steps, name)) for name in ("reference", "slip_theta"))
    side = np.sign(pitch[-1])
    axes.axhspan(-tolerance, tolerance, color=STYLE.band, linewidth=0)
    axes.plot(time, side * (turned + pitch), color=_SLIP)
    axes.plot(time, side * pitch, "--", color=STYLE.ink, linewidth=1.0)
    axes.set_ylim(-1.2 * tolerance, 1.6 * tolerance)
    _ended(
        axes, 0.24, trial, f"tilt {trial['largest_tilt_deg']:.1f}°, slid {trial['largest_slip_mm']:.2f} mm"
    )
    if first:
        axes.set_ylabel("tilt of the object [°]")
        leaves = int(np.argmax(side * pitch > 1.2 * tolerance))
        note(axes, time[leaves], 1.2 * tolerance, "wrist  ", STYLE.ink, ha="right")
        note(axes, 0.0, -tolerance, "tolerance", STYLE.muted, va="bottom")


def _away(axes: Axes, steps: pd.DataFrame, trial: Any, first: bool) -> None:
    time = values(steps, "time")
    x, y = (1e3 * values(steps, f"slip_{axis}") - trial[f"target_{axis}_mm"] for axis in ("x", "y"))
    turn = np.abs(np.degrees(values(steps, "slip_theta")) - trial["target_theta_deg"])
    for path, unit, colour in ((np.hypot(x, y), "mm", _SLIP), (turn, "deg", _TURN)):
        axes.plot(time, path / trial[f"tolerance_{unit}"], color=colour)
    axes.axhspan(0.0, 1.0, color=STYLE.band, linewidth=0)
    error = f"final error {trial['final_error_mm']:.2f} mm, {trial['final_error_abs_deg']:.1f}°"
    _ended(axes, 0.9, trial, error, STYLE.ink)
    if first:
        axes.set_ylabel("error / tolerance [–]")
        note(axes, 0.98, 0.74, "in (x, y)", _SLIP, **_CORNER)
        note(axes, 0.98, 0.58, "in theta", _TURN, **_CORNER)


def _force(axes: Axes, steps: pd.DataFrame, trial: Any, first: bool) -> None:
    time, needed = values(steps, "time"), values(steps, "needed_force")
    axes.fill_between(time, needed, color=STYLE.band, linewidth=0)
    axes.plot(time, needed, color=STYLE.muted, linewidth=0.6)
    axes.plot(time, 0.5 * (values(steps, "force_1") + values(steps, "force_2")), color=STYLE.ink)
    if first:
        axes.set_ylabel("grip force [N]")
        note(axes, time[-1], 0.0, "least that holds the load", STYLE.muted, ha="right", va="bottom")


def _friction(axes: Axes, steps: pd.DataFrame, trial: Any, first: bool) -> None:
    time = values(steps, "time")
    for name, symbol, colour in (("mu_c", "μ$_c$", _MU_C), ("mu_s", "μ$_s$", _MU_S)):
        for finger in (1, 2):
            axes.plot(time, values(steps, f"{name}_{finger}"), color=colour, linewidth=0.8, alpha=0.35)
        shown = values(steps, f"shown_{name}")
        axes.plot(time, shown, color=colour, linewidth=1.8)
        true = trial[f"true_{name}"]
        axes.axhline(true, color=colour, linestyle="--", linewidth=1.0)
        beside: dict[str, Any] = {"xycoords": axes.get_yaxis_transform(), "annotation_clip": False}
        note(axes, 1.01, true, symbol, colour, va="center", **beside)
    axes.set_ylim(0.0, 1.6)
    if np.isnan(values(steps, "shown_mu_c")).all():
        note(axes, 0.98, 0.9, "the controller is shown no friction", STYLE.muted, **_CORNER)
    if first:
        axes.set_ylabel("friction [–]")
        note(axes, 0.98, 0.14, "bold: what the controller is shown", STYLE.muted, **_CORNER)
        note(axes, 0.98, 0.05, "pale: estimates of both fingers; dashed: true", STYLE.muted, **_CORNER)


_MOTION = {"Hinge": _tilt, "PlanarSlip": _away}
"""Task -> its panel of the object's motion, where it says more than the path."""


def _scenario(task: str, trial: Any) -> str:
    """What was run, in words with units."""
    fields = find(task).options.model_fields
    words = []
    for name, value in json.loads(trial["options"]).items():
        unit = re.search(r"\[(?!-\])(.+)\]$", fields[name].description or "")
        number = f"{value:g}" if isinstance(value, float) else value
        words.append(f"{name} {number}" + (f" {unit[1]}" if unit else ""))
    return "   ·   ".join([task, str(trial["policy"]), str(trial["material"]), *words])
