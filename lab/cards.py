"""Prints what each policy that comes with slipgym is given of friction, what it took, what it solves."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from tqdm import tqdm

from policies.learned import LearnedPolicy, pretrained
from policies.policy_leaderboard import run
from policies.policy_leaderboard.entries import Member
from slipgym.tasks import find


def cards(names: Sequence[str], episodes: int, progress: bool = True) -> pd.DataFrame:
    """A row for each policy.

    Args:
        names: Of policies that come with slipgym; none: all of them. A policy has the sensors of its training
            in every world; one that was trained with the realistic ones has those of "lab" in that world.
        episodes: In each world; see `policies.policy_leaderboard.run`.
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
        sensors, own = where.arguments["sensors"], {"randomization": where.arguments["randomization"]}
        shown = [("easy", "easy", run.WORLDS[0]), *((world.name, level, world) for world in run.WORLDS)]
        played = {}
        for column, difficulty, world in shown:
            read = {} if (sensors, world.name) == ("realistic", "lab") else {"sensors": sensors}
            member = Member(name, policy, {"friction_source": source, **policy.modes, **read})
            played[column] = run.play_in(world, task, difficulty, member, episodes, own)
        rows.append(
            {
                "policy": name,
                "friction": source,
                "million steps": 1e-6 * origin.steps,
                "CPU [s]": origin.cpu_seconds,
                **{where: 100.0 * found.success.mean() for where, found in played.items()},
                "dropped": 100.0 * played["itself"].dropped.mean(),
            }
        )
    return pd.DataFrame(rows)
