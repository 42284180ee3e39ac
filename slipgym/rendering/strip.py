"""Draws three plots beside the view: grip force, slip and its reference, estimated and true friction."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from PIL import Image

from slipgym.rendering.camera import DEFAULT
from slipgym.rendering.discrepancy import Discrepancy
from slipgym.rendering.history import History
from slipgym.rendering.layout import HEIGHT, STRIP, Layout
from slipgym.rendering.palette import GRIP, GRIP_2, INK, MU_C, MU_S, MUTED, PAPER, SLIP
from slipgym.rendering.plot import Curve, Plot, limits
from slipgym.rendering.text import breadth, write
from slipgym.tasks.motion import Motion

WIDTH = STRIP
_LEFT, _RIGHT = 44, 254  # frame of the plots; all in pixels of a picture of the usual size
_TOP, _TALL, _PITCH = 32, 86, 129
_NOTES, _LINE = 418, 14  # baseline of the first note and their distance


def draw_strip(
    history: History, motion: Motion, goal: float, off: Sequence[Discrepancy], layout: Layout = DEFAULT
) -> Image.Image:
    """Draw the plots of an episode so far and why estimates are off; a higher picture has higher plots.

    The range of the path's plot holds its final target `goal` [mm or degrees].
    """
    picture, scale = Image.new("RGB", (layout.strip, layout.height), PAPER), layout.scale

    def curve(name: str, *style: Any) -> Curve:
        return Curve(history.column(name), *style)

    grips = curve("grip_2", GRIP_2, 3.2), curve("grip_1", GRIP, 1.2)
    paths = curve("path", SLIP, 2.0), curve("reference", INK, 1.1, 4.0)
    true = curve("true_mu_s", MU_S, 1.0, 4.0), curve("true_mu_c", MU_C, 1.0, 4.0)
    frictions = *true, curve("mu_s", MU_S, 1.2), curve("mu_c", MU_C, 2.2)
    fingers = ("finger 2", GRIP_2), ("finger 1", GRIP)
    symbols = ("dashed: true", MUTED), ("mu_s", MU_S), ("mu_c", MU_C)
    panels = (  # the last two: a value that the plot's range holds, and what it holds upwards
        ("grip force [N]", fingers, grips, 0.0, 5.0),
        (motion.title, (("dashed: reference", MUTED),), paths, 1.1 * goal, 1.0),
        ("friction", symbols, frictions, 1.2 * float(true[0].values[-1]), 0.1),
    )
    more = (layout.height / scale - HEIGHT) / 3
    for number, (title, keys, curves, held, least) in enumerate(panels):
        top = _TOP + number * (_PITCH + more)
        left, upper, right, lower = (round(scale * at) for at in (_LEFT, top, _RIGHT, top + _TALL + more))
        low, high = limits([*(each.values for each in curves), np.array([held])], least)
        plot = Plot(left, upper, right, lower, float(history.times[-1]), low, high, scale)
        x, y = float(right), upper - 12 * scale
        write(picture, 12 * scale, y, title, INK, 13 * scale)
        for words, colour in keys:  # from the right
            write(picture, x, y, words, colour, 12 * scale, align=1.0)
            x -= 10.0 * scale + breadth(words, 12 * scale)
        plot.draw(picture, history.times, curves, clock=number == 2)
        if number == 2:
            write(picture, left - 8 * scale, lower + 16 * scale, "t [s]", MUTED, 11 * scale, align=1.0)
    _write_notes(picture, off, layout)
    return picture


def _write_notes(picture: Image.Image, off: Sequence[Discrepancy], layout: Layout) -> None:
    """Two lines for each estimate that is off."""
    scale = layout.scale
    for k, (name, error, reason) in enumerate(off):
        y = layout.height - scale * (HEIGHT - _NOTES - 2 * k * _LINE)
        lines = (f"{name}: {error}", MU_S if name == "mu_s" else MU_C), (reason, MUTED)
        for line, (words, colour) in enumerate(lines):
            size = 12 * scale * min(1.0, (layout.strip - 14 * scale) / breadth(words, 12 * scale))
            write(picture, 12 * scale, y + line * _LINE * scale, words, colour, size)
