"""Compares an estimator's error with that of the best of the published four in each log, with intervals."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd

from policies.evaluation.frames import where

FOUR = "ukf", "disc", "joint", "rls"
"""Estimators whose best one is the measure."""
COMPARED = "adaptive", *FOUR
RESOLVED = 3.0
"""Excess [percent points] that counts as a difference."""
INTERVAL = 0.025, 0.975
REFERENCES = {"mu_c": "mu_c from the fit", "r": "r from geometry", "r_fitted": "r from the fitted lengths"}
"""Column of `deviations` -> what it is."""


def excesses(found: pd.DataFrame, quantity: str) -> dict[str, dict[str, np.ndarray]]:
    """Size of the deviation less that of the best of the four, in the same resample.

    Args:
        found: Of `lab.pushes.run.deviations`.
        quantity: A key of `REFERENCES`.

    Returns:
        Log -> estimator of `COMPARED` -> (1 + number,) [percent points], first that of the log as it is.
    """
    result = {}
    for log in dict.fromkeys(found["log"]):
        own = {row["estimator"]: np.abs(row[quantity]) for row in where(found, log=log).to_dict("records")}
        best = np.min([own[name] for name in FOUR], axis=0)
        result[log] = {name: own[name] - best for name in COMPARED}
    return result


def beyond_best(found: pd.DataFrame, quantity: str) -> pd.DataFrame:
    """A row for each log: the best of the four, the resamples in which it is [%], each one's excess.

    Brackets hold bootstrap intervals of 95 %, of the excess over the best of each resample.
    """
    rows = []
    for log, own in excesses(found, quantity).items():
        best = min(FOUR, key=lambda name: float(own[name][0]))
        kept = 100.0 * float(np.mean(own[best][1:] == 0.0))
        rows.append({"log": log, "best": best, "in [%]": f"{kept:.0f}", **_cells(own)})
    return pd.DataFrame(rows)


def _cells(own: Mapping[str, np.ndarray]) -> dict[str, str]:
    cells = {}
    for name, excess in own.items():
        figures = np.round([excess[0], *np.quantile(excess[1:], INTERVAL)]) + 0.0  # no negative zero
        value, low, high = (f"{figure:.0f}".replace("-", "−") for figure in figures)
        cells[name] = f"{value} [{low}, {high}]"
    return cells


def within_best(found: pd.DataFrame) -> pd.DataFrame:
    """How many logs of each estimator and reference are farther off than the best of the four.

    Returns:
        `reference`, `estimator`; `beyond`: logs with an excess above `RESOLVED`; `resolved`: those of them
        whose interval lies above it; `largest` excess [percent points].
    """
    rows = []
    for quantity, meaning in REFERENCES.items():
        of_logs = list(excesses(found, quantity).values())
        for name in COMPARED:
            own = [excess[name] for excess in of_logs]
            beyond = [excess for excess in own if excess[0] > RESOLVED]
            resolved = [excess for excess in beyond if np.quantile(excess[1:], INTERVAL[0]) > RESOLVED]
            largest = max(float(excess[0]) for excess in own)
            counts = f"{len(beyond)} of {len(own)}", str(len(resolved))
            rows.append((meaning, name, *counts, largest))
    return pd.DataFrame(rows, columns=["reference", "estimator", "beyond", "resolved", "largest"])
