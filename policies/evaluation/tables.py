"""Writes the summary of a table of trials, for a page and for a terminal."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import pandas as pd
import yaml

from policies.evaluation.columns import Metric
from policies.evaluation.frames import aligned, distinct, groups, read_table, text, values, where
from policies.evaluation.frames import markdown as grid
from policies.evaluation.gain import TRUTH, against_truth, compare
from policies.evaluation.metrics import measures
from policies.evaluation.statistics import mean_interval, share
from policies.versions import INCOMPLETE

KEYS = ["policy", "friction"]
PAIR = ["policy", "material", "options", "trial"]
COLUMNS = [*KEYS, "material", "metric", "n", "value", "low", "high"]
FRICTION = ("true_mu_c", "cruise_mu_c", "final_mu_c", "true_mu_s", "final_mu_s", "true_r_mm", "final_r_mm")


def summarise(trials: pd.DataFrame, task: str) -> pd.DataFrame:
    """Every measure of every policy and friction choice of a task's trials, over all of them and by material.

    Returns:
        Columns `COLUMNS`: value with its interval low to high; material is "all" for all trials, metric
        "difference of ..." for the mean over pairs of what a friction choice has over the first one. What
        all trials lack has no row.
    """
    metrics = [m for m in measures(task).summary if not pd.isna(values(trials, m.column)).all()]
    metrics += [Metric(name, "") for name in FRICTION if name in trials]
    rows = []
    for grouped in (trials.assign(material="all"), trials):
        for keys, group in groups(grouped, [*KEYS, "material"]):
            for m in metrics:
                found = (share if m.share else mean_interval)(values(group, m.column))
                rows.append((*keys, m.column, len(group), *found))
    metric = measures(task).compared.column
    for (policy,), group in groups(trials, ["policy"]):
        first, *others = distinct(group, "friction")
        paired = group.pivot(index=PAIR, columns="friction", values=metric)
        for other in others:
            found = mean_interval(values(paired, other) - values(paired, first))
            rows.append((policy, other, "all", f"difference of {metric}", len(paired), *found))
    return pd.DataFrame(rows, columns=pd.Index(COLUMNS))


def markdown(summary: pd.DataFrame, task: str, n_trials: int, claims: Sequence[str] = ()) -> str:
    """The summary of a number of trials as a page that begins with some claims."""
    overall, compared = where(summary, material="all"), measures(task).compared
    parts = [f"# {task}: {n_trials} trials", *claims]
    parts += ["## Means", "With 95 % confidence intervals (bootstrap; shares: Wilson)."]
    parts.append(grid(shown(overall, {m.column: m.heading for m in measures(task).summary})))
    paired = where(overall, metric=f"difference of {compared.column}")
    if len(paired):
        heading = {f"difference of {compared.column}": f"difference of {compared.heading}"}
        parts.append(f"## Against {distinct(overall, 'friction')[0]!r}, trial by trial")
        parts.append(grid(shown(paired, heading)))
    headings = {name: _words(name) for name in FRICTION}
    by_material = summary.loc[values(summary, "material") != "all"]
    parts += [
        "## Estimated friction by material",
        "Mean of both fingers: over the cruise of the reference, and at the end.",
        grid(shown(by_material, headings, [*KEYS, "material"])),
    ]
    return "\n\n".join(part.rstrip() for part in parts) + "\n"


def report(folder: Path) -> str:
    """A compact table of the run in a folder, and where to look next.

    Raises:
        FileNotFoundError: The run is not over.
    """
    if (folder / INCOMPLETE).exists():
        raise FileNotFoundError(f"{folder} is not complete: the run was broken off, or goes on")
    task = yaml.safe_load((folder / "experiment.yaml").read_text(encoding="utf-8"))["task"]
    words = [*KEYS, "friction_source", "material", "metric"]
    summary, trials = (read_table(folder / f"{name}.csv", words) for name in ("summary", "trials"))
    parts = [line for part in claims(trials) for line in (part, "")]
    headings = {m.column: m.heading for m in measures(task).summary if m.brief}
    parts.append(aligned(shown(where(summary, material="all"), headings)))
    parts += ["(95 % confidence intervals in brackets)", "", "Look at:"]
    paths = [*sorted(folder.glob("*.png")), folder / "summary.md", folder / "trials.csv"]
    return "\n".join([*parts, *(f"  {path}" for path in paths)])


def claims(
    trials: pd.DataFrame, title: str = "{}:", table: Callable[[pd.DataFrame], str] = aligned
) -> list[str]:
    """The gain over the strongest policy without friction, and the estimate beside the truth, if any."""
    gain, truth = compare(trials), against_truth(trials)
    parts = [] if gain is None else [gain.words()]
    return [*parts, title.format(TRUTH), table(truth)] if len(truth) else parts


def shown(summary: pd.DataFrame, headings: Mapping[str, str], keys: Sequence[str] = KEYS) -> pd.DataFrame:
    """Rows of a summary in words by some of its columns, a column for each metric that is there."""
    headings = {name: words for name, words in headings.items() if name in set(summary["metric"])}
    rows = []
    for key, group in groups(summary, keys):
        ends = group[["value", "low", "high"]].itertuples(index=False, name=None)
        found = dict(zip(group["metric"], ends, strict=True))
        cells = (text(found[name], heading) if name in found else "" for name, heading in headings.items())
        rows.append((*key, *cells))
    return pd.DataFrame(rows, columns=pd.Index([*keys, *headings.values()]))


def _words(column: str) -> str:
    """Heading of a friction column: "final_r_mm" -> "r, final [mm]"."""
    when, _, what = column.partition("_")
    return f"{what.removesuffix('_mm')}, {when}" + (" [mm]" if what.endswith("_mm") else "")
