"""Plays the first episodes of a task with a policy."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import gymnasium as gym
import numpy as np

from policies.evaluation.play import Played, play
from policies.reward_order.zoo import Member
from slipgym.tasks import find

ROWS = {"planar": 1000, "bullet": 50}
"""Most environments side by side; one of PyBullet takes 28 MB."""


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
    made, parts = {**arguments, **member.arguments}, []
    for first in range(0, episodes, ROWS[engine]):
        seeds = range(first, min(first + ROWS[engine], episodes))
        if engine == "planar":
            envs = gym.make_vec(f"slipgym:{find(task).id}", len(seeds), "vector_entry_point", **made)
        else:
            kind = {"engine": engine, "disable_env_checker": True}
            envs = gym.make_vec(f"slipgym:{find(task).id}", len(seeds), "sync", **kind, **made)
        try:
            parts.append(play(envs, member.policy, seeds))
        finally:
            envs.close()
    return Played(*(np.concatenate(values) for values in zip(*parts, strict=True)))
