"""Figures of an experiment."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from policies.evaluation.frames import groups, values
from policies.evaluation.gain import Gain
from policies.evaluation.plots.gain import plot_gain
from policies.evaluation.plots.outcome import outcome
from policies.evaluation.plots.style import STYLE, styled
from policies.evaluation.plots.tracking import plot_tracking
from slipgym.tasks import find


def draw(task: str, trials: pd.DataFrame, series: pd.DataFrame, folder: Path) -> None:
    """Draws the figures of a task into a folder, each policy on its own.

    The tables hold the trials, and the steps of the first ones, whose "row" is their row among the trials.
    """
    for (policy,), group in groups(trials, ["policy"]):
        slug = "".join(c if c.isalnum() else "_" for c in policy)
        with styled():
            figures = {"tracking": plot_tracking(task, group, series), **outcome(find(task), group)}
            for name, figure in figures.items():
                _save(figure, folder / f"{name}_{slug}.png")


def draw_gain(
    task: str, trials: pd.DataFrame, gain: Gain, episode: Sequence[Mapping[str, np.ndarray]], folder: Path
) -> None:
    """Draws `gain.png`; arguments as for `draw` and `plot_gain`."""
    has_limit = find(task).motion.axis is None and "tolerance_mm" in trials
    tolerance = float(values(trials, "tolerance_mm").max()) if has_limit else math.nan
    with styled():
        _save(plot_gain(task, gain, episode, tolerance), folder / "gain.png")


def _save(figure: Figure, path: Path) -> None:
    figure.savefig(path, dpi=STYLE.dpi)
