"""Plots a run over time: forces, slip speed, friction, radius."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from estimator.records.alignment import GAP_PERIODS, period
from estimator.records.extras import extra
from estimator.records.record import Array
from estimator.records.run import Result

# of Okabe and Ito, and Tol: the colour-blind tell them apart
_BLUE, _VERMILION, _GREEN, _PURPLE = "#0072B2", "#D55E00", "#009E73", "#AA4499"
_INK, _MUTED, _BAND = "#222222", "#767676", "#E3E8EE"
_RC: Any = {
    "figure.facecolor": "white",
    "figure.constrained_layout.use": True,
    "font.size": 9.0,
    "axes.edgecolor": _MUTED,
    "axes.labelcolor": _INK,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.color": _MUTED,
    "ytick.color": _MUTED,
    "xtick.labelcolor": _INK,
    "ytick.labelcolor": _INK,
    "lines.linewidth": 1.4,
    "lines.solid_capstyle": "round",
}
_NAMES = "mu_s", "mu_c", "r"
_DOTS = 10_000  # parts of which the extremes are drawn
_TOP_FRICTION = 1.0  # start values above it are cut off once data has taken over


def plot(result: Result) -> Any:
    """A matplotlib figure of four panels over one time axis; halts are shaded, truth is dashed.

    Raises:
        ModuleNotFoundError: The extra `slipgym[cli]` is not installed.
    """
    matplotlib = extra("matplotlib")
    result, clock = _near_zero(result)
    with matplotlib.rc_context(_RC):
        figure = extra("matplotlib.figure").Figure(figsize=(8.4, 7.4))
        panels = figure.subplots(4, 1, sharex=True, height_ratios=(1.15, 1.0, 1.3, 0.8))
        for axes, draw in zip(panels, (_forces, _speed, _friction, _radius), strict=True):
            _shade_halts(axes, result)
            draw(axes, result)
        _name_halts(panels[0], result)
        panels[-1].set_xlabel(clock)
        first, last = result.samples.t[[0, -1]]
        panels[-1].set_xlim(0.0 if 0.0 <= first < 0.05 * last else first, last)
        changed = [f"{name} {value}" for name, value in result.given.items()]
        title = "   ·   ".join([result.record.name, f"estimator {result.estimator}", *changed])
        figure.suptitle(title, x=0.01, ha="left", fontsize=9.0, color=_MUTED)
        figure.align_ylabels()
    return figure


def _near_zero(result: Result) -> tuple[Result, str]:
    """The result on a clock that can be read, not in seconds since 1970, and the name of that clock."""
    record, samples = result.record, result.samples
    start = min(record.force_t[0], samples.t[0])
    if abs(start) <= 10.0 * (samples.t[-1] - start):
        return result, "time [s]"
    record, samples = replace(record, force_t=record.force_t - start), replace(samples, t=samples.t - start)
    return replace(result, record=record, samples=samples), "time since the start [s]"


def _forces(axes: Any, result: Result) -> None:
    record = result.record
    tangential = np.hypot(record.wrench[:, 0], record.wrench[:, 1])
    _line(axes, record.force_t, record.wrench[:, 2], color=_INK, linewidth=1.0)
    _line(axes, record.force_t, tangential, color=_BLUE, linewidth=1.0)
    axes.set_ylabel("force [N]")
    axes.set_ylim(bottom=min(0.0, float(record.wrench[:, 2].min())))
    _beside(axes, {"normal": (record.wrench[-1, 2], _INK), "tangential": (tangential[-1], _BLUE)})


def _speed(axes: Any, result: Result) -> None:
    samples, r = result.samples, result.estimates["r"]
    sliding = 1e3 * np.hypot(samples.twist[:, 0], samples.twist[:, 1])
    turning = 1e3 * np.abs(r * samples.twist[:, 2])
    _line(axes, samples.t, sliding, color=_BLUE, linewidth=1.1)
    _line(axes, samples.t, turning, color=_PURPLE, linewidth=1.1)
    axes.set_ylabel("slip speed [mm/s]")
    axes.set_ylim(bottom=0.0)
    _beside(axes, {"sliding": (sliding[-1], _BLUE), "turning, r|ω|": (turning[-1], _PURPLE)})


def _friction(axes: Any, result: Result) -> None:
    estimates = result.estimates
    labels = {}
    for k, (name, symbol, colour) in enumerate((("mu_s", "μ$_s$", _GREEN), ("mu_c", "μ$_c$", _VERMILION))):
        known = _estimate(axes, result, k, 1.0, colour)
        value = f"{estimates[name][-1]:.3f}" if known else "not observed"
        labels[f"{symbol} {value}"] = (estimates[name][-1], colour)
    axes.set_ylabel("friction [–]")
    settled = max(float(np.median(estimates[name])) for name in ("mu_s", "mu_c"))
    top = max(estimates["mu_s"].max(), estimates["mu_c"].max())
    axes.set_ylim(0.0, 1.08 * min(top, max(_TOP_FRICTION, 1.6 * settled)))
    _beside(axes, labels)


def _radius(axes: Any, result: Result) -> None:
    r = 1e3 * result.estimates["r"]
    known = _estimate(axes, result, 2, 1e3, _PURPLE)
    axes.set_ylabel("radius [mm]")
    true = 0.0 if result.samples.truth is None else 1e3 * np.nan_to_num(result.samples.truth[:, 2]).max()
    axes.set_ylim(0.0, 1.15 * max(r.max(), true))
    _beside(axes, {f"r {r[-1]:.1f}" if known else "r not observed": (r[-1], _PURPLE)})


def _estimate(axes: Any, result: Result, k: int, scale: float, colour: str) -> bool:
    """Draws a value, pale while it is the start value, and its truth; whether data stands behind the last."""
    name, t, truth = _NAMES[k], result.samples.t, result.samples.truth
    value = scale * result.estimates[name]
    known = result.estimates[f"confidence_{name}"] > 0.0
    _line(axes, t, np.where(known, np.nan, value), color=colour, alpha=0.35, drawstyle="steps-post")
    _line(axes, t, np.where(known, value, np.nan), color=colour, drawstyle="steps-post")
    if truth is not None:
        _line(axes, t, scale * truth[:, k], color=colour, linestyle="--", linewidth=1.0)
    return bool(known[-1])


def _line(axes: Any, t: Array, values: Array, **style: Any) -> None:
    """Draws a line that breaks where the record has a gap; of a long one, the extremes."""
    t, values = _extremes(t, values)
    gaps = np.flatnonzero(np.diff(t) > GAP_PERIODS * period(t)) + 1
    axes.plot(np.insert(t, gaps, np.nan), np.insert(values, gaps, np.nan), **style)


def _extremes(t: Array, values: Array) -> tuple[Array, Array]:
    """The smallest and the largest of neighbouring values (n,), where there are more than a picture shows."""
    size = len(t) // _DOTS
    if size < 2:
        return t, values
    n = len(t) // size * size
    parts = np.where(np.isnan(values[:n]), 0.0, values[:n]).reshape(-1, size)
    starts = np.arange(0, n, size)
    ends = starts + size - 1  # so that gaps stay where they are
    at = np.stack((starts, starts + parts.argmin(axis=1), starts + parts.argmax(axis=1), ends))
    at = np.unique(np.append(at, np.arange(n, len(t))))
    return t[at], values[at]


def _shade_halts(axes: Any, result: Result) -> None:
    t, halted = _extremes(result.samples.t, result.estimates["halted"].astype(np.float64))
    style: Any = {"step": "post", "color": _BAND, "linewidth": 0, "zorder": 0}
    axes.fill_between(t, 0.0, 1.0, where=halted > 0.0, transform=axes.get_xaxis_transform(), **style)


def _name_halts(axes: Any, result: Result) -> None:
    words = ["shaded: halted by the heuristic"] if result.estimates["halted"].any() else []
    started = any((result.estimates[f"confidence_{name}"] == 0.0).any() for name in _NAMES)
    words += ["pale: start value"] if started else []
    words += ["dashed: truth"] if result.samples.truth is not None else []
    axes.set_title("   ·   ".join(words), loc="right", fontsize=8.0, color=_MUTED)


def _beside(axes: Any, labels: dict[str, tuple[float, str]]) -> None:
    """Names lines at the right end of the axes, moved apart where they would touch."""
    low, high = axes.get_ylim()
    room = 0.13 * (high - low)
    lowest = low + 0.3 * room
    for words, (value, colour) in sorted(labels.items(), key=lambda item: item[1][0]):
        at = max(float(np.clip(value, low, high)), lowest)
        lowest = at + room
        axes.annotate(
            f" {words}",
            (1.0, at),
            xycoords=axes.get_yaxis_transform(),
            color=colour,
            fontsize=8.5,
            va="center",
            annotation_clip=False,
        )
