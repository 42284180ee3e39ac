"""Draws a small plot over time into a picture."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from PIL import Image, ImageDraw

from slipgym.rendering.camera import FINE
from slipgym.rendering.palette import MUTED, RULE, Colour
from slipgym.rendering.text import write

_TICKS = 4  # intervals at most
_ABOVE = 4  # how far a curve may be beyond the plot's frame [pixels]


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
    """The parts (k, 2) of a line that are drawn; a point that is not finite breaks it.

    Args:
        points: (n, 2): x, which grows, and y [samples].
        dash: Length of dashes and gaps along x [samples]; 0 for none.
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
