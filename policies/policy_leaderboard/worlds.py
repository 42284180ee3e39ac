"""Plays policies in worlds that differ from the one of their training: how far they generalise."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import pandas as pd
from tqdm import tqdm

from policies.evaluation.play import Played
from policies.policy_leaderboard.entries import Member
from policies.policy_leaderboard.run import episodes_of
from slipgym.envs.engines import resolved
from slipgym.tasks import find


class World(NamedTuple):
    """Differences of a world from the level itself."""

    name: str
    arguments: Mapping[str, Any]
    """Of the environments."""
    engine: str = "planar"
    share: float = 1.0
    """Of the episodes that are played in it."""


WORLDS = (
    World("itself", {}),
    World("train", {"randomization": "train"}),
    World("eval_ood", {"randomization": "eval_ood"}),
    World("lab", {"sensors": "lab", "randomization": "lab"}),
    World("distributed", {"contact": "distributed"}, share=0.1),
    World("bullet", {}, "bullet", share=0.25),
)
"""Columns of the table; PyBullet and the distributed contact are slow."""


def play_in(
    world: World, task: str, level: str, member: Member, episodes: int, arguments: Mapping[str, Any]
) -> Played:
    """Plays a world's share of so many episodes; arguments as for `generalisation`."""
    count, given = max(round(world.share * episodes), 1), {**arguments, **world.arguments, "level": level}
    return episodes_of(task, member, count, given, world.engine)


def generalisation(
    task: str,
    level: str,
    members: Sequence[Member],
    episodes: int,
    arguments: Mapping[str, Any],
    progress: bool = True,
) -> pd.DataFrame:
    """Solved share of each policy in each world [%], on the same episodes of a world for all of them.

    The arguments are further ones of the environments, which those of a world replace.

    Returns:
        A row for each policy with the columns "task", "level", "policy" and the names of `WORLDS`.

    Raises:
        ValueError: An engine is not installed.
    """
    for world in WORLDS:
        resolved(world.engine)
    rows = []
    for member in tqdm(members, desc=f"{find(task).key}, worlds", unit="policy", disable=not progress):
        row: dict[str, Any] = {"task": find(task).name, "level": level, "policy": member.name}
        for world in WORLDS:
            played = play_in(world, task, level, member, episodes, arguments)
            row[world.name] = 100.0 * float(played.success.mean())
        rows.append(row)
    return pd.DataFrame(rows)
