"""From the figures of every scenario to a ranking."""

from __future__ import annotations

import numpy as np
import pandas as pd

from policies.evaluation.frames import distinct, groups, values, where
from policies.leaderboard.scenario import FIELDS

FLOOR = 0.1  # [%]; smaller errors are not distinguished


def by_group(table: pd.DataFrame) -> pd.DataFrame:
    """Error of each quantity in each group, root mean square over its scenarios [%].

    Args:
        table: A row per scenario and estimator, with `group`, `estimator` and `error_...`.

    Returns:
        Columns `group`, `estimator`, `error_...`; NaN where a group does not evaluate a quantity.
    """
    rows = []
    for (group, name), scenarios in groups(table, ["group", "estimator"]):
        squares = {field: np.square(values(scenarios, f"error_{field}")) for field in FIELDS}
        rows.append((group, name, *(float(np.sqrt(squares[field].mean())) for field in FIELDS)))
    return pd.DataFrame(rows, columns=["group", "estimator", *(f"error_{field}" for field in FIELDS)])


def ranked(table: pd.DataFrame) -> pd.DataFrame:
    """One row per estimator, the one with the smallest worst case first.

    The worst case is the largest error of mu_c or r in a group. The typical error of a quantity is the
    geometric mean over the groups: a group counts as much as another, and half the error counts the same
    wherever it is. The score is the geometric mean of the three quantities' typical errors.

    Args:
        table: A row per scenario and estimator.

    Returns:
        `rank`, `estimator`, `worst` [%], `score` [%], `mu_c`, `r`, `mu_s`: typical errors [%];
        `calibration_...` [%] and `lock_ups` [%]: means over the scenarios that have them; `time_mu_c`: median
        over scenarios [s].
    """
    rows = []
    for (name,), errors in groups(by_group(table), ["estimator"]):
        mine = where(table, estimator=name)
        typical = {field: _geometric(values(errors, f"error_{field}")) for field in FIELDS}
        largest = [np.nanmax(values(errors, f"error_{field}"), initial=0.0) for field in ("mu_c", "r")]
        row = {"estimator": name, "worst": float(max(largest))}
        row |= {"score": _geometric(np.array(list(typical.values()))), **typical}
        row |= {f"calibration_{field}": 100.0 * _mean(mine, f"calibration_{field}") for field in FIELDS}
        row["time_mu_c"] = float(np.nanmedian(values(mine, "time_mu_c")))
        row["lock_ups"] = 100.0 * _mean(mine, "lock_ups")
        rows.append(row)
    found = pd.DataFrame(rows).sort_values(["worst", "score"], kind="stable", ignore_index=True)
    found.insert(0, "rank", range(1, len(found) + 1))
    return found


def winners(table: pd.DataFrame) -> pd.DataFrame:
    """The estimator with the smallest error of each quantity in each group; `group`, then `FIELDS`."""
    rows = []
    for (name,), errors in groups(by_group(table), ["group"]):
        row = {"group": name}
        for field in FIELDS:
            found = values(errors, f"error_{field}")
            row[field] = "–"
            if np.isfinite(found).any():
                best = int(np.nanargmin(found))
                row[field] = f"{distinct(errors, 'estimator')[best]} ({found[best]:.1f} %)"
        rows.append(row)
    return pd.DataFrame(rows)


def _geometric(errors: np.ndarray) -> float:
    """Geometric mean of errors [%], without NaN."""
    return float(np.exp(np.nanmean(np.log(np.maximum(errors, FLOOR)))))


def _mean(table: pd.DataFrame, column: str) -> float:
    """Mean of a column without NaN; NaN if there is nothing else."""
    found = values(table, column)
    return float(found[np.isfinite(found)].mean()) if np.isfinite(found).any() else np.nan
