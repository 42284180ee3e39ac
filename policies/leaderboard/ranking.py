"""From the figures of every scenario to a ranking."""

from __future__ import annotations

import numpy as np
import pandas as pd

from policies.evaluation.frames import groups, values, where
from policies.leaderboard.scenario import FIELDS

FLOOR = 0.1  # [%]; smaller errors are not distinguished


def by_group(table: pd.DataFrame) -> pd.DataFrame:
    """Error of each quantity in each group, root mean square over its scenarios [%].

    The table has a row per scenario and estimator, what is returned one per group and estimator; NaN where a
    group does not evaluate a quantity.
    """
    errors = [f"error_{field}" for field in FIELDS]
    scenarios = table.groupby(["group", "estimator"], sort=False)[errors]
    return scenarios.agg(lambda found: np.sqrt(np.mean(np.square(np.asarray(found))))).reset_index()


def ranked(table: pd.DataFrame) -> pd.DataFrame:
    """One row per estimator, the one with the smallest worst case first, from one per scenario and estimator.

    The worst case is the largest error of mu_c or r in a group. The typical error of a quantity is the
    geometric mean over the groups: a group counts as much as another, and half the error counts the same
    wherever it is. The score is the geometric mean of the three quantities' typical errors.

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
        row |= {f"calibration_{field}": 100.0 * mine[f"calibration_{field}"].mean() for field in FIELDS}
        row["time_mu_c"] = float(np.nanmedian(values(mine, "time_mu_c")))
        row["lock_ups"] = 100.0 * mine["lock_ups"].mean()
        rows.append(row)
    found = pd.DataFrame(rows).sort_values(["worst", "score"], kind="stable", ignore_index=True)
    found.insert(0, "rank", range(1, len(found) + 1))
    return found


def winners(table: pd.DataFrame) -> pd.DataFrame:
    """The estimator with the smallest error of each quantity in each group; `group`, then `FIELDS`."""
    rows, columns = [], {field: f"error_{field}" for field in FIELDS}
    for (name,), errors in groups(by_group(table).set_index("estimator"), ["group"]):
        best = {field: _best(pd.Series(errors[column])) for field, column in columns.items()}
        rows.append({"group": name, **best})
    return pd.DataFrame(rows)


def _best(errors: pd.Series) -> str:
    """The name of the smallest error and the error [%]; a dash without any."""
    return "–" if errors.isna().all() else f"{errors.idxmin()} ({errors.min():.1f} %)"


def _geometric(errors: np.ndarray) -> float:
    """Geometric mean of errors [%], without NaN."""
    return float(np.exp(np.nanmean(np.log(np.maximum(errors, FLOOR)))))
