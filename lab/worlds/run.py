"""Runs estimators in the worlds of many seeds and counts their errors."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from tqdm import tqdm

import estimator
from lab.worlds.draw import GROUPS, drawn
from lab.worlds.world import Record, simulate
from policies.evaluation.frames import values, where

FIRST = 10000
"""Least seed; those below are kept for the last word on an estimator."""
QUANTITIES = "mu_c", "mu_s", "r"
FAR, CLOSE = 0.25, 0.1
"""Relative errors that the table counts."""
SURE = 0.5
"""Confidence from which on an estimate would be acted on."""
UNTOUCHED = 0.02
"""Confidence up to which a deviation is that of the start value."""
BLIND = 3.0
"""Error over stated deviation of an estimate that misleads."""


def errors(
    first: int, last: int, estimators: Sequence[str] = (estimator.DEFAULT,), progress: bool = True
) -> pd.DataFrame:
    """Errors of estimators in the worlds of seeds; each is made by its name, with its own defaults.

    Args:
        first: First seed, at least `FIRST`.
        last: Seed after the last one.
        estimators: As `estimator.make` takes them.
        progress: Whether to show a progress bar.

    Returns:
        A row for each mark, estimator and quantity: `seed`, `group`, `motion`, `estimator`, `quantity`,
        `error` and `deviation` over the truth [-], `confidence` [-], `shown`: whether the motion shows the
        quantity. Worlds whose body falls out of the grip are left out.

    Raises:
        ValueError: A seed is too small, there is none, or an estimator is unknown.
    """
    if not FIRST <= first < last:
        raise ValueError(f"seeds {first} to {last}: expected {FIRST} <= FIRST < LAST")
    for name in estimators:
        estimator.make(name)
    rows = []
    for seed in tqdm(range(first, last), desc="worlds", disable=not progress):
        scenario = drawn(seed)
        record = simulate(scenario)
        if not record.sound:
            continue
        world = {"seed": seed, "group": scenario.group, "motion": scenario.motion}
        for name in estimators:
            found = replay(name, record)
            for mark, made in zip(record.marks, found, strict=True):
                for quantity in QUANTITIES:
                    truth = getattr(mark, quantity)
                    rows.append(
                        {
                            **world,
                            "estimator": name,
                            "quantity": quantity,
                            "error": abs(float(made[quantity]) / truth - 1.0),
                            "deviation": float(made[f"sd_{quantity}"]) / truth,
                            "confidence": float(made[f"confidence_{quantity}"]),
                            "shown": mark.shows(quantity),
                        }
                    )
    return pd.DataFrame(rows)


def replay(name: str, record: Record) -> NDArray[np.void]:
    """What an estimator states at the marks of a record: ESTIMATE (marks,)."""
    batch = estimator.make_batch(name, 1)
    at = [mark.sample for mark in record.marks]
    found = np.zeros(len(at), batch.estimates.dtype)
    for k, t in enumerate(record.t[: max(at) + 1].tolist()):
        batch.update(t, record.wrenches[k : k + 1], record.twists[k : k + 1])
        if k in at:
            found[at.index(k)] = batch.estimates[0]
    return found


def misleads(
    error: NDArray[np.float64], deviation: NDArray[np.float64], confidence: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Whether estimates are far off and do not say so: catastrophic errors.

    Args:
        error: Size of the error over the truth, (n,) [-].
        deviation: Stated deviation over the truth, (n,) [-].
        confidence: Stated confidence, (n,) [-].
    """
    return (error > FAR) & ((confidence > SURE) | (deviation < error / BLIND))


def table(found: pd.DataFrame) -> pd.DataFrame:
    """Shares and medians [%] of the errors that the motion shows.

    Args:
        found: Of `errors`.

    Returns:
        For each estimator and quantity a row over all worlds and one for each group: number of marks;
        catastrophic; median error; beyond 10 and 25 %; stated with confidence; of these the median error and
        those beyond 25 %; truth within one and two stated deviations, where there is a confidence at all.
    """
    rows = []
    for name in dict.fromkeys(found["estimator"]):
        for quantity in QUANTITIES:
            own = where(found, estimator=name, quantity=quantity, shown=True)
            for group in ("all", *GROUPS):
                some = own if group == "all" else where(own, group=group)
                rows.append({"estimator": name, "quantity": quantity, "worlds": group, **_figures(some)})
    return pd.DataFrame(rows)


def _figures(found: pd.DataFrame) -> dict[str, float]:
    error, deviation, confidence = (values(found, key) for key in ("error", "deviation", "confidence"))
    sure, stated = confidence > SURE, confidence > UNTOUCHED
    return {
        "marks": len(error),
        "catastrophic": _percent(misleads(error, deviation, confidence)),
        "median": 100.0 * float(np.median(error)) if len(error) else np.nan,
        "> 10": _percent(error > CLOSE),
        "> 25": _percent(error > FAR),
        "sure": _percent(sure),
        "sure: median": 100.0 * float(np.median(error[sure])) if sure.any() else np.nan,
        "sure: > 25": _percent(error[sure] > FAR),
        "in one sd": _percent((error <= deviation)[stated]),
        "in two sd": _percent((error <= 2.0 * deviation)[stated]),
    }


def _percent(true: NDArray[np.bool_]) -> float:
    return 100.0 * float(true.mean()) if true.size else np.nan
