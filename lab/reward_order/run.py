"""Plays a zoo of policies and compares the order of mean returns with that of success rates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Any

import numpy as np
import pandas as pd
from tqdm import tqdm

from policies.policy_leaderboard.entries import Member
from policies.policy_leaderboard.run import episodes_of
from slipgym.tasks import find

SUCCESS, DROPPED, RETURN = "success [%]", "dropped [%]", "mean return"
APART = 10.0
"""Pairs whose success rates differ by at least so many points are compared."""


def played(
    task: str,
    members: Sequence[Member],
    episodes: int = 200,
    arguments: Mapping[str, Any] | None = None,
    progress: bool = True,
) -> pd.DataFrame:
    """Plays the same episodes with every policy, on the planar engine.

    Args:
        task: As `slipgym.tasks.find` takes it.
        members: The policies.
        episodes: How many; episode i has the seed i.
        arguments: Further arguments of the environments, such as `randomization`.
        progress: Whether to show a progress bar.

    Returns:
        A row for each policy, best first: its name, SUCCESS, DROPPED and RETURN.
    """
    rows = []
    for member in tqdm(members, desc=find(task).key, unit="policy", disable=not progress):
        found = episodes_of(task, member, episodes, arguments or {})
        shares = 100.0 * found.success.mean(), 100.0 * found.dropped.mean()
        rows.append((member.name, *shares, found.reward.mean()))
    table = pd.DataFrame(rows, columns=pd.Index(["policy", SUCCESS, DROPPED, RETURN]))
    return table.sort_values([SUCCESS, RETURN], ascending=False, ignore_index=True)


def order(table: pd.DataFrame, apart: float = APART) -> tuple[int, list[tuple[str, str]]]:
    """Compares the orders of success and of mean return.

    Args:
        table: From `played`.
        apart: Least difference of the success rates of a pair, in points.

    Returns:
        The number of pairs that far apart, and those whose mean returns have the wrong order, better first.
    """
    pairs, wrong = 0, []
    names, success, returns = (table[name].to_numpy() for name in ("policy", SUCCESS, RETURN))
    for i, j in combinations(range(len(table)), 2):
        better, worse = (i, j) if success[i] > success[j] else (j, i)
        if success[better] - success[worse] < apart - 1e-9:
            continue
        pairs += 1
        if not returns[better] > returns[worse]:
            wrong.append((str(names[better]), str(names[worse])))
    return pairs, wrong


def compared(tables: Mapping[tuple[str, str], pd.DataFrame]) -> pd.DataFrame:
    """What `order` finds in tables of several tasks and levels.

    Args:
        tables: From `played`, by task and level.

    Returns:
        A row for each: task, level, pairs that are `APART`, share of them in the same order [%].
    """
    rows = []
    for (task, level), table in tables.items():
        pairs, wrong = order(table)
        rows.append((task, level, pairs, _in_order(pairs, wrong)))
    return pd.DataFrame(rows, columns=pd.Index(["task", "level", "pairs", "in order [%]"]))


def _in_order(pairs: int, wrong: Sequence[tuple[str, str]]) -> float:
    """Share of pairs in the right order [%]; 100 without any."""
    return 100.0 if pairs == 0 else 100.0 * (pairs - len(wrong)) / pairs


def sentence(table: pd.DataFrame, apart: float = APART) -> str:
    """What `order` finds, in words."""
    pairs, wrong = order(table, apart)
    text = f"{pairs} pairs differ by {apart:g} points of success or more; "
    text += f"in {_in_order(pairs, wrong):.1f} % of them the mean returns have the same order."
    if wrong:
        listed = "; ".join(f"{better} below {worse}" for better, worse in wrong[:12])
        text += f" Wrong: {listed}{'; ...' if len(wrong) > 12 else '.'}"
    return text


def spread(table: pd.DataFrame) -> float:
    """Range of the success rates of a table, in points; without a range it says nothing about the order."""
    return float(np.ptp(table[SUCCESS]))
