"""The summary of a table of trials."""

from __future__ import annotations

import numpy as np
import pandas as pd

from policies.evaluation.columns import Metric
from policies.evaluation.frames import by_metric, distinct, groups, values, where
from policies.evaluation.metrics import measures
from policies.evaluation.statistics import Interval, mean_interval, share_interval

KEYS = ["policy", "friction"]
PAIR = ["policy", "material", "options", "trial"]
COLUMNS = [*KEYS, "material", "metric", "n", "value", "low", "high"]
FRICTION = ("true_mu_c", "cruise_mu_c", "final_mu_c", "true_mu_s", "final_mu_s", "true_r_mm", "final_r_mm")


def summarise(trials: pd.DataFrame, task: str) -> pd.DataFrame:
    """Every measure of every policy and friction choice, over all trials and by material.

    Args:
        trials: The table of trials.
        task: The task they ran.

    Returns:
        Columns `COLUMNS`: value with its interval low to high; material is "all" for all trials, metric
        "difference of ..." for the mean over pairs of what a friction choice has over the first one. What
        all trials lack has no row.
    """
    metrics = [
        m for m in measures(task).summary if not np.isnan(values(trials, m.column).astype(float)).all()
    ]
    metrics += [Metric(c, "") for c in FRICTION if c in trials]
    rows = []
    for whole in (True, False):
        grouped = trials.assign(material="all") if whole else trials
        for keys, group in groups(grouped, [*KEYS, "material"]):
            rows += [(*keys, m.column, len(group), *interval(group, m)) for m in metrics]
    rows += differences(trials, measures(task).compared)
    return pd.DataFrame(rows, columns=COLUMNS)


def interval(trials: pd.DataFrame, metric: Metric) -> Interval:
    """A measure over some trials."""
    found = values(trials, metric.column)
    return share_interval(int(found.sum()), len(found)) if metric.share else mean_interval(found)


def differences(trials: pd.DataFrame, metric: Metric) -> list[tuple]:
    """Mean over pairs of trials of the same seed: what a friction choice has over the first one.

    Args:
        trials: The table of trials.
        metric: The measure to compare by.
    """
    rows = []
    for (policy,), group in groups(trials, ["policy"]):
        first, *others = distinct(group, "friction")
        paired = group.pivot(index=PAIR, columns="friction", values=metric.column)
        for other in others:
            difference = values(paired, other) - values(paired, first)
            name = f"difference of {metric.column}"
            rows.append((policy, other, "all", name, len(difference), *mean_interval(difference)))
    return rows


def markdown(summary: pd.DataFrame, task: str, n_trials: int) -> str:
    """The summary as a page.

    Args:
        summary: From `summarise`.
        task: The task.
        n_trials: How many trials stand behind it.
    """
    overall = where(summary, material="all")
    there = set(summary["metric"])
    headings = {m.column: m.heading for m in measures(task).summary if m.column in there}
    estimated = [column for column in FRICTION if column in there]
    parts = [
        f"# {task}: {n_trials} trials",
        "Means with 95 % confidence intervals (BCa bootstrap; shares: Wilson).",
        grid(overall, headings),
    ]
    compared = measures(task).compared
    paired = where(overall, metric=f"difference of {compared.column}")
    if len(paired):
        first = distinct(overall, "friction")[0]
        parts += [
            f"## Against {first!r}, trial by trial",
            grid(paired, {f"difference of {compared.column}": f"difference of {compared.heading}"}),
        ]
    parts += [
        "## Estimated friction by material",
        "Mean of both fingers: over the cruise of the reference, and at the end.",
        grid(
            summary.loc[values(summary, "material") != "all"],
            {c: _words(c) for c in estimated},
            by_material=True,
        ),
    ]
    return "\n\n".join(parts) + "\n"


def grid(rows: pd.DataFrame, headings: dict[str, str], by_material: bool = False) -> str:
    """A Markdown table with a column per metric.

    Args:
        rows: Of a summary.
        headings: Metric -> heading.
        by_material: Whether the material is a column too.
    """
    keys = [*KEYS, "material"] if by_material else KEYS
    lines = [
        "| " + " | ".join([*keys, *headings.values()]) + " |",
        "|" + " --- |" * len(keys) + " ---: |" * len(headings),
    ]
    for key, group in groups(rows, keys):
        found = by_metric(group)
        cells = [
            text(found[metric], heading) if metric in found else "" for metric, heading in headings.items()
        ]
        lines.append("| " + " | ".join([*key, *cells]) + " |")
    return "\n".join(lines)


def text(interval: tuple[float, float, float], heading: str) -> str:
    """Value, low and high as words, such as "0.42 (0.40 to 0.44)"; in % where the heading says so."""
    scale = 100.0 if heading.endswith("[%]") else 1.0
    value, low, high = (scale * number for number in interval)
    digits = 0 if scale > 1.0 else 2 if abs(value) < 10.0 else 1
    if np.isnan(low) or low == high:
        return f"{value:.{digits}f}"
    return f"{value:.{digits}f} ({low:.{digits}f} to {high:.{digits}f})"


def _words(column: str) -> str:
    """Heading of a friction column: "final_r_mm" -> "r, final [mm]"."""
    when, _, what = column.partition("_")
    name, _, unit = what.partition("_mm")
    return f"{name}, {when}" + (" [mm]" if what != name else unit)
