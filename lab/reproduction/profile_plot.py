"""Figure of the velocity profile: slip, and estimates against the truth."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from policies.evaluation.plots.style import STYLE, colours, note
from policies.leaderboard.profile_course import STOP
from slipgym.synthetic import Trace

PANELS = (("mu_c", "μ$_c$ [–]", 1.0, (0.25, 0.62)), ("r", "r [mm]", 1e3, (4.0, 14.0)))
STATIC = ("mu_s", "μ$_s$ [–]", 1.0, (0.3, 0.85))


def plot_profile(trace: Trace, shown: Mapping[str, np.ndarray], expected: np.ndarray) -> Figure:
    """Slip on top, then gamma_t and the normal force, then mu_c, r and mu_s.

    Args:
        trace: What happened.
        shown: Estimator -> its estimates, (n,).
        expected: Relative errors of mu_c and r by the ellipsoid, (n, 2).
    """
    figure = Figure(figsize=(9.0, 9.4))
    axes = figure.subplots(5, 1, sharex=True, height_ratios=(1.0, 0.8, 1.5, 1.5, 1.2))
    for ax in axes:
        _shade_stops(ax, trace)
    _slip(axes[0], trace)
    _share(axes[1], trace)
    for ax, panel, column in zip(axes[2:4], PANELS, range(2), strict=True):
        _estimates(ax, trace, shown, *panel)
        field, _, scale, _ = panel
        truth = scale * getattr(trace, field)
        ax.plot(trace.t, truth * (1.0 + expected[:, column]), ":", color=STYLE.ink, linewidth=1.6)
    _estimates(axes[4], trace, shown, *STATIC)
    axes[2].plot([], [], ":", color=STYLE.ink, linewidth=1.6, label="ellipsoid on this disc, predicted")
    handles = axes[2].get_legend_handles_labels()
    figure.legend(*handles, loc="outside upper center", ncols=len(handles[0]))
    axes[-1].set_xlabel("time [s]")
    figure.align_ylabels()
    return figure


def _shade_stops(ax: Axes, trace: Trace) -> None:
    stopped = np.append(np.append(False, trace.phase == STOP), False)
    edges = np.flatnonzero(stopped[1:] != stopped[:-1])
    times = np.append(0.0, trace.t)
    for begin, end in edges.reshape(-1, 2).tolist():
        ax.axvspan(float(times[begin]), float(times[end]), color=STYLE.band, linewidth=0, zorder=0)


def _slip(ax: Axes, trace: Trace) -> None:
    """Velocities, and the names of the phases above."""
    v_t, v_r = np.hypot(*trace.twist[:, :2].T), trace.r * trace.twist[:, 2]
    ax.plot(trace.t, 1e3 * v_t, color=STYLE.ink, label="v$_t$")
    ax.plot(trace.t, 1e3 * v_r, color=STYLE.muted, linestyle="--", label="r ω")
    ax.set(ylabel="slip [mm/s]", ylim=(0.0, 26.0))
    ax.legend(loc="upper right", bbox_to_anchor=(1.0, 1.25), ncols=2)
    starts = np.flatnonzero(np.append(True, trace.phase[1:] != trace.phase[:-1]))
    for begin, end in zip(starts, [*starts[1:], len(trace.t)], strict=True):
        if trace.phase[begin] != STOP:
            middle = 0.5 * (trace.t[begin] + trace.t[end - 1])
            note(ax, middle, 23.0, trace.phase[begin], STYLE.ink, ha="center")


def _share(ax: Axes, trace: Trace) -> None:
    """Share of translation, and the normal force."""
    v_t, v_r = np.hypot(*trace.twist[:, :2].T), trace.r * trace.twist[:, 2]
    with np.errstate(invalid="ignore"):
        ax.plot(trace.t, v_t / np.hypot(v_t, v_r), color=STYLE.ink)
    ax.set(ylabel="γ$_t$ [–]", ylim=(-0.05, 1.1))
    right = ax.twinx()
    right.plot(trace.t, trace.normal, color=STYLE.muted, linestyle="--")
    right.set(ylabel="f$_n$ [N], dashed", ylim=(0.0, 6.6))
    right.spines["right"].set_visible(True)


def _estimates(
    ax: Axes,
    trace: Trace,
    shown: Mapping[str, np.ndarray],
    field: str,
    label: str,
    scale: float,
    limits: tuple[float, float],
) -> None:
    ax.plot(trace.t, scale * getattr(trace, field), color=STYLE.ink, linewidth=1.2, label="true")
    palette = colours(list(shown))
    for name, estimates in shown.items():
        ax.plot(trace.t, scale * estimates[field], color=palette[name], label=name)
    ax.set(ylabel=label, ylim=limits)
