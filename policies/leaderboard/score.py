"""Scores an estimator in a scenario."""

from __future__ import annotations

import numpy as np

from policies.leaderboard.scenario import FIELDS, Run, Scenario

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
