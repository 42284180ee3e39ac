"""All estimators on the same recorded episodes, in and out of the distribution of the training."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import Any

import numpy as np
import pandas as pd
from tqdm import tqdm

import estimator
from estimator.registry import specification
from lab.leaderboard.closed_loop import VALUES
from lab.learned_estimator.columns import RATE
from lab.learned_estimator.config import Training
from lab.learned_estimator.episodes import Recording, record
from policies.evaluation.frames import groups, values, where
from slipgym.config import load

LATENCY = "velocity_delay"
"""Parameter of an estimator: the latency of the slip velocity."""
MOVING = 3e-3
"""Measured speed from which a sample counts as slip, with 10 mm omega for a spin [m/s]."""
SLID = 30
"""Samples of slip in a recording before errors count: 0.25 s."""
FIRST_SEED = 500_000_000
"""Of the episodes; beyond those of any training with a seed below 500."""


def conditions(training: Training) -> dict[str, tuple[Sequence[str], dict[str, Any]]]:
    """Name -> tasks and arguments of the environments; the first is the distribution of the training.

    Args:
        training: How the network was trained.
    """
    own, lab = list(training.tasks), {"sensors": "lab", "randomization": "lab"}
    return {
        "as trained": (own, {"sensors": training.sensors, "randomization": dict(training.randomization)}),
        "preset lab": (own, lab),
        "task Hold": (["hold"], lab),
        "distributed contact": (own, {**lab, "contact": "distributed"}),
        "sensors realistic": (own, {"sensors": "realistic", "randomization": "train"}),
        "preset eval_ood": (own, {"sensors": "lab", "randomization": "eval_ood"}),
    }


def compare(
    training: Training,
    estimators: Mapping[str, tuple[str, Mapping[str, Any]]],
    rows: int = 32,
    steps: int = 480,
    seed: int = 0,
    progress: bool = True,
) -> pd.DataFrame:
    """Errors and calibration of estimators on recorded episodes of every condition.

    Args:
        training: How the network was trained.
        estimators: Label -> name and parameters.
        rows: Environments of each task.
        steps: Control steps of each.
        seed: Of the episodes, >= 0.
        progress: Whether to show a progress bar.

    Returns:
        A row per condition, estimator and quantity: `condition`, `quantity`, `estimator`; `median` and `p90`
        of the size of the relative error over the samples after `SLID` of slip [%]; `in 1 sd`, `in 2 sd`: of
        the samples at which the confidence is above 0 [%]; `known`: fraction of these among all [%].
    """
    found = []
    items = list(conditions(training).items())
    for k, (label, (tasks, arguments)) in enumerate(tqdm(items, desc="comparison", disable=not progress)):
        first = FIRST_SEED + 1_000_000 * seed + 100_000 * k
        recordings: list[Recording] = []
        for i, task in enumerate(tasks):
            recordings += record(task, rows, steps, first + 10_000 * i, friction_source="true", **arguments)
        latency = load(None, arguments["sensors"]).sensors.slip.latency_samples
        for name, (kind, parameters) in estimators.items():
            estimates = replay(kind, recordings, latency, parameters)
            for row in scores(estimates, recordings):
                found.append({"condition": label, "estimator": name, **row})
    return pd.DataFrame(found)


def wide(table: pd.DataFrame) -> pd.DataFrame:
    """A row per condition and estimator: median error, and what lies within one and two deviations [%].

    Args:
        table: From `compare`.
    """
    rows = []
    for (condition, name), part in groups(table, ["condition", "estimator"]):
        row: dict[str, Any] = {"condition": condition, "estimator": name}
        for quantity in ("mu_c", "r", "mu_s"):
            mine = where(part, quantity=quantity)
            row[f"{quantity} error"] = values(mine, "median")[0]
            row |= {f"{quantity} {key}": values(mine, key)[0] for key in ("in 1 sd", "in 2 sd")}
        rows.append(row)
    return pd.DataFrame(rows)


def replay(
    name: str, recordings: Sequence[Recording], latency: int, parameters: Mapping[str, Any]
) -> np.ndarray:
    """Feeds every recording to an estimator of its own.

    Args:
        name: Estimator.
        recordings: m recordings.
        latency: Latency of the slip sensor that the preset states [samples]; an estimator that has
            `velocity_delay` gets it, as in the environments.
        parameters: Of the estimator.

    Returns:
        ESTIMATE array (m, n), n samples of the longest; those after the end of a recording repeat its last.
    """
    if any(field.name == LATENCY for field in fields(specification(name).parameters)):
        parameters = {LATENCY: latency, **parameters}
    m, n = len(recordings), max(len(one.readings) for one in recordings)
    readings = np.full((n, m, 7), np.nan)
    for i, one in enumerate(recordings):
        readings[: len(one.readings), i] = one.readings
    batch = estimator.make_batch(name, m, **parameters)
    wrenches, twists = np.ascontiguousarray(readings[..., :4]), np.ascontiguousarray(readings[..., 4:])
    kept = np.empty((n, m), batch.estimates.dtype)
    for k in range(n):
        batch.update((k + 1) / RATE, wrenches[k], twists[k])
        kept[k] = batch.estimates
    return kept.T


def scores(estimates: np.ndarray, recordings: Sequence[Recording]) -> list[dict[str, Any]]:
    """Errors and calibration of mu_s, mu_c and r.

    Args:
        estimates: From `replay`, (m, n).
        recordings: The same m recordings.
    """
    n = estimates.shape[1]
    truth, slid = np.full((len(recordings), n, 3), np.nan), np.zeros(estimates.shape, bool)
    for i, one in enumerate(recordings):
        truth[i, : len(one.truth)] = one.truth
        twist = one.readings[:, 4:]
        speed = np.hypot(np.hypot(twist[:, 0], twist[:, 1]), 0.01 * twist[:, 2])
        slid[i, : len(speed)] = np.cumsum(speed > MOVING) > SLID
    exists = np.isfinite(truth[..., 0])
    found = []
    for k, name in enumerate(VALUES):
        true, stated = truth[..., k], estimates[name]
        errors = 100.0 * np.abs(stated / true - 1.0)[slid & exists]
        known = exists & (estimates[f"confidence_{name}"] > 0.0)
        off = np.abs(stated - true)[known] / estimates[f"sd_{name}"][known]
        median, most = np.percentile(errors, (50, 90)) if errors.size else (np.nan, np.nan)
        found.append(
            {
                "quantity": name,
                "median": float(median),
                "p90": float(most),
                "in 1 sd": 100.0 * float(np.mean(off <= 1.0)) if off.size else np.nan,
                "in 2 sd": 100.0 * float(np.mean(off <= 2.0)) if off.size else np.nan,
                "known": 100.0 * float(known.sum() / exists.sum()),
            }
        )
    return found
