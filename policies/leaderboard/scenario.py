"""Defines a scenario: records, and the samples at which each quantity is evaluated."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from slipgym.synthetic import Record

FIELDS = ("mu_c", "r", "mu_s")
Evaluated = Mapping[str, np.ndarray]
"""Quantity of `FIELDS` -> samples at which it is evaluated, (n,) bool; missing: not observable there."""


@dataclass(frozen=True)
class Run:
    """One course, as m records."""

    record: Record
    evaluated: Evaluated


@dataclass(frozen=True)
class Scenario:
    """Records that all estimators are fed."""

    group: str
    """What it asks."""
    name: str
    """Which case of it."""
    runs: tuple[Run, ...]
    assumed: int = 1
    """Age of a velocity that an estimator assumes [samples]."""
    starts: Mapping[str, np.ndarray] = field(default_factory=dict)
    """Start value (`r0`, `mu_c0`) -> one for each of the m records; the first are the truth."""


def single(group: str, name: str, record: Record, at: np.ndarray) -> Scenario:
    """A scenario of one course, of which mu_c and r are evaluated at the same samples, (n,) bool."""
    return Scenario(group, name, (Run(record, {"mu_c": at, "r": at}),))


def in_slip(record: Record) -> Run:
    """A closed-loop trial, of which mu_c and mu_s are evaluated in slip after the first second."""
    moving = (record.phase == "slip") & after(record, 1.0)
    return Run(record, {"mu_c": moving, "mu_s": moving})


def ends(record: Record, *labels: str) -> np.ndarray:
    """The last sample of every phase with one of these labels, (n,) bool."""
    last = np.append(record.phase[1:] != record.phase[:-1], True)
    return last & np.isin(record.phase, labels)


def after(record: Record, seconds: float) -> np.ndarray:
    """The samples after a time, (n,) bool."""
    return record.t > seconds
