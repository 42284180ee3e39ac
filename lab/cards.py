"""Prints what each policy that comes with slipgym is given of friction, what it took, what it solves."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from tqdm import tqdm

from policies.learned import LearnedPolicy, pretrained
from policies.policy_leaderboard.entries import Member
from policies.policy_leaderboard.run import episodes_of
from policies.policy_leaderboard.worlds import generalisation
from slipgym.tasks import find


def cards(names: Sequence[str], episodes: int, progress: bool = True) -> pd.DataFrame:
    """A row for each policy.

    Args:
        names: Of policies that come with slipgym; none: all of them.
        episodes: In each world; see `policies.policy_leaderboard.worlds`.
        progress: Whether to show a progress bar.

    Returns:
        Friction in its observation, million steps and seconds of the processor of its training, episodes
        solved at "easy" and, at the level of its training, in each world, and share of these episodes at
        which it dropped the object [%].

    Raises:
        FileNotFoundError: There is no policy of a name.
    """
    rows = []
    for name in tqdm(names or pretrained.folders(), unit="policy", disable=not progress):
        policy = LearnedPolicy(pretrained.locate(name))
        where, origin = policy.description.environment, policy.description.origin
        task, level = find(where.id).name, str(where.arguments["level"])
        source = str(where.arguments["friction_source"])
        member = Member(name, policy, {"friction_source": source, **policy.modes})
        easy = episodes_of(task, member, episodes, {"level": "easy"})
        own = episodes_of(task, member, episodes, {"level": level})
        worlds = generalisation(task, level, [member], episodes, {}, progress=False).iloc[0]
        cost = {"million steps": 1e-6 * origin.steps, "CPU [s]": origin.cpu_seconds}
        solved = {"easy": 100.0 * easy.success.mean(), level: worlds["itself"]}
        rows.append(
            {"policy": name, "friction": source, **cost, **solved}
            | {world: worlds[world] for world in list(worlds.index)[4:]}
            | {"dropped": 100.0 * own.dropped.mean()}
        )
    return pd.DataFrame(rows)
