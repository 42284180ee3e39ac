"""Pairs each velocity sample with the newest force."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from estimator.records.record import Array, Record, seconds, twist_at

GAP_PERIODS = 5.0
"""Sample periods without a sample that make a gap."""


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


def align(record: Record, allow_gaps: bool = False) -> Samples:
    """Resamples the forces at the times of the velocities.

    Args:
        record: The record.
        allow_gaps: Whether to go on after a gap, in a new segment.

    Raises:
        ValueError: There is a gap, or fewer than 2 velocity samples have a force.
    """
    velocity_limit = GAP_PERIODS * period(record.twist_t)
    force_limit = max(GAP_PERIODS * period(record.force_t), period(record.twist_t))
    if not allow_gaps:
        _refuse_gaps(record.name, "velocity", record.twist_t, velocity_limit)
        _refuse_gaps(record.name, "force", record.force_t, force_limit)
    at = newest(record.force_t, record.twist_t)
    kept = np.flatnonzero((at >= 0) & (record.twist_t - record.force_t[at] <= force_limit))
    if len(kept) < 2:
        raise ValueError(
            f"{record.name}: {len(kept)} velocity samples have a force at or before them; "
            f"at least 2 are needed. Forces {_span(record.force_t)}, "
            f"velocities {_span(record.twist_t)}: on one clock?"
        )
    t, at = record.twist_t[kept], at[kept]
    force_gaps = np.cumsum(np.diff(record.force_t, prepend=record.force_t[0]) > force_limit)
    breaks = (np.diff(t) > velocity_limit) | (np.diff(force_gaps[at]) > 0)
    twist = record.twist[kept]
    return Samples(
        t=t,
        wrench=record.wrench[at],
        twist=twist if record.cop is None else twist_at(twist, record.cop[at]),
        truth=None if record.truth is None else record.truth[at],
        segment=np.concatenate(([0], np.cumsum(breaks))),
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
