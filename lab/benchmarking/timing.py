"""Times two loops in short alternating blocks, for ratios."""

from __future__ import annotations

from collections.abc import Callable
from statistics import median, quantiles
from typing import NamedTuple


class Comparison(NamedTuple):
    """Two loops timed in turn."""

    first: float
    """Median time per step of the first [s]."""
    second: float
    """Median time per step of the second [s]."""
    quartiles: tuple[float, float, float]
    """Over the pairs of neighbouring blocks, of the second's time over the first's; the middle one is the
    ratio, the distance of the others says how disturbed the run was."""


Block = Callable[[], tuple[float, float]]
"""Runs for a short while; returns the time it took [s] and the steps it made."""


def compare(first: Block, second: Block, pairs: int) -> Comparison:
    """Time two loops in short alternating blocks, so that what else the machine does hits both alike."""
    times = []
    for _ in range(pairs):
        pair = []
        for block in (first, second):
            seconds, steps = block()
            pair.append(seconds / steps)
        times.append(pair)
    lower, middle, upper = quantiles((pair[1] / pair[0] for pair in times), method="inclusive")
    return Comparison(
        median(pair[0] for pair in times), median(pair[1] for pair in times), (lower, middle, upper)
    )
