"""The paper's nine columns per material, ours and theirs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from lab.reproduction.published import TABLES, TITLES
from lab.reproduction.rerun import QUANTITIES
from policies.evaluation.frames import distinct, groups, values, where

_HEADINGS = [
    f"{text}{unit}"
    for symbol, unit in (("mu_c", ""), ("mu_s", ""), ("r", " [mm]"))
    for text in (f"{symbol}", f"{symbol} between", f"{symbol} within")
]
_SAMPLES = {
    "moving": ("samples called moving", "{:.0f}", 1.0),
    "stuck_share": ("of these stuck [%]", "{:.0f}", 100.0),
    "f_n_stuck": ("mean f_n, stuck [N]", "{:.1f}", 1.0),
    "f_n_sliding": ("mean f_n, sliding [N]", "{:.1f}", 1.0),
    "weight_stuck": ("weight of the stuck [%]", "{:.0f}", 100.0),
    "fit_all": ("fit over all / true mu_c", "{:.2f}", 1.0),
    "fit_sliding": ("fit over sliding / true mu_c", "{:.2f}", 1.0),
    "slips": ("slips", "{:.0f}", 1.0),
    "slip_ms": ("mean length [ms]", "{:.0f}", 1.0),
    "rise_N_s": ("median fastest rise of f_n [N/s]", "{:.0f}", 1.0),
    "fast_share": ("of the slips above eps_delta [%]", "{:.0f}", 100.0),
    "gamma_t": ("median true gamma_t, sliding", "{:.2f}", 1.0),
    "slid_mm": ("slid at the end [mm]", "{:.1f}", 1.0),
    "turned_deg": ("turned at the end [°]", "{:.1f}", 1.0),
}


def nine_columns(trials: pd.DataFrame) -> pd.DataFrame:
    """For each material, estimator and quantity what the paper's table holds, and the error of the mean.

    Args:
        trials: Rows of `rerun.rows`.

    Returns:
        Columns material, estimator, quantity, true, n (trials that learnt it), mean (of the trials' means),
        between (their standard deviation), within (mean of the deviations within a trial), error and
        last_error (of the mean and of the mean last value, relative to the truth).
    """
    found = []
    for (material, estimator, quantity), group in groups(trials, ["material", "estimator", "quantity"]):
        true = values(group, "true")[0]
        means, within, last = (values(group, column) for column in ("mean", "within", "last"))
        learnt = ~np.isnan(means)
        mean = _mean(means[learnt])
        found.append(
            {
                "material": material,
                "estimator": estimator,
                "quantity": quantity,
                "true": true,
                "n": learnt.sum(),
                "mean": mean,
                "between": means[learnt].std(ddof=1) if learnt.sum() > 1 else np.nan,
                "within": _mean(within[learnt]),
                "error": mean / true - 1.0,
                "last_error": _mean(last[learnt]) / true - 1.0,
            }
        )
    return pd.DataFrame(found)


def markdown(table: pd.DataFrame, experiment: str) -> str:
    """The nine columns beside the paper's, and the errors, as two Markdown tables.

    Args:
        table: From `nine_columns`.
        experiment: A key of `published.TABLES`.
    """
    lines, errors = [], []
    for material in distinct(table, "material"):
        own = where(table, material=material)
        for title, numbers in zip(TITLES, TABLES[experiment][material], strict=True):
            lines.append([material, title, *_cells(numbers)])
        for (estimator,), group in groups(own, ["estimator"]):
            by_quantity = [where(group, quantity=q) for q in QUANTITIES]
            numbers = [values(q, c)[0] for q in by_quantity for c in ("mean", "between", "within")]
            lines.append([material, estimator, *_cells(numbers)])
            percent = [f"{100 * values(q, c)[0]:+.1f}" for q in by_quantity for c in ("error", "last_error")]
            errors.append([material, estimator, *(p.replace("+nan", "–") for p in percent)])
        truth = [values(where(own, quantity=q), "true")[0] for q in QUANTITIES]
        lines.append([material, "true", *_cells([x for t in truth for x in (t, np.nan, np.nan)])])
    error_headings = [f"{q}, {when} [%]" for q in QUANTITIES for when in ("mean", "last")]
    return "\n\n".join(
        [
            grid(["material", "estimator", *_HEADINGS], lines),
            "## Errors against the truth",
            grid(["material", "estimator", *error_headings], errors),
        ]
    )


def mechanism_markdown(samples: pd.DataFrame) -> str:
    """What the samples called moving are made of, a column for each material.

    Args:
        samples: A row per material, from `mechanism.summary`.
    """
    lines = []
    for column, (heading, form, scale) in _SAMPLES.items():
        numbers = (form.format(scale * value) for value in values(samples, column))
        lines.append([heading, *("–" if number == "nan" else number for number in numbers)])
    return grid(["", *distinct(samples, "material")], lines)


def _mean(series: np.ndarray) -> float:
    return series.mean().item() if len(series) else np.nan


def _cells(numbers: Sequence[float]) -> list[str]:
    """Nine numbers as text: friction with three digits, r in mm with one; a dash for none."""
    texts = [f"{x:.3f}" if k < 6 else f"{1e3 * x:.1f}" for k, x in enumerate(numbers)]
    return ["–" if text == "nan" else text for text in texts]


def grid(headings: list[str], lines: list[list[str]]) -> str:
    """A Markdown table whose columns but the first are aligned to the right."""
    rule = [":---" if k < 1 else "---:" for k in range(len(headings))]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in (headings, rule, *lines))
