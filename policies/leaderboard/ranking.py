"""From the figures of every scenario to a ranking and a picture."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from policies.evaluation.frames import groups, values, where
from policies.evaluation.plots.style import COLOURS, STYLE, heat, note, places
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


TITLES = {"mu_c": "μ$_c$", "r": "r", "mu_s": "μ$_s$"}
NORM = LogNorm(0.5, 100.0, clip=True)  # of errors [%]


def plot_leaderboard(table: pd.DataFrame, ranking: pd.DataFrame) -> Figure:
    """A panel for each quantity: estimators, the best on top, by scenarios; numbers are errors in %.

    The table has a row per scenario and estimator, the ranking one per estimator, the best first.
    """
    names = list(ranking["estimator"])
    scenarios = list(dict.fromkeys(zip(table["group"], table["scenario"], strict=True)))
    at = places([group for group, _ in scenarios], 0.35)
    figure = Figure(figsize=(0.44 * at[-1] + 2.4, 0.36 * len(FIELDS) * len(names) + 2.6))
    panels = figure.subplots(len(FIELDS), 1, sharex=True)
    labels = [f"{k}  {name}" for k, name in enumerate(names, start=1)]
    for ax, field in zip(panels, FIELDS, strict=True):
        grid = table.pivot(index="estimator", columns=["group", "scenario"], values=f"error_{field}")
        errors = grid.loc[names, scenarios].to_numpy()
        heat(ax, errors, at, labels, NORM, _words, smallest=True)
        ax.set_xlim(at[0] - 0.6, at[-1] + 1.8)
        for row, value in enumerate(ranking[field]):
            ax.text(at[-1] + 1.2, row, f"{value:.1f}", ha="center", va="center", weight="bold", size=8)
        ax.set_title(f"{TITLES[field]}: error [%]", fontsize=10)
    _groups(panels[0], scenarios, at)
    names_below = [*(name for _, name in scenarios), "typical"]
    slanted = {"rotation": 60, "ha": "right", "rotation_mode": "anchor"}
    panels[-1].set_xticks([*at, at[-1] + 1.2], names_below, **slanted)
    scale = ScalarMappable(NORM, COLOURS.reversed())
    bar = figure.colorbar(scale, ax=panels, shrink=0.6, aspect=30, pad=0.01)
    bar.set_ticks([0.5, 1, 2, 5, 10, 20, 50, 100], labels=["0.5 %", "1", "2", "5", "10", "20", "50", "100"])
    bar.outline.set_visible(False)  # type: ignore[operator]
    return figure


def _words(error: float) -> str:
    return f"{error:.1f}" if error < 9.95 else f"{error:.0f}"


def _groups(ax: Axes, scenarios: list[tuple[str, str]], at: np.ndarray) -> None:
    """The groups' names over the first panel."""
    groups = [group for group, _ in scenarios]
    above = {"xycoords": ax.get_xaxis_transform(), "textcoords": "offset points", "xytext": (0, 20)}
    for group in dict.fromkeys(groups):
        middle = at[[name == group for name in groups]].mean()
        words = group.replace(" ", "\n")
        note(ax, middle, 1.0, words, STYLE.muted, fontsize=8.5, ha="center", va="bottom", **above)
