"""Plays the same episodes with every policy, and says how they went."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd
from tqdm import tqdm

from policies.evaluation.play import Played, play_episodes
from policies.evaluation.statistics import share
from policies.policy_leaderboard.entries import Member
from slipgym.tasks import find

COLUMNS = (
    "task", "level", "policy", "solved [%]", "low", "high", "mean return", "dropped [%]", "grip [N]",
    "slid [mm]",
)  # fmt: skip
"""Of the table: `low` and `high` bound the interval of 95 % of what was solved [%]."""


def episodes_of(
    task: str, member: Member, episodes: int, arguments: Mapping[str, Any], engine: str = "planar"
) -> Played:
    """Plays episodes with a policy; episode i has the seed i.

    Args:
        task: As `slipgym.tasks.find` takes it.
        member: The policy.
        episodes: How many.
        arguments: Further arguments of the environments, such as `level`.
        engine: "planar" or "bullet".
    """
    made = {**arguments, **member.arguments}
    return play_episodes(task, member.policy, made, range(episodes), engine=engine)


def play_all(
    task: str,
    level: str,
    members: Sequence[Member],
    episodes: int,
    arguments: Mapping[str, Any],
    engine: str = "planar",
    progress: bool = True,
) -> dict[str, Played]:
    """Plays the same episodes with every policy; further arguments as for `episodes_of`.

    Returns:
        The episodes of each policy by its name.
    """
    given, bar = {**arguments, "level": level}, f"{find(task).key}, {level}"
    return {
        member.name: episodes_of(task, member, episodes, given, engine)
        for member in tqdm(members, desc=bar, unit="policy", disable=not progress)
    }


def outcomes(task: str, level: str, played: Mapping[str, Played]) -> pd.DataFrame:
    """The table of the episodes that `play_all` played.

    Returns:
        A row for each policy, best first, with the columns COLUMNS: solved with its interval of 95 %, drops,
        mean grip of both fingers over the episodes, length of the way that the object slid.
    """
    rows = []
    for name, each in played.items():
        measured = each.reward.mean(), 100.0 * each.dropped.mean(), each.grip.mean(), 1e3 * each.slip.mean()
        rows.append((find(task).name, level, name, *share(each.success).percent, *measured))
    table = pd.DataFrame(rows, columns=pd.Index(COLUMNS))
    return table.sort_values(["solved [%]", "mean return"], ascending=False, ignore_index=True)


def kinds(table: pd.DataFrame) -> pd.Series:
    """Names of the policies without what differs between tasks: the force of a grip, the rate of a memory."""
    return table["policy"].str.replace(r" \(.*\)$", "", regex=True)


def by_level(table: pd.DataFrame) -> pd.DataFrame:
    """Solved share of each task and level [%], a column for each policy; NaN where it did not play.

    Of several tasks, policies that play only one of them are left out.
    """
    cells = list(dict.fromkeys(zip(table["task"], table["level"], strict=True)))
    names = kinds(table)
    if len(set(table["task"])) > 1:
        shown = [len(set(table.loc[names == name, "task"])) > 1 for name in names]
        table, names = table.loc[shown], names.loc[shown]
    wide = table.assign(kind=names).pivot_table(index=["task", "level"], columns="kind", values="solved [%]")
    order = sorted(dict.fromkeys(names), key=lambda name: (name.partition(",")[0], wide[name].mean()))
    return wide.loc[cells, order].reset_index().rename_axis(columns=None)
