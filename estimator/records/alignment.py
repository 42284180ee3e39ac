"""Pairs each velocity sample with the newest force, and takes velocities that a log repeats once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from estimator.records.record import Array, Record, Rows, seconds, twist_at

GAP_PERIODS = 5.0
"""Sample periods without a sample that make a gap."""
_ENOUGH = 20
"""Changes of the velocity from which its rate shows."""
_SIZES = 8
"""Distinct changes at least: a ramp in coarse counts changes by one count each time."""
_SHORT, _REGULAR = 0.05, 0.8
"""Quantile of the times between changes that is still longer than a row; share of them that fits a rate."""
_NEAR = 4
"""Periods between two changes up to which their number is certain."""


class Limits(NamedTuple):
    """Longest times without a sample that are no gap [s]."""

    force: float
    velocity: float

    @classmethod
    def of(cls, force_period: float, velocity_period: float) -> Self:
        """By the usual times between two samples [s]."""
        return cls(max(GAP_PERIODS * force_period, velocity_period), GAP_PERIODS * velocity_period)


class Pairs(NamedTuple):
    """The velocity samples that have a force, and what separates them."""

    kept: NDArray[np.int64]
    """Their places among the velocities, (k,)."""
    at: NDArray[np.int64]
    """Places of their forces, (k,)."""
    gaps: NDArray[np.int64]
    """Gaps in the forces before each force, (n,)."""
    fresh: NDArray[np.bool_]
    """Where an estimator starts afresh, (k,)."""


@dataclass(frozen=True)
class Samples:
    """The inputs of the estimator, one row for each velocity sample that has a force."""

    t: Array
    """(k,) [s]."""
    wrench: Array
    """Newest f_x, f_y, f_n, tau at the CoP, (k, 4) [N, N, N, N m]."""
    twist: Array
    """v_x, v_y, omega at the CoP, (k, 3) [m/s, m/s, rad/s]."""
    truth: Array | None
    """mu_s, mu_c, r, (k, 3) [-, -, m]; None if the record has none."""
    segment: NDArray[np.int64]
    """Counts up after each gap, (k,)."""
    left_out: int
    """Velocity samples without a force that is new enough."""


def newest(force_t: Array, t: Array) -> NDArray[np.int64]:
    """Places (m,) of the newest force at or before each time t (m,) [s]; -1 where there is none yet."""
    return np.searchsorted(force_t, t, side="right") - 1


def pair(force_t: Array, twist_t: Array, limits: Limits, last: tuple[float, int] | None = None) -> Pairs:
    """Pairs velocities with the newest force: the whole of a record, or the next piece of a stream.

    Args:
        force_t: Increasing, (n,) [s], n > 0.
        twist_t: Increasing, (m,) [s].
        limits: What is a gap.
        last: Of the sample before, the time [s] and the gaps before its force; None: there is none.
    """
    at = newest(force_t, twist_t)
    kept = np.flatnonzero((at >= 0) & (twist_t - force_t[at] <= limits.force))
    gaps, at = np.zeros(len(force_t), np.int64), at[kept]
    np.cumsum(force_t[1:] - force_t[:-1] > limits.force, out=gaps[1:])
    t, before, fresh = twist_t[kept], gaps[at], np.zeros(len(kept), bool)
    fresh[1:] = (t[1:] - t[:-1] > limits.velocity) | (before[1:] > before[:-1])
    if last and len(t):
        fresh[0] = t[0] - last[0] > limits.velocity or before[0] > last[1]
    return Pairs(kept, at, gaps, fresh)


def align(record: Record, allow_gaps: bool = False) -> Samples:
    """Resamples the forces at the times of the velocities; with `allow_gaps` a gap begins a new segment.

    Raises:
        ValueError: There is a gap, or fewer than 2 velocity samples have a force.
    """
    limits = Limits.of(*(record.periods or (period(record.force_t), period(record.twist_t))))
    if not allow_gaps:
        _refuse_gaps(record.name, "velocity", record.twist_t, limits.velocity)
        _refuse_gaps(record.name, "force", record.force_t, limits.force)
    kept, at, _, fresh = pair(record.force_t, record.twist_t, limits)
    if len(kept) < 2:
        raise ValueError(
            f"{record.name}: {len(kept)} velocity samples have a force at or before them; "
            f"at least 2 are needed. Forces {_span(record.force_t)}, "
            f"velocities {_span(record.twist_t)}: on one clock?"
        )
    twist = record.twist[kept]
    return Samples(
        t=record.twist_t[kept],
        wrench=record.wrench[at],
        twist=twist if record.cop is None else twist_at(twist, record.cop[at]),
        truth=None if record.truth is None else record.truth[at],
        segment=np.cumsum(fresh, dtype=np.int64),
        left_out=len(record.twist_t) - len(kept),
    )


def period(t: Array) -> float:
    """Usual time between two samples [s]."""
    return float(np.median(np.diff(t)))


def _refuse_gaps(source: str, what: str, t: Array, limit: float) -> None:
    at = np.flatnonzero(np.diff(t) > limit)
    if len(at):
        where = ", ".join(f"{seconds(t[k])} to {seconds(t[k + 1])} s" for k in at[:5])
        more = f" and {len(at) - 5} more" if len(at) > 5 else ""
        raise ValueError(
            f"{source}: no {what} for more than {1e3 * limit:.3g} ms: {where}{more}; "
            "--allow-gaps starts the estimator afresh after each"
        )


def _span(t: Array) -> str:
    return f"{seconds(t[0])} to {seconds(t[-1])} s"


def held(t: Array, twist: Array) -> tuple[Rows, float] | None:
    """Places of the rows in which a sensor delivered, if the velocities are held between, and its period [s].

    A held velocity never changes in two rows one after the other, and changes at multiples of a period. In
    stick, where all samples are zero, the rows are those at that period after the last change.

    Args:
        t: Increasing, (n,) [s].
        twist: (n, 3) [m/s, m/s, rad/s].
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
