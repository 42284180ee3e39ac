"""One trial over time as in the paper's figures, and one slip of it seen closely."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from lab.reproduction.mechanism import called_moving, slips, truly_sliding
from lab.reproduction.records import Record
from lab.reproduction.rerun import estimates, variants
from policies.evaluation.plots.style import STYLE, note

_MU_C, _MU_S, _R = STYLE.palette[1], STYLE.palette[2], STYLE.palette[3]
_CORNER: dict[str, Any] = {"xycoords": "axes fraction", "ha": "right", "va": "top"}
_AROUND = 10  # samples shown before a slip


def plot_trial(record: Record) -> Figure:
    """Forces and estimates of both fingers, a column for each estimator; grey: updates halted.

    Args:
        record: The trial.
    """
    listed = variants()
    figure = Figure(figsize=(3.4 * len(listed), 7.2))
    grid = figure.subplots(4, len(listed), sharex=True, sharey="row", squeeze=False)
    mu_s, mu_c, r = record.truth
    for column, variant in enumerate(listed):
        found = estimates(record, variant)
        grid[0, column].set_title(variant.title)
        for finger in range(2):
            _forces(grid[finger, column], record, finger, found["halted"][:, finger])
            width = 1.4 if finger == 0 else 0.8
            for row, quantity, colour in ((2, "mu_c", _MU_C), (2, "mu_s", _MU_S), (3, "r", _R)):
                scale = 1e3 if quantity == "r" else 1.0
                grid[row, column].plot(
                    record.time, scale * found[quantity][:, finger], color=colour, lw=width
                )
        for row, true, colour in ((2, mu_c, _MU_C), (2, mu_s, _MU_S), (3, 1e3 * r, _R)):
            grid[row, column].axhline(true, color=colour, linestyle="--", linewidth=0.9)
        grid[3, column].set_xlabel("time [s]")
        if not found["updates_r"].any():
            note(grid[3, column], 0.98, 0.15, "start value, never updated", _R, **_CORNER)
    for row, label in enumerate(("finger 1 [N]", "finger 2 [N]", "friction [–]", "r [mm]")):
        grid[row, 0].set_ylabel(label)
    grid[2, 0].set_ylim(0.0, 1.6)
    grid[3, 0].set_ylim(0.0, 25.0)
    note(grid[0, 0], 0.98, 0.97, "f$_n$", STYLE.palette[0], **_CORNER)
    note(grid[0, 0], 0.98, 0.82, "f$_t$", STYLE.palette[1], **_CORNER)
    note(grid[2, 0], 0.98, 0.80, "μ$_s$", _MU_S, **_CORNER)
    note(grid[2, 0], 0.98, 0.65, "μ$_c$", _MU_C, **_CORNER)
    words = f"{_words(record)}   ·   estimates of both fingers; dashed: true; grey: updates halted"
    figure.suptitle(words, x=0.01, ha="left", color=STYLE.muted, fontsize=9.0)
    figure.align_ylabels()
    return figure


def plot_slip(record: Record) -> Figure:
    """The slip in the middle of a trial: which samples count as moving, and what they say of friction.

    That is f_t / (gamma_t f_n) with the measured gamma_t where a sample is called moving, else the load
    sqrt(f_t^2 + (tau / r)^2) / f_n; both with the true r.

    Args:
        record: The trial.
    """
    begin, end = slips(record)[len(slips(record)) // 2]
    shown = np.arange(max(begin - _AROUND, 0), min(end + 2 * _AROUND, len(record.time)))
    time = 1e3 * (record.time[shown] - record.time[begin])
    r, moving, sliding = record.truth[2], called_moving(record)[shown, 0], truly_sliding(record)[shown]
    f_x, f_y, f_n, tau = record.wrenches[shown, 0].T
    measured, true = (series[shown] * (1.0, 1.0, r) for series in (record.twists[:, 0], record.slip_twist))
    f_t, v_t, v = (
        np.hypot(f_x, f_y),
        np.hypot(measured[:, 0], measured[:, 1]),
        np.linalg.norm(measured, axis=1),
    )
    read = np.hypot(f_t, tau / r) / f_n
    read[moving] = (f_t * v)[moving] / (v_t * f_n)[moving]
    figure = Figure(figsize=(6.4, 5.6))
    force, speed, friction = figure.subplots(3, 1, sharex=True)
    for series, words, colour in ((f_n, "f$_n$", STYLE.palette[0]), (f_t, "f$_t$", STYLE.palette[1])):
        force.plot(time, series, ".-", color=colour)
        _beside(force, series[-1], words, colour)
    speed.plot(time, 1e3 * np.linalg.norm(true, axis=1), ".-", color=STYLE.ink, label="true")
    speed.plot(time, 1e3 * v, ".-", color=STYLE.palette[5], label="measured")
    for mask, words, colour in (
        (~moving, "called stuck", STYLE.muted),
        (moving & sliding, "called moving, slides", STYLE.palette[2]),
        (moving & ~sliding, "called moving, is stuck", STYLE.palette[1]),
    ):
        friction.plot(time[mask], read[mask], "o", color=colour, markersize=4, label=words)
    friction.axhline(record.truth[1], color=STYLE.ink, linestyle="--", linewidth=0.9)
    _beside(friction, record.truth[1], "true μ$_c$", STYLE.ink)
    speed.legend(loc="upper right")
    friction.legend(loc="lower right", fontsize=8.0)
    force.set(ylabel="force [N]", ylim=(0.0, None))
    speed.set(ylabel="scaled speed [mm/s]")
    friction.set(ylabel="friction read [–]", ylim=(0.0, None), xlabel="time since slip was first seen [ms]")
    figure.suptitle(_words(record) + ", finger 1", x=0.01, ha="left", color=STYLE.muted, fontsize=9.0)
    figure.align_ylabels()
    return figure


def _forces(axes: Axes, record: Record, finger: int, halted: np.ndarray) -> None:
    f_x, f_y, f_n, _ = record.wrenches[:, finger].T
    top = 1.05 * record.wrenches[..., 2].max()
    axes.fill_between(record.time, 0.0, top, where=halted, step="pre", color="#D5DBE0", linewidth=0)
    axes.plot(record.time, f_n, color=STYLE.palette[0], linewidth=0.9)
    axes.plot(record.time, np.hypot(f_x, f_y), color=STYLE.palette[1], linewidth=0.9)
    axes.set_ylim(0.0, top)


def _beside(axes: Axes, height: float, words: str, colour: str) -> None:
    """A label to the right of the panel."""
    place: dict[str, Any] = {"xycoords": axes.get_yaxis_transform(), "annotation_clip": False}
    note(axes, 1.01, height, words, colour, va="center", **place)


def _words(record: Record) -> str:
    """What was run."""
    words = [str(record.keys["material"])]
    if "distance" in record.keys:
        words.append(f"{1e3 * record.keys['distance']:.0f} mm in {record.keys['duration']:g} s")
    return ", ".join(words)
