"""Draws a small plot over time into a picture."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from slipgym.rendering.palette import INK, MUTED, RULE, Colour
from slipgym.rendering.raster import stroke, tint
from slipgym.rendering.text import breadth, write

_TICKS = 4  # intervals at most


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

    def draw(self, picture: np.ndarray, times: np.ndarray, curves: list[Curve], clock: bool) -> None:
        """Draw frame, labels and curves.

        Args:
            picture: (height, width, 3) uint8, drawn into.
            times: Of the curves' values, (n,) [s].
            curves: Curves; later ones are drawn over earlier ones.
            clock: Whether the time axis has labels.
        """
        step = spacing(self.high - self.low)
        for k in range(math.ceil(self.low / step - 1e-9), math.floor(self.high / step + 1e-9) + 1):
            y = round(self._y(k * step))
            picture[y, self.left : self.right] = MUTED if k == 0 else RULE
            write(picture, self.left - 6, y + 4, f"{k * step:g}", MUTED, 11, align=1.0)
        second = spacing(self.end)
        for k in range(math.floor(self.end / second + 1e-9) + 1):
            x = round(self._x(k * second))
            picture[self.bottom : self.bottom + 4, x] = MUTED
            if clock:
                write(picture, x, self.bottom + 16, f"{k * second:g}", MUTED, 11, align=0.5)
        picture[self.bottom, self.left : self.right] = MUTED
        for curve in curves:
            self._line(picture, times, curve)

    def _line(self, picture: np.ndarray, times: np.ndarray, curve: Curve) -> None:
        """One curve, and a dot where it ends if that is before the plot's end."""
        above = 4
        part = picture[self.top - above : self.bottom + above, self.left : self.right + above]
        mask = np.zeros(part.shape[:2])
        values, count = curve.values, len(curve.values)
        points = np.column_stack([self._x(times[:count]) - self.left, self._y(values) - self.top + above])
        stroke(points, curve.width, curve.dash, mask)
        if not curve.dash:
            stroke(points[[-1, -1]], 3.0 * curve.width, 0.0, mask)
        tint(part, mask, curve.colour)

    def _x(self, time: Any) -> Any:
        return self.left + (self.right - self.left) * np.asarray(time) / self.end

    def _y(self, value: Any) -> Any:
        return self.bottom - (self.bottom - self.top) * (np.asarray(value) - self.low) / (
            self.high - self.low
        )


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


def heading(
    picture: np.ndarray, left: int, right: int, y: int, title: str, keys: list[tuple[str, Colour]]
) -> None:
    """Draw a plot's title, and at the right its legend in the curves' colours."""
    write(picture, left, y, title, INK, 13)
    x = float(right)
    for words, colour in reversed(keys):
        write(picture, x, y, words, colour, 12, align=1.0)
        x -= 10.0 + breadth(words, 12)
