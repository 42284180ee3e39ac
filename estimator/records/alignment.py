"""Pairs each velocity sample with the newest force."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from estimator.records.record import Array, Record, seconds, twist_at

GAP_PERIODS = 5.0
"""Sample periods without a sample that make a gap."""


class Limits(NamedTuple):
    """Longest times without a sample that are no gap."""

    force: float
    """[s]."""
    velocity: float
    """[s]."""

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
    """The newest force at or before each time.

    Args:
        force_t: Increasing, (n,) [s].
        t: (m,) [s].

    Returns:
        Index into force_t, (m,); -1 where there is none yet.
    """
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
    """Resamples the forces at the times of the velocities.

    Args:
        record: The record.
        allow_gaps: Whether to go on after a gap, in a new segment.

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
