"""Draws a log over what the simulation predicts before and after the fit."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from slipgym.identification.fit import Result
from slipgym.identification.rollout import CHANNELS

UNITS = ("N", "N", "N", "N m", "m/s", "m/s", "rad/s")


def draw(result: Result, path: Path) -> None:
    """Writes the picture, a row per reading."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    present = np.flatnonzero(~np.isnan(result.noise))
    t = np.arange(len(result.log.command)) / result.log.rate
    figure = Figure(figsize=(11, 1.7 * len(present)), layout="constrained")
    FigureCanvasAgg(figure)
    rows = figure.subplots(len(present), 1, sharex=True, squeeze=False)[:, 0]
    for axes, k in zip(rows, present, strict=True):
        there = np.isfinite(result.log.readings[:, k])
        axes.plot(t[there], result.log.readings[there, k], color="0.6", lw=2.0, label="log")
        axes.plot(t, result.before[:, k], color="tab:blue", lw=0.7, label="before")
        axes.plot(t, result.after[:, k], color="tab:red", lw=0.7, label="after")
        axes.set_ylabel(f"{CHANNELS[k]} [{UNITS[k]}]")
    rows[0].legend(ncols=3, loc="upper right")
    rows[-1].set_xlabel("time [s]")
    figure.savefig(path, dpi=90)
