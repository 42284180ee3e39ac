"""Writes the report of a finished run for a terminal."""

from __future__ import annotations

from collections.abc import Hashable
from pathlib import Path

import pandas as pd
import yaml

from policies.evaluation.folder import INCOMPLETE
from policies.evaluation.frames import by_metric, groups, where
from policies.evaluation.gain import compare
from policies.evaluation.metrics import measures
from policies.evaluation.tables import KEYS, text


def report(folder: Path) -> str:
    """A compact table of a run, and where to look next.

    Args:
        folder: The run's folder.

    Raises:
        FileNotFoundError: The run is not over.
    """
    if (folder / INCOMPLETE).exists():
        raise FileNotFoundError(f"{folder} is not complete: the run was broken off, or goes on")
    task = yaml.safe_load((folder / "experiment.yaml").read_text(encoding="utf-8"))["task"]
    # as text: a column of nothing but "true" would turn into booleans
    names: dict[Hashable, type[str]] = dict.fromkeys((*KEYS, "material", "metric"), str)
    summary = pd.read_csv(folder / "summary.csv", dtype=names, keep_default_na=False, na_values=[""])
    metrics = [m for m in measures(task).summary if m.brief and m.column in set(summary["metric"])]
    rows = []
    for keys, group in groups(where(summary, material="all"), KEYS):
        found = by_metric(group)
        rows.append([*keys, *(text(found[m.column], m.heading) for m in metrics)])
    table = aligned([[*KEYS, *(m.heading for m in metrics)], *rows])
    trials = pd.read_csv(folder / "trials.csv", dtype={"friction": str, "friction_source": str})
    gain = compare(trials)
    claim = [] if gain is None else [gain.words(), ""]
    pictures = sorted(folder.glob("*.png"))
    paths = [f"  {path}" for path in [*pictures, folder / "summary.md", folder / "trials.csv"]]
    return "\n".join([*claim, table, "(95 % confidence intervals in brackets)", "", "Look at:", *paths])


def aligned(rows: list[list[str]]) -> str:
    """Rows of cells in columns of even width, with a line below the first."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = [
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows
    ]
    return "\n".join([lines[0], "-" * max(map(len, lines)), *lines[1:]])
