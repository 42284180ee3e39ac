"""Recognises velocities that a log repeats in every row until the next one, and takes each of them once."""

from __future__ import annotations

import numpy as np

from estimator.records.record import Array, Rows

_ENOUGH = 20
"""Changes of the velocity from which its rate shows."""
_SIZES = 8
"""Distinct changes at least: a ramp in coarse counts changes by one count each time."""
_SHORT, _REGULAR = 0.05, 0.8
"""Quantile of the times between changes that is still longer than a row; share of them that fits a rate."""
_NEAR = 4
"""Periods between two changes up to which their number is certain."""


def held(t: Array, twist: Array) -> tuple[Rows, float] | None:
    """The rows in which a sensor delivered, if the velocities are held in the rows between.

    A held velocity never changes in two rows one after the other, and changes at multiples of a period. In
    stick, where all samples are zero, the rows are those at that period after the last change.

    Args:
        t: Increasing, (n,) [s].
        twist: (n, 3) [m/s, m/s, rad/s].

    Returns:
        Places of the rows, increasing, and the period [s]; None: the velocities are not held.
    """
    steps = np.diff(twist, axis=0)
    change = np.flatnonzero((steps != 0.0).any(axis=1)) + 1
    if len(change) <= _ENOUGH:
        return None
    row, apart = float(np.median(np.diff(t))), np.diff(t[change])
    short = np.quantile(apart, _SHORT)
    if short < 1.5 * row or len(np.unique(steps[change - 1].round(12), axis=0)) < _SIZES:
        return None
    period = float(apart[apart < 1.5 * short].mean())
    for _ in range(3):
        periods = np.maximum(np.round(apart / period), 1.0)
        near = periods <= _NEAR
        period = float(apart[near].sum() / periods[near].sum())
    off = np.abs(apart - periods * period)[near]
    if (off <= max(1.1 * row, 0.25 * period)).mean() < _REGULAR:
        return None
    begin = t[change[0]] - period * np.floor((t[change[0]] - t[0]) / period)
    starts = np.concatenate(([begin], t[change]))
    ends = np.concatenate((t[change], [t[-1] + period])) - 0.5 * period
    samples = [np.arange(start, end, period) for start, end in zip(starts, ends, strict=True)]
    at = np.unique(np.searchsorted(t, np.concatenate(samples) - 0.5 * row))
    return at[at < len(t)], period
