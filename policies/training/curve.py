"""Learning curves: their points, and a picture of them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from policies.evaluation.plots.style import colours, note

_PANELS = (
    ("success", "solved [%]", 100.0),
    ("drops", "dropped [%]", 100.0),
    ("reward", "sum of rewards", 1.0),
)


@dataclass(frozen=True)
class Row:
    """One point of a learning curve, after some steps; means over the episodes of an evaluation.

    Attributes:
        success: Share of episodes solved.
        drops: Share of episodes in which the object was dropped.
        reward: Sum of rewards of an episode.
        length: Steps of an episode.
    """

    steps: int
    success: float
    drops: float
    reward: float
    length: float


def best(rows: Sequence[Row], episodes: int) -> Row:
    """The evaluation with the largest sum of rewards of those that solve as many episodes as any, to noise.

    Noise is a standard error of the largest share solved so far (the one-standard-error rule of Breiman et
    al., Classification and Regression Trees, 1984): more is luck of one among many evaluations. What is the
    best of the first k evaluations is found without the later ones.

    There must be a row, and each be of as many episodes.
    """
    chosen, most = rows[0], 0.0
    for row in rows:
        most = max(most, row.success)
        least = most - _standard_error(most, episodes)
        if chosen.success < least or (row.success >= least and row.reward > chosen.reward):
            chosen = row
    return chosen


def _standard_error(share: float, episodes: int) -> float:
    """Of a share, after Agresti and Coull: two episodes of either kind more, so that 1 has one, too."""
    n = episodes + 4
    middle = (share * episodes + 2) / n
    return math.sqrt(middle * (1.0 - middle) / n)


def plot(curves: Mapping[str, Sequence[Sequence[Row]]]) -> Figure:
    """Success, drops and rewards over steps: of each condition its seeds' curves thin, their mean bold."""
    figure = Figure(figsize=(8.4, 2.8))
    panels = figure.subplots(1, len(_PANELS), sharex=True)
    shades = colours(list(curves))
    for axes, (name, label, scale) in zip(panels, _PANELS, strict=True):
        for condition, seeds in curves.items():
            points = [[(row.steps, scale * getattr(row, name)) for row in rows] for rows in seeds]
            _lines(axes, points, shades[condition])
        axes.set_ylabel(label)
        if scale == 100.0:
            axes.set_ylim(-3.0, 103.0)
    if len(curves) > 1:
        for k, (condition, colour) in enumerate(shades.items()):
            note(panels[1], 0.03, 0.97 - 0.08 * k, condition, colour, xycoords="axes fraction", va="top")
    figure.supxlabel("steps", fontsize=9.0)
    return figure


def _lines(axes: Axes, seeds: Sequence[Sequence[tuple[int, float]]], colour: str) -> None:
    """A line for each seed and their mean."""
    several = len(seeds) > 1
    look = {"alpha": 0.35 if several else 1.0, "linewidth": 0.8 if several else 1.4, "color": colour}
    for points in seeds:
        axes.plot(*np.array(points).T, marker="o" if len(points) == 1 else None, **look)
    if several:
        common = sorted(set.intersection(*({steps for steps, _ in points} for points in seeds)))
        means = [np.mean([dict(points)[steps] for points in seeds]) for steps in common]
        axes.plot(common, means, color=colour)
    axes.xaxis.set_major_formatter(
        lambda steps, _: f"{steps / 1e6:g} M" if steps >= 1e6 else f"{steps / 1e3:g} k"
    )
