"""Plays the same episodes with every policy: how they went, worth of friction, other worlds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import pandas as pd
from tqdm import tqdm

from policies.evaluation.gain import WITHOUT, Entry, difference, ranked
from policies.evaluation.play import Played, play_episodes
from policies.evaluation.statistics import share
from policies.policy_leaderboard.entries import Member
from slipgym.envs.engines import resolved
from slipgym.tasks import find

COLUMNS = (
    "task", "level", "policy", "solved [%]", "low", "high", "mean return", "dropped [%]", "grip [N]",
    "slid [mm]",
)  # fmt: skip
"""Of the table: `low` and `high` bound the interval of 95 % of what was solved [%]."""


def episodes_of(
    task: str, member: Member, episodes: int, arguments: Mapping[str, Any], engine: str = "planar"
) -> Played:
    """Plays episodes with a policy on the engine "planar" or "bullet"; episode i has the seed i.

    The arguments are further ones of the environments, such as `level`.

    Raises:
        ValueError: The policy does not fit, or acts beyond the action space; named in the error.
    """
    made = {**arguments, **member.arguments}
    try:
        return play_episodes(task, member.policy, made, range(episodes), engine=engine)
    except ValueError as error:
        raise ValueError(f"{member.name}: {error}") from error


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


GROUPS = {"without": WITHOUT, "estimated": ("estimated",), "true": ("true",)}
"""Friction sources of the policies that a column takes the strongest of."""
WORTH = ("task", "level", "strongest without friction", *GROUPS, "gain", "low", "high")
"""Of the table: episodes solved [%] by the strongest policy of each group; `gain` is "estimated" less
"without" [points], with its interval of 95 % over pairs of episodes."""


def worth(task: str, level: str, members: Sequence[Member], played: Mapping[str, Played]) -> dict[str, Any]:
    """Compares the strongest policies with estimated, with true and without friction on the same episodes.

    The strongest is chosen on these episodes. Without friction there is most to choose from, so that `gain`
    is rather too small.

    Returns:
        A row with the columns WORTH; NaN where no policy of a group played.
    """
    row: dict[str, Any] = {"task": find(task).name, "level": level}
    entries = []
    for each in members:
        source, found = each.arguments.get("friction_source", "privileged"), played[each.name]
        entries.append(Entry(each.name, source, found.success, found.reward))
    best = {group: among[-1] for group, sources in GROUPS.items() if (among := ranked(entries, sources))}
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
    found = pd.DataFrame(rows, columns=pd.Index(WORTH))
    return found.sort_values("gain", ascending=False, ignore_index=True)


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
