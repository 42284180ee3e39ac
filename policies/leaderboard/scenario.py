"""Defines a scenario: records, and the samples at which each quantity is evaluated; scores estimators."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import NamedTuple

import numpy as np

import estimator
from estimator.registry import specification
from slipgym.synthetic import Record

FIELDS = ("mu_c", "r", "mu_s")


class Run(NamedTuple):
    """One course, as m records."""

    record: Record
    evaluated: Mapping[str, np.ndarray]
    """Quantity of `FIELDS` -> samples at which it is evaluated, (n,) bool; missing: not observable there."""


class Scenario(NamedTuple):
    """Records that all estimators are fed."""

    group: str
    """What it asks."""
    name: str
    """Which case of it."""
    runs: tuple[Run, ...]
    assumed: int = 1
    """Age of a velocity that an estimator assumes [samples]."""
    starts: Mapping[str, np.ndarray] = {}
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


FIGURES = ("bias", "spread", "error", "calibration", "time")
CLOSE = 0.05  # relative error
HELD = 24  # samples for which it must stay that close: 0.2 s


def score(scenario: Scenario, estimates: list[np.ndarray]) -> dict[str, float]:
    """Figures of one estimator in one scenario, from its ESTIMATE arrays (m, n) of each run.

    Returns:
        For each quantity of `FIELDS`, over all evaluated samples and records: `bias`, the mean relative
        error [%], `spread`, its standard deviation over records [%], `error`, its root mean square [%],
        `calibration` (share of truths within one stated deviation) [-]; `time` to 5 % [s], the median over
        records from the first slip, infinite if it is never that close for 0.2 s; `lock_ups`: share of start
        values that end over 5 % away, in mu_c or r, from what the true start value leads to [-].
        NaN where the scenario does not say.
    """
    found: dict[str, float] = {}
    for field in FIELDS:
        pairs = zip(scenario.runs, estimates, strict=True)
        evaluated = [(run, made) for run, made in pairs if field in run.evaluated]
        names = [f"{figure}_{field}" for figure in FIGURES]
        found |= dict.fromkeys(names, np.nan)
        if not evaluated:
            continue
        errors = np.concatenate([relative(run, made, field) for run, made in evaluated], axis=1)
        within = np.concatenate([stated(run, made, field) for run, made in evaluated], axis=1)
        times = np.concatenate([time_to_close(run, made, field) for run, made in evaluated])
        figures = (
            100.0 * errors.mean(),
            100.0 * np.sqrt(errors.var(axis=0).mean()),
            100.0 * np.sqrt(np.square(errors).mean()),
            within.mean(),
            np.median(times),
        )
        found |= dict(zip(names, map(float, figures), strict=True))
    found["lock_ups"] = lock_ups(scenario, estimates)
    return found


def relative(run: Run, estimates: np.ndarray, field: str) -> np.ndarray:
    """Relative errors at the evaluated samples, (m, k) [-]."""
    at = run.evaluated[field]
    return estimates[field][:, at] / getattr(run.record, field)[at] - 1.0


def stated(run: Run, estimates: np.ndarray, field: str) -> np.ndarray:
    """Whether the truth lies within one stated deviation at the evaluated samples, (m, k)."""
    at = run.evaluated[field]
    return np.abs(estimates[field][:, at] - getattr(run.record, field)[at]) <= estimates[f"sd_{field}"][:, at]


def time_to_close(run: Run, estimates: np.ndarray, field: str) -> np.ndarray:
    """Time from the first slip to the first 0.2 s of errors below 5 %, (m,) [s]; infinite: never."""
    record = run.record
    close = np.abs(estimates[field] / getattr(record, field) - 1.0) < CLOSE
    held = np.all(np.lib.stride_tricks.sliding_window_view(close, HELD, axis=1), axis=2)
    slid = int(np.argmax(~np.isin(record.phase, ("stop", "stick"))))
    held = held & (np.arange(held.shape[1]) >= slid)
    return np.where(held.any(axis=1), record.t[held.argmax(axis=1)] - record.t[slid], np.inf)


def lock_ups(scenario: Scenario, estimates: list[np.ndarray]) -> float:
    """Share of start values whose last estimate is over 5 % off that of the first, true one [-]."""
    if not scenario.starts:
        return np.nan
    last = np.array([[made[field][:, -1] for field in ("mu_c", "r")] for made in estimates])
    away = np.max(np.abs(last[..., 1:] / last[..., :1] - 1.0), axis=1)
    return float(np.mean(away > CLOSE))
