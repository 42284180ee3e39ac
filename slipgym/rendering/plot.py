"""Draws small plots over time beside the view: grip force, slip and its reference, friction."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from PIL import Image, ImageDraw

from slipgym.rendering.camera import DEFAULT, FINE, PICTURE_HEIGHT, Layout
from slipgym.rendering.discrepancy import Discrepancy
from slipgym.rendering.history import History
from slipgym.rendering.palette import GRIP, GRIP_2, INK, MU_C, MU_S, MUTED, PAPER, RULE, SLIP, Colour
from slipgym.rendering.text import breadth, write
from slipgym.tasks.motion import Motion

_TICKS = 4  # intervals at most
_ABOVE = 4  # how far a curve may be beyond the plot's frame [pixels]
_LEFT, _RIGHT = 44, 254  # frame of the plots; all in pixels of a picture of the usual size
_TOP, _TALL, _PITCH = 32, 86, 129
_NOTES, _LINE = 418, 14  # baseline of the first note and their distance


class Curve(NamedTuple):
    """One line of a plot."""

    values: np.ndarray
    """Values (n,), NaN for gaps; may be shorter than the plot's times."""
    colour: Colour
    width: float = 1.6
    """[pixels]."""
    dash: float = 0.0
    """Length of dashes and gaps [pixels]; 0 for none."""


@dataclass(frozen=True)
class Plot:
    """Position of a plot, and its scales."""

    left: int
    """Its frame [pixels]."""
    top: int
    right: int
    bottom: int
    end: float
    """Time at the right edge [s]; 0 is at the left one."""
    low: float
    """Value at the bottom."""
    high: float
    """Value at the top."""
    scale: float = 1.0
    """Size of words and lines."""

    def draw(self, picture: Image.Image, times: np.ndarray, curves: Sequence[Curve], clock: bool) -> None:
        """Draw frame, labels (with a clock those of time) and curves over times (n,) [s], in their order."""
        pen, step, scale = ImageDraw.Draw(picture), spacing(self.high - self.low), self.scale
        thin, above = max(1, round(scale)), round(_ABOVE * scale)
        for k in range(math.ceil(self.low / step - 1e-9), math.floor(self.high / step + 1e-9) + 1):
            y, words = round(self._y(k * step)), f"{k * step:g}"
            pen.line((self.left, y, self.right - 1, y), MUTED if k == 0 else RULE, thin)
            write(picture, self.left - 6 * scale, y + 4 * scale, words, MUTED, 11 * scale, align=1.0)
        second = spacing(self.end)
        for k in range(math.floor(self.end / second + 1e-9) + 1):
            x = round(self._x(k * second))
            pen.line((x, self.bottom, x, self.bottom + 3 * scale), MUTED, thin)
            if clock:
                write(picture, x, self.bottom + 16 * scale, f"{k * second:g}", MUTED, 11 * scale, align=0.5)
        pen.line((self.left, self.bottom, self.right - 1, self.bottom), MUTED, thin)
        frame = self.left, self.top - above, self.right + above, self.bottom + above
        part = picture.crop(frame)
        fine = part.resize((FINE * part.width, FINE * part.height), Image.Resampling.NEAREST)
        for curve in curves:
            self._line(ImageDraw.Draw(fine), times, curve)
        picture.paste(fine.reduce(FINE), frame)

    def _line(self, pen: ImageDraw.ImageDraw, times: np.ndarray, curve: Curve) -> None:
        """One curve, and a dot where it ends."""
        values, width = curve.values, round(FINE * self.scale * curve.width)
        points = np.column_stack([self._x(times[: len(values)]), self._y(values)])
        points = FINE * (points - (self.left, self.top - round(_ABOVE * self.scale)))
        for piece in pieces(points, FINE * self.scale * curve.dash):
            pen.line(piece.ravel().tolist(), fill=curve.colour, width=width)
        if not curve.dash and np.isfinite(points[-1]).all():
            pen.circle(points[-1].tolist(), 1.5 * width, fill=curve.colour)

    def _x(self, time: Any) -> Any:
        return self.left + (self.right - self.left) * np.asarray(time) / self.end

    def _y(self, value: Any) -> Any:
        share = (self.bottom - self.top) * (np.asarray(value) - self.low) / (self.high - self.low)
        return self.bottom - share


def pieces(points: np.ndarray, dash: float) -> list[np.ndarray]:
    """The parts (k, 2) of a line (n, 2) that are drawn; a point that is not finite breaks it.

    Dashes and gaps are measured along x, which grows [samples]; 0 for none.
    """
    drawn: Any = np.isfinite(points).all(axis=1)
    if dash and drawn.any():
        x = np.arange(np.nanmin(points[:, 0]), np.nanmax(points[:, 0]) + 1.0)
        points = np.column_stack([x, np.interp(x, points[:, 0], points[:, 1])])
        drawn = np.isfinite(points).all(axis=1) & (x // dash % 2 == 0)
    runs = np.split(np.arange(len(points)), np.flatnonzero(np.diff(drawn)) + 1)
    return [points[run] for run in runs if len(run) > 1 and drawn[run[0]]]


def spacing(span: float) -> float:
    """Distance of ticks: 1, 2 or 5 times a power of ten, at most `_TICKS` intervals in a span."""
    rough = span / _TICKS
    power = 10.0 ** math.floor(math.log10(rough))
    return next(power * k for k in (1, 2, 5, 10) if power * k >= rough * (1.0 - 1e-9))


def limits(values: list[np.ndarray], least: float) -> tuple[float, float]:
    """A range that holds zero, all finite values and `least`, rounded to half the distance of ticks."""
    every = np.concatenate([np.zeros(1), *(np.ravel(v) for v in values)])
    every = every[np.isfinite(every)]
    low, high = float(every.min()), max(least, float(every.max()))
    if low > -0.05 * high:  # noise about zero needs no axis of its own
        low = 0.0
    step = spacing(high - low) / 2
    return step * math.floor(low / step + 1e-9), step * math.ceil(high / step - 1e-9)


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
    more = (layout.height / scale - PICTURE_HEIGHT) / 3
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
        y = layout.height - scale * (PICTURE_HEIGHT - _NOTES - 2 * k * _LINE)
        lines = (f"{name}: {error}", MU_S if name == "mu_s" else MU_C), (reason, MUTED)
        for line, (words, colour) in enumerate(lines):
            size = 12 * scale * min(1.0, (layout.strip - 14 * scale) / breadth(words, 12 * scale))
            write(picture, 12 * scale, y + line * _LINE * scale, words, colour, size)
