"""Draws three plots beside the view: grip force, slip and its reference, estimated and true friction."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from PIL import Image

from slipgym.rendering.camera import HEIGHT
from slipgym.rendering.discrepancy import Discrepancy
from slipgym.rendering.history import History
from slipgym.rendering.palette import GRIP, GRIP_2, INK, MU_C, MU_S, MUTED, PAPER, SLIP, Colour
from slipgym.rendering.plot import Curve, Plot, heading, limits
from slipgym.rendering.text import write
from slipgym.tasks.motion import Motion

WIDTH = 272
_LEFT, _RIGHT = 44, 254  # frame of the plots [pixels]
_TOP, _TALL, _PITCH = 32, 86, 129
_NOTES, _LINE = 418, 14  # baseline of the first note and their distance [pixels]


def draw_strip(history: History, motion: Motion, goal: float, off: Sequence[Discrepancy]) -> Image.Image:
    """Draw the plots of an episode so far, and why estimates are off; time runs to the end of the episode.

    Args:
        history: Recorded quantities of the episode.
        motion: The task's motion.
        goal: Final target of the path.
        off: Estimates that are off, and why.
    """
    picture = Image.new("RGB", (WIDTH, HEIGHT), PAPER)
    grip_1, grip_2, path, reference = map(history.column, ("grip_1", "grip_2", "path", "reference"))
    mu_c, mu_s, true_c, true_s = map(history.column, ("mu_c", "mu_s", "true_mu_c", "true_mu_s"))
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
    _panel(
        picture,
        2,
        history,
        "friction",
        [("mu_c", MU_C), ("mu_s", MU_S), ("dashed: true", MUTED)],
        [
            Curve(true_s, MU_S, 1.0, 4.0),
            Curve(true_c, MU_C, 1.0, 4.0),
            Curve(mu_s, MU_S, 1.2),
            Curve(mu_c, MU_C, 2.2),
        ],
        (1.2 * float(true_s[-1]), 0.1),
    )
    write(picture, _LEFT - 8, _TOP + 2 * _PITCH + _TALL + 16, "t [s]", MUTED, 11, align=1.0)
    _notes(picture, off)
    return picture


def _notes(picture: Image.Image, off: Sequence[Discrepancy]) -> None:
    """Two lines for each estimate that is off."""
    for k, (name, error, reason) in enumerate(off):
        y = _NOTES + 2 * k * _LINE
        write(picture, 12, y, f"{name}: {error}", MU_S if name == "mu_s" else MU_C, 12)
        write(picture, 12, y + _LINE, reason, MUTED, 12)


def _panel(
    picture: Image.Image,
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
