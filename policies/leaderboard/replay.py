"""Estimators on records, offline."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields

import numpy as np

import estimator
from estimator.registry import specification
from slipgym.synthetic import Record


def replay(
    name: str,
    record: Record,
    latency: int,
    starts: Mapping[str, np.ndarray] | None = None,
    **parameters: object,
) -> np.ndarray:
    """Feeds every record to an estimator of its own.

    Args:
        name: Estimator.
        record: m records of n samples.
        latency: Age of a velocity [samples]; an estimator that has a `velocity_delay` gets it.
        starts: Parameter -> its value for each record, (m,); such as `r0`.
        **parameters: Other parameters of the estimator.

    Returns:
        ESTIMATE array (m, n).
    """
    if any(field.name == "velocity_delay" for field in fields(specification(name).parameters)):
        parameters = {"velocity_delay": latency, **parameters}
    m, n = record.wrenches.shape[:2]
    batch = estimator.make_batch(name, m, **parameters)
    batch.parameters_array = np.repeat(batch.parameters_array, m)
    for field, values in (starts or {}).items():
        batch.parameters_array[field] = values
    batch.reset()
    wrenches = np.ascontiguousarray(record.wrenches.swapaxes(0, 1))
    twists = np.ascontiguousarray(record.twists.swapaxes(0, 1))
    kept = np.empty((n, m), batch.estimates.dtype)
    for k, t in enumerate(record.t.tolist()):
        batch.update(t, wrenches[k], twists[k])
        kept[k] = batch.estimates
    return kept.T
