"""Draws three plots beside the view: grip force, slip and its reference, estimated and true friction."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from PIL import Image

from slipgym.rendering.camera import DEFAULT
from slipgym.rendering.discrepancy import Discrepancy
from slipgym.rendering.history import History
from slipgym.rendering.layout import HEIGHT, STRIP, Layout
from slipgym.rendering.palette import GRIP, GRIP_2, INK, MU_C, MU_S, MUTED, PAPER, SLIP, Colour
from slipgym.rendering.plot import Curve, Plot, heading, limits
from slipgym.rendering.text import breadth, write
from slipgym.tasks.motion import Motion

WIDTH = STRIP
_LEFT, _RIGHT = 44, 254  # frame of the plots; all in pixels of a picture of the usual size
_TOP, _TALL, _PITCH = 32, 86, 129
_NOTES, _LINE = 418, 14  # baseline of the first note and their distance


def draw_strip(
    history: History,
    motion: Motion,
    goal: float,
    off: Sequence[Discrepancy],
    layout: Layout = DEFAULT,
) -> Image.Image:
    """Draw the plots of an episode so far, and why estimates are off; time runs to the end of the episode.

    Args:
        history: Recorded quantities of the episode.
        motion: The task's motion.
        goal: Final target of the path.
        off: Estimates that are off, and why.
        layout: Sizes of the picture; a higher one has higher plots.
    """
    picture = Image.new("RGB", (layout.strip, layout.height), PAPER)
    grip_1, grip_2, path, reference = map(history.column, ("grip_1", "grip_2", "path", "reference"))
    mu_c, mu_s, true_c, true_s = map(history.column, ("mu_c", "mu_s", "true_mu_c", "true_mu_s"))
    grips = [Curve(grip_2, GRIP_2, 3.2), Curve(grip_1, GRIP, 1.2)]
    paths = [Curve(path, SLIP, 2.0), Curve(reference, INK, 1.1, 4.0)]
    frictions = [
        Curve(true_s, MU_S, 1.0, 4.0),
        Curve(true_c, MU_C, 1.0, 4.0),
        Curve(mu_s, MU_S, 1.2),
        Curve(mu_c, MU_C, 2.2),
    ]
    fingers = [("finger 1", GRIP), ("finger 2", GRIP_2)]
    symbols = [("mu_c", MU_C), ("mu_s", MU_S), ("dashed: true", MUTED)]
    panels = (
        ("grip force [N]", fingers, grips, (0.0, 5.0)),
        (motion.title, [("dashed: reference", MUTED)], paths, (1.1 * goal, 1.0)),
        ("friction", symbols, frictions, (1.2 * float(true_s[-1]), 0.1)),
    )
    for number, (title, keys, curves, least) in enumerate(panels):
        _panel(picture, number, layout, history, title, keys, curves, least)
    _notes(picture, off, layout)
    return picture


def _notes(picture: Image.Image, off: Sequence[Discrepancy], layout: Layout) -> None:
    """Two lines for each estimate that is off."""
    scale = layout.scale
    for k, (name, error, reason) in enumerate(off):
        y = layout.height - scale * (HEIGHT - _NOTES - 2 * k * _LINE)
        lines = (f"{name}: {error}", MU_S if name == "mu_s" else MU_C), (reason, MUTED)
        for line, (words, colour) in enumerate(lines):
            size = 12 * scale * min(1.0, (layout.strip - 14 * scale) / breadth(words, 12 * scale))
            write(picture, 12 * scale, y + line * _LINE * scale, words, colour, size)


def _panel(
    picture: Image.Image,
    number: int,
    layout: Layout,
    history: History,
    title: str,
    keys: list[tuple[str, Colour]],
    curves: list[Curve],
    least: tuple[float, float],
) -> None:
    """One plot; its range holds the curves, the first of `least`, and upwards the second."""
    scale, more = layout.scale, (layout.height / layout.scale - HEIGHT) / 3
    top = _TOP + number * (_PITCH + more)
    left, upper, right, lower = (round(scale * at) for at in (_LEFT, top, _RIGHT, top + _TALL + more))
    low, high = limits([*(curve.values for curve in curves), np.array(least[:1])], least[1])
    plot = Plot(left, upper, right, lower, float(history.times[-1]), low, high, scale)
    heading(picture, 12 * scale, plot.right, plot.top - 12 * scale, title, keys, scale)
    plot.draw(picture, history.times, curves, clock=number == 2)
    if number == 2:
        write(picture, plot.left - 8 * scale, plot.bottom + 16 * scale, "t [s]", MUTED, 11 * scale, align=1.0)
