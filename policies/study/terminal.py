"""Prints a finished study."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from policies.evaluation.frames import aligned, groups, read_table, records, text, values, where
from policies.evaluation.gain import sentence
from policies.evaluation.statistics import Interval
from policies.study.config import Study
from policies.study.tables import FRICTION, PLACE

TITLES = {
    "classic": "controller",
    "memory": "memory of slips",
    "recurrent": "recurrent network",
    "learned": "learned policy",
    "imitation": "imitated policy",
    "constant": "best constant grip",
}
"""Kind of a policy -> what a sentence calls it."""
_WHO = {"task": "task", "preset": "preset", "kind": "policy"}
_OUTCOMES = {"success": "success [%]", "dropped": "dropped [%]", "return": "return, mean"}
_SHARES = {"figure": "of", "share": "(estimated - none) / (true - none) [%]", "verdict": ">= 80 %"}
_BENEFITS = {
    **{name: name for name in ("task", "preset", "opponent", "policy")},
    "difference": "success less opponent's [%]",
    "share": "share of the truth's [%]",
    "verdict": "",
}


def words(study: Study, folder: Path) -> str:
    """Gain, success of every condition in the first world, the shares, and where to look next."""
    names = [name for name in (*PLACE, *FRICTION) if name != "level"]
    made = (read_table(folder / f"{name}.csv", names) for name in ("outcomes", "shares", "benefits"))
    outcomes, shares, benefits = made
    first = study.worlds[0].label
    shares, benefits, outcomes = (where(table, world=first) for table in (shares, benefits, outcomes))
    outcomes = outcomes.loc[outcomes["change"].isna()]
    parts = [*claims(benefits, outcomes), f"{first}:"]
    known = outcomes.assign(known=_joined(outcomes, FRICTION))
    parts.append(_table(known, _WHO | {"known": "friction"} | _OUTCOMES))
    parts.append("(95 % confidence intervals in brackets)")
    if len(shares):
        parts.append(_table(shares, _WHO | _SHARES))
    if len(benefits):
        parts.append("Against the strongest policy without friction information, in pairs:")
        policies = _joined(benefits, ["kind", *FRICTION])
        parts.append(_table(benefits.assign(policy=policies), _BENEFITS))
    parts += training_seeds(outcomes)
    constant = pd.read_csv(folder / "constant_grip.csv")
    constant["force"] = constant["force_N"].map("{:.2f}".format)
    parts.append("The best constant grip, without any sensor:")
    parts.append(_table(constant, {"task": "task", "force": "force [N]"} | _OUTCOMES))
    return "\n\n".join([*parts, f"Look at:\n  {folder / 'outcomes.csv'}"])


def claims(benefits: pd.DataFrame, outcomes: pd.DataFrame) -> list[str]:
    """Gain of the estimate over the strongest policy without friction, in a sentence for each task.

    The tables are those of benefits and outcomes, of one world.
    """
    found = []
    for (task, preset), group in groups(where(benefits, source="estimated"), ["task", "preset"]):
        row = max(records(group), key=lambda each: each["difference"])
        played = where(outcomes, task=task, preset=preset)
        count = {source: _solved(where(played, source=source)) for source in ("estimated", "true")}
        kind, _, nominal = row["opponent"].partition(" ")
        opponent = _solved(where(played, source=nominal or "none", kind=kind))
        points = Interval(*(row[f"difference{end}"] for end in ("", "_low", "_high"))).percent
        name = TITLES[kind] + ", nominal friction" * bool(nominal)
        words = sentence(row["n"], count["estimated"] or 0, (name, opponent or 0), count["true"], points)
        found.append(f"{task}, {preset}: {words}" if preset != "none" else f"{task}: {words}")
    return found


def _solved(outcomes: pd.DataFrame) -> int | None:
    """Most episodes that a condition solves; None without any."""
    return max((round(row["success"] * row["n"]) for row in records(outcomes)), default=None)


def training_seeds(outcomes: pd.DataFrame) -> list[str]:
    """Success of the policies that have several training seeds, over them and of each; [] without."""
    if "seeds" not in outcomes or np.isnan(values(outcomes, "seeds_low")).all():
        return []
    several = outcomes.dropna(subset=["seeds_low"])
    each = [" ".join(f"{100.0 * float(share):.0f}" for share in row.split()) for row in several["blocks"]]
    columns = {"known": "friction", "seeds": "success over seeds [%]", "each": "of each [%]"}
    title = "Interquartile mean over the training seeds, with an interval over the seeds:"
    return [title, _table(several.assign(known=_joined(several, FRICTION), each=each), _WHO | columns)]


def _joined(table: pd.DataFrame, columns: Sequence[str]) -> list[str]:
    """Names in some columns with spaces between, without those that are missing."""
    rows = table[list(columns)].itertuples(index=False, name=None)
    return [" ".join(name for name in row if isinstance(name, str) and name) for row in rows]


def _table(table: pd.DataFrame, columns: Mapping[str, str]) -> str:
    """Some columns under other headings, figures with their intervals; a figure that is missing is empty."""
    shown: dict[str, Sequence[str]] = {}
    for name, heading in columns.items():
        shown[heading] = list(table[name])
        if f"{name}_low" in table:
            ends = table[[name, f"{name}_low", f"{name}_high"]].itertuples(index=False, name=None)
            shown[heading] = ["" if np.isnan(end[0]) else text(end, heading) for end in ends]
    return aligned(pd.DataFrame(shown))
