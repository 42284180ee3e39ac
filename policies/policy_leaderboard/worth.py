"""Computes what friction is worth: success with it less that of the strongest policy without it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from policies.evaluation.gain import WITHOUT
from policies.evaluation.play import Played
from policies.policy_leaderboard.entries import Member
from policies.study.statistics import Bootstrap
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

    Args:
        task: As `slipgym.tasks.find` takes it.
        level: Level of difficulty.
        members: The policies; the friction source of each is in its arguments.
        played: Their episodes, from `policies.policy_leaderboard.run.play_all`.

    Returns:
        A row with the columns COLUMNS; NaN where no policy of a group played.
    """
    row: dict[str, Any] = {"task": find(task).name, "level": level}
    solved: dict[str, np.ndarray] = {}
    for group, sources in GROUPS.items():
        among = [each.name for each in members if each.arguments["friction_source"] in sources]
        if among:
            best = max(among, key=lambda name: (played[name].success.mean(), played[name].reward.mean()))
            solved[group] = played[best].success
            row[group] = 100.0 * solved[group].mean()
            if group == "without":
                row["strongest without friction"] = _short(best)
    if {"without", "estimated"} <= set(solved):
        bootstrap = Bootstrap(np.zeros(len(solved["without"])))
        gain = (bootstrap(solved["estimated"]) - bootstrap(solved["without"])).interval
        row |= dict(zip(("gain", "low", "high"), (100.0 * value for value in gain), strict=True))
    return row


def table(rows: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    """Rows of `worth` as a table, the largest gain first."""
    found = pd.DataFrame(rows, columns=pd.Index(COLUMNS))
    return found.sort_values("gain", ascending=False, ignore_index=True)


def _short(name: str) -> str:
    """The name of a policy without its friction and its constant force."""
    return name.removeprefix("controller, ").partition(" (")[0].removesuffix(", none")
