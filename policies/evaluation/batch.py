"""Plays one episode in each environment of a vector environment."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from policies.registry import Policy


class Played(NamedTuple):
    """How n episodes went; arrays (n,)."""

    success: np.ndarray
    """Whether the task succeeded."""
    dropped: np.ndarray
    """Whether the object was dropped."""
    reward: np.ndarray
    """Sum of rewards."""


def play(
    envs: Any, policy: Policy, seeds: Sequence[int], options: Sequence[Mapping[str, Any]] | None = None
) -> Played:
    """Plays the first episode of every environment to its end.

    Args:
        envs: A `slipgym.envs.SlipVectorEnv` of n environments.
        policy: What acts.
        seeds: Of the environments, (n,).
        options: Options of reset of each environment; None: none.
    """
    rows = None if options is None else {"rows": list(options)}
    observations, _ = envs.reset(seed=list(seeds), options=rows)
    n, state = len(seeds), None
    running, reward = np.ones(n, bool), np.zeros(n)
    success, dropped = np.zeros(n, bool), np.zeros(n, bool)
    while running.any():
        actions, state = policy.predict(observations, state)
        observations, rewards, terminated, truncated, infos = envs.step(actions)
        reward += np.where(running, rewards, 0.0)
        ended = running & (terminated | truncated)
        success[ended], dropped[ended] = infos["is_success"][ended], infos["dropped"][ended]
        running &= ~ended
    return Played(success, dropped, reward)
