"""Plays one episode in each environment of a vector environment."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from policies.registry import Policy
from policies.stepping import batch_steps


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
    n = len(seeds)
    reward, success, dropped = np.zeros(n), np.zeros(n, bool), np.zeros(n, bool)
    for step in batch_steps(envs, policy, observations):
        reward += np.where(step.running, step.rewards, 0.0)
        success[step.ended] = step.infos["is_success"][step.ended]
        dropped[step.ended] = step.infos["dropped"][step.ended]
    return Played(success, dropped, reward)
