"""Prints a finished study."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from policies.evaluation.frames import groups, records, where
from policies.evaluation.gain import sentence
from policies.evaluation.report import aligned
from policies.evaluation.statistics import Interval
from policies.evaluation.tables import text
from policies.study.config import Study
from policies.study.tables import FRICTION, PLACE

TITLES = {
    "classic": "controller",
    "memory": "memory of slips",
    "recurrent": "recurrent network",
    "learned": "learned policy",
    "imitation": "imitated policy",
}
"""Kind of a policy -> what a sentence calls it."""


def words(study: Study, folder: Path) -> str:
    """Gain, success of every condition in the first world, the shares, and where to look next.

    Args:
        study: The study.
        folder: From `run_study`.
    """
    # as text: a column of nothing but "true" would turn into booleans
    names = dict.fromkeys([*PLACE, *FRICTION], str)
    names.pop("level")
    outcomes, shares, benefits = (
        pd.read_csv(folder / f"{name}.csv", dtype=names, keep_default_na=False, na_values=[""])  # type: ignore[arg-type]
        for name in ("outcomes", "shares", "benefits")
    )
    world = study.worlds[0].label
    rows = [["task", "preset", "policy", "friction", "success [%]", "dropped [%]", "return, mean"]]
    for row in outcomes[(outcomes["world"] == world) & outcomes["change"].isna()].to_dict("records"):
        known = " ".join(str(row[name]) for name in FRICTION if row[name] == row[name])
        figures = [_text(row, name, unit) for name, unit in _UNITS.items()]
        rows.append([row["task"], row["preset"], row["kind"], known, *figures])
    known = where(outcomes, world=world)
    parts = [*claims(where(benefits, world=world), known.loc[known["change"].isna()])]
    parts += [f"{world}:", aligned(rows), "(95 % confidence intervals in brackets)"]
    if len(shares):
        rows = [["task", "preset", "policy", "of", "(estimated - none) / (true - none) [%]", ">= 80 %"]]
        for row in shares[shares["world"] == world].to_dict("records"):
            share = _text(row, "share", "[%]")
            rows.append([row["task"], row["preset"], row["kind"], row["figure"], share, row["verdict"]])
        parts.append(aligned(rows))
    parts += _benefits(where(benefits, world=world))
    parts += training_seeds(outcomes[(outcomes["world"] == world) & outcomes["change"].isna()])
    rows = [["task", "force [N]", "success [%]", "dropped [%]", "return, mean"]]
    for row in pd.read_csv(folder / "constant_grip.csv").to_dict("records"):
        figures = [_text(row, name, unit) for name, unit in _UNITS.items()]
        rows.append([row["task"], f"{row['force_N']:.2f}", *figures])
    parts += ["The best constant grip, without any sensor, planar engine:", aligned(rows)]
    return "\n\n".join([*parts, f"Look at:\n  {folder / 'outcomes.csv'}"])


def claims(benefits: pd.DataFrame, outcomes: pd.DataFrame) -> list[str]:
    """What the estimate gains over the strongest policy without friction, in a sentence for each task.

    Args:
        benefits: From `policies.study.benefit.benefits`, of one world.
        outcomes: From `policies.study.tables.outcomes`, of the same world.
    """
    found = []
    for (task, preset), group in groups(where(benefits, source="estimated"), ["task", "preset"]):
        row = max(records(group), key=lambda each: each["difference"])
        played = where(outcomes, task=task, preset=preset)
        count = {source: _solved(where(played, source=source)) for source in ("estimated", "true")}
        opponent = _solved(where(played, source="none", kind=row["opponent"]))
        points = Interval(*(100.0 * row[f"difference{end}"] for end in ("", "_low", "_high")))
        name = TITLES[row["opponent"]]
        words = sentence(row["n"], count["estimated"] or 0, (name, opponent or 0), count["true"], points)
        found.append(f"{task}, {preset}: {words}" if preset != "none" else f"{task}: {words}")
    return found


def _solved(outcomes: pd.DataFrame) -> int | None:
    """Most episodes that a condition solves; None without any."""
    return max((round(row["success"] * row["n"]) for row in records(outcomes)), default=None)


def training_seeds(outcomes: pd.DataFrame) -> list[str]:
    """Success of the policies that have several training seeds, over the seeds and of each; [] without any.

    Args:
        outcomes: From `policies.study.tables.outcomes`.
    """
    rows = [["task", "preset", "policy", "friction", "success over seeds [%]", "of each [%]"]]
    if "seeds" not in outcomes:
        return []
    for row in records(outcomes.dropna(subset=["seeds_low"])):
        known = " ".join(str(row[name]) for name in FRICTION if row[name] == row[name])
        each = " ".join(f"{100.0 * float(share):.0f}" for share in row["blocks"].split())
        rows.append([row["task"], row["preset"], row["kind"], known, _text(row, "seeds", "[%]"), each])
    title = "Interquartile mean over the training seeds, with an interval over the seeds:"
    return [title, aligned(rows)] if rows[1:] else []


def _benefits(benefits: pd.DataFrame) -> list[str]:
    """What friction information is worth against the strongest policy without it."""
    rows = [
        [
            "task",
            "preset",
            "opponent",
            "policy",
            "success less opponent's [%]",
            "share of the truth's [%]",
            "",
        ]
    ]
    for row in records(benefits):
        known = " ".join(str(row[name]) for name in ("kind", *FRICTION) if row[name] == row[name])
        figures = [_text(row, name, "[%]") for name in ("difference", "share")]
        rows.append([row["task"], row["preset"], row["opponent"], known, *figures, row["verdict"]])
    return (
        ["Against the strongest policy without friction information, in pairs:", aligned(rows)]
        if rows[1:]
        else []
    )


_UNITS = {"success": "[%]", "dropped": "[%]", "return": ""}


def _text(row: Mapping[str, Any], name: str, unit: str) -> str:
    """A figure with its interval; nothing where there is none."""
    value, low, high = row[name], row[f"{name}_low"], row[f"{name}_high"]
    return "" if math.isnan(value) else text((value, low, high), unit)
