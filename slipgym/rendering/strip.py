"""Draws three plots beside the view: grip force, slip and its reference, estimated and true friction."""

from __future__ import annotations

import numpy as np

from slipgym.rendering.history import History
from slipgym.rendering.palette import GRIP, GRIP_2, INK, MU_C, MU_S, MUTED, PAPER, SLIP, Colour
from slipgym.rendering.plot import Curve, Plot, heading, limits
from slipgym.rendering.text import write
from slipgym.tasks.motion import Motion

WIDTH = 272
_LEFT, _RIGHT = 44, 254  # frame of the plots [pixels]
_TOP, _TALL, _PITCH = 34, 102, 146


def draw_strip(
    picture: np.ndarray, history: History, motion: Motion, goal: float, true: tuple[float, float]
) -> None:
    """Draw the plots of an episode so far; time runs to the end of the episode.

    Args:
        picture: (height, WIDTH, 3) uint8, drawn over.
        history: Recorded quantities of the episode.
        motion: The task's motion.
        goal: Final target of the path.
        true: True mu_s and mu_c.
    """
    picture[:] = PAPER
    grip_1, grip_2, path, reference, mu_c, mu_s = map(
        history.column, ("grip_1", "grip_2", "path", "reference", "mu_c", "mu_s")
    )
    level = np.ones(len(history.rows))
    _panel(
        picture,
        0,
        history,
        "grip force [N]",
        [("finger 1", GRIP), ("finger 2", GRIP_2)],
        [Curve(grip_2, GRIP_2, 3.2), Curve(grip_1, GRIP, 1.2)],
        (0.0, 5.0),
    )
    _panel(
        picture,
        1,
        history,
        motion.title,
        [("dashed: reference", MUTED)],
        [Curve(path, SLIP, 2.0), Curve(reference, INK, 1.1, 4.0)],
        (1.1 * goal, 1.0),
    )
    true_s, true_c = true
    _panel(
        picture,
        2,
        history,
        "friction",
        [("mu_c", MU_C), ("mu_s", MU_S), ("dashed: true", MUTED)],
        [
            Curve(true_s * level, MU_S, 1.0, 4.0),
            Curve(true_c * level, MU_C, 1.0, 4.0),
            Curve(mu_s, MU_S, 1.2),
            Curve(mu_c, MU_C, 2.2),
        ],
        (1.2 * true_s, 0.1),
    )
    if not np.isfinite([mu_c, mu_s]).any():
        write(
            picture, (_LEFT + _RIGHT) / 2, _TOP + 2 * _PITCH + _TALL - 12, "no estimate yet", MUTED, 12, 0.5
        )
    write(picture, (_LEFT + _RIGHT) / 2, _TOP + 2 * _PITCH + _TALL + 32, "time [s]", MUTED, 12, align=0.5)


def _panel(
    picture: np.ndarray,
    number: int,
    history: History,
    title: str,
    keys: list[tuple[str, Colour]],
    curves: list[Curve],
    least: tuple[float, float],
) -> None:
    """One plot; its range holds the curves, the first of `least`, and upwards the second."""
    top = _TOP + number * _PITCH
    low, high = limits([*(curve.values for curve in curves), np.array(least[:1])], least[1])
    heading(picture, 12, _RIGHT, top - 12, title, keys)
    plot = Plot(_LEFT, top, _RIGHT, top + _TALL, float(history.times[-1]), low, high)
    plot.draw(picture, history.times, curves, clock=number == 2)
