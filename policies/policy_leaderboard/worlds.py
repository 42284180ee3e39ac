"""Plays policies in worlds that differ from the one of their training: how far they generalise."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import pandas as pd
from tqdm import tqdm

from policies.policy_leaderboard.entries import Member
from policies.policy_leaderboard.run import episodes_of
from slipgym.tasks import find


class World(NamedTuple):
    """What differs from the level itself."""

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


def generalisation(
    task: str,
    level: str,
    members: Sequence[Member],
    episodes: int,
    arguments: Mapping[str, Any],
    progress: bool = True,
) -> pd.DataFrame:
    """What each policy solves in each world [%], on the same episodes of a world for all of them.

    Args:
        task: As `slipgym.tasks.find` takes it.
        level: Level of difficulty.
        members: The policies.
        episodes: How many in each world, of the slow ones a share.
        arguments: Further arguments of the environments, which those of a world replace.
        progress: Whether to show a progress bar.

    Returns:
        A row for each policy with the columns "task", "level", "policy" and the names of `WORLDS`.
    """
    rows = []
    with tqdm(total=len(members) * len(WORLDS), unit="cell", disable=not progress) as bar:
        for member in members:
            row: dict[str, Any] = {"task": find(task).name, "level": level, "policy": member.name}
            for world in WORLDS:
                bar.set_description(f"{find(task).key}, {world.name}")
                count = max(round(world.share * episodes), 1)
                given = {**arguments, **world.arguments, "level": level}
                played = episodes_of(task, member, count, given, world.engine)
                row[world.name] = 100.0 * float(played.success.mean())
                bar.update()
            rows.append(row)
    return pd.DataFrame(rows)
