"""Estimators on recorded trials."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

import estimator
from estimator.registry import specification
from lab.reproduction.records import Record

QUANTITIES = {"mu_c": "updates_mu_c", "mu_s": "events_mu_s", "r": "updates_r"}
"""Estimated quantity -> field of `Estimate` that counts what it has learnt from."""


@dataclass(frozen=True)
class Variant:
    """An estimator and how it is set."""

    title: str
    """Its name in tables and figures."""
    name: str
    """One of `estimator.names()`."""
    parameters: Mapping[str, Any] = field(default_factory=dict)
    """What differs from its defaults."""
    explores: bool = False
    """Whether it has heard an exploration when the trial begins."""


def variants(explore: bool = False) -> list[Variant]:
    """Every estimator at its defaults, the paper's first; one that halts by default also without.

    Args:
        explore: Whether one that halts by default comes also with an exploration.
    """
    found = []
    for name in sorted(estimator.names(), key=lambda name: name != "rls"):
        if getattr(specification(name).parameters.create(), "heuristic", False):
            found.append(Variant(f"{name}, no heuristic", name, {"heuristic": False}))
            found.append(Variant(f"{name}, heuristic", name))
            if explore:
                found.append(Variant(f"{name}, heuristic, explored", name, explores=True))
        else:
            found.append(Variant(name, name))
    return found


def estimates(record: Record, variant: Variant, exploration: Record | None = None) -> np.ndarray:
    """What both fingers' estimators publish after each sample of a record, ESTIMATE (T, 2).

    Args:
        record: The record.
        variant: The estimator.
        exploration: What it hears before, if it explores.
    """
    batch = estimator.make_batch(variant.name, 2, **variant.parameters)
    found = np.zeros((len(record.time), 2), batch.estimates.dtype)
    begin = 0.0
    if variant.explores and exploration is not None:
        for k, time in enumerate(exploration.time):
            batch.update(time, exploration.wrenches[k], exploration.twists[k])
        begin = exploration.time[-1]
    for k, time in enumerate(record.time):
        batch.update(begin + time, record.wrenches[k], record.twists[k])
        found[k] = batch.estimates
    return found


def explorations(records: Sequence[Record], kind: Mapping[str, Any]) -> list[Record]:
    """For each record another one of the same material that serves as the exploration before it.

    Args:
        records: Of all trials.
        kind: Keys of those that explore.

    Returns:
        They take turns; a record is its own exploration only where there is no other.
    """
    chosen = []
    for k, record in enumerate(records):
        material = record.keys["material"]
        able = [r for r in records if {**kind, "material": material}.items() <= r.keys.items()]
        others = [r for r in able if r is not record]
        chosen.append((others or able)[k % len(others or able)])
    return chosen


def rows(record: Record, variant: Variant, exploration: Record | None = None) -> Iterator[dict[str, Any]]:
    """One row for each quantity: its truth, and mean and standard deviation over time within the trial.

    Both run from a finger's first update to the trial's end, all samples alike, and are then averaged
    over the fingers; NaN if neither finger learnt anything. `last` is the value at the end.

    Args:
        record: The trial.
        variant: The estimator.
        exploration: What it hears before, if it explores; updates count from there.
    """
    found = estimates(record, variant, exploration)
    truth: dict[str, float] = dict(zip(("mu_s", "mu_c", "r"), record.truth.tolist(), strict=True))
    for quantity, count in QUANTITIES.items():
        learnt = [found[quantity][found[count][:, f] > 0, f] for f in range(2)]
        learnt = [series for series in learnt if len(series)]
        yield {
            **record.keys,
            "estimator": variant.title,
            "quantity": quantity,
            "true": truth[quantity],
            "mean": float(np.mean([series.mean() for series in learnt])) if learnt else np.nan,
            "within": float(np.mean([series.std() for series in learnt])) if learnt else np.nan,
            "last": float(np.mean([series[-1] for series in learnt])) if learnt else np.nan,
        }
