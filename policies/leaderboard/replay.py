"""Estimators on records, offline."""

from __future__ import annotations

from dataclasses import fields

import numpy as np

import estimator
from estimator.registry import specification
from slipgym.synthetic import Record


def replay(name: str, record: Record, latency: int, **parameters: object) -> np.ndarray:
    """Feeds every record to an estimator of its own.

    Args:
        name: Estimator.
        record: m records of n samples.
        latency: Age of a velocity [samples]; an estimator that asks for it (`velocity_delay`) is told.
        **parameters: Other parameters of the estimator.

    Returns:
        ESTIMATE array (m, n).
    """
    if any(field.name == "velocity_delay" for field in fields(specification(name).parameters)):
        parameters = {"velocity_delay": latency, **parameters}
    batch = estimator.make_batch(name, len(record.wrenches), **parameters)
    wrenches = np.ascontiguousarray(record.wrenches.swapaxes(0, 1))
    twists = np.ascontiguousarray(record.twists.swapaxes(0, 1))
    kept = np.empty((len(record.t), len(record.wrenches)), batch.estimates.dtype)
    for k, t in enumerate(record.t):
        batch.update(t, wrenches[k], twists[k])
        kept[k] = batch.estimates
    return kept.T
