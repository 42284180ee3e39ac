"""Runs an estimator over a record."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from estimator.batch import make_batch
from estimator.estimate import ESTIMATE
from estimator.parameters import Parameters
from estimator.records.alignment import Samples, align
from estimator.records.calibration import CALIBRATES, Calibration, calibration
from estimator.records.record import Record
from estimator.registry import DEFAULT


@dataclass(frozen=True)
class Result:
    """A record with its estimates."""

    record: Record
    """The record as read."""
    samples: Samples
    """The inputs of the estimator, (k,) rows."""
    estimates: np.ndarray
    """Its output at each of them, ESTIMATE (k,)."""
    estimator: str
    """Its name."""
    parameters: Parameters
    """All its parameters."""
    given: Mapping[str, Any] = field(default_factory=dict)
    """The parameters that were given."""
    calibration: Calibration | None = None
    """What it found out about the sensors; None: it does not look for that."""


def estimate(record: Record, estimator: str = DEFAULT, allow_gaps: bool = False, **parameters: Any) -> Result:
    """Runs an estimator over a record, once per velocity sample with the newest force at or before it.

    Args:
        record: From `load`.
        estimator: One of `estimator.names()`.
        allow_gaps: Whether to go on after a gap, with the estimator reset.
        **parameters: Parameters of the estimator.

    Raises:
        ValueError: The estimator or a parameter is unknown, a value is out of range, there is a gap, or the
            two streams do not overlap.
    """
    finger = make_batch(estimator, 1, **parameters)
    samples = align(record, allow_gaps)
    estimates = np.zeros(len(samples.t), ESTIMATE)
    timing = finger.states["timing"] if estimator == CALIBRATES else np.zeros(1)
    segment, correlation = samples.segment[0], 0.0
    for k, t in enumerate(samples.t):
        if samples.segment[k] != segment:
            segment, correlation = samples.segment[k], 0.0
            finger.reset()
        finger.update(t, samples.wrench[k : k + 1], samples.twist[k : k + 1])
        estimates[k] = finger.estimates[0]
        correlation = max(correlation, float(timing[0]))
    found = None
    if estimator == CALIBRATES:
        f_n = samples.wrench[samples.segment == segment, 2]
        found = calibration(finger.states[0], finger.parameters, correlation, f_n)
    return Result(record, samples, estimates, estimator, finger.parameters, parameters, found)
