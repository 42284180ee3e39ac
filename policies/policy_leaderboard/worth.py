"""Computes what friction is worth: success with it less that of the strongest policy without it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from policies.evaluation.gain import WITHOUT, Entry, difference, ranked
from policies.evaluation.play import Played
from policies.policy_leaderboard.entries import Member
from slipgym.tasks import find

GROUPS = {"without": WITHOUT, "estimated": ("estimated",), "true": ("true",)}
"""Friction sources of the policies that a column takes the strongest of."""
COLUMNS = ("task", "level", "strongest without friction", *GROUPS, "gain", "low", "high")
"""Of the table: episodes solved [%] by the strongest policy of each group; `gain` is "estimated" less
"without" [points], with its interval of 95 % over pairs of episodes."""


def worth(task: str, level: str, members: Sequence[Member], played: Mapping[str, Played]) -> dict[str, Any]:
    """Compares the strongest policies with estimated, with true and without friction on the same episodes.

    The strongest is chosen on these episodes. Without friction there is most to choose from, so that `gain`
    is rather too small.

    Returns:
        A row with the columns COLUMNS; NaN where no policy of a group played.
    """
    row: dict[str, Any] = {"task": find(task).name, "level": level}
    entries = [
        Entry(
            each.name,
            each.arguments.get("friction_source", "privileged"),
            played[each.name].success,
            played[each.name].reward,
        )
        for each in members
    ]
    best = {group: found[-1] for group, sources in GROUPS.items() if (found := ranked(entries, sources))}
    row |= {group: 100.0 * entry.success.mean() for group, entry in best.items()}
    if "without" in best:
        name = best["without"].policy.removeprefix("controller, ").partition(" (")[0]
        row["strongest without friction"] = name.removesuffix(", none")
        if "estimated" in best:
            points = difference(best["estimated"], best["without"])
            row |= dict(zip(("gain", "low", "high"), points, strict=True))
    return row


def table(rows: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    """Rows of `worth` as a table, the largest gain first."""
    found = pd.DataFrame(rows, columns=pd.Index(COLUMNS))
    return found.sort_values("gain", ascending=False, ignore_index=True)
