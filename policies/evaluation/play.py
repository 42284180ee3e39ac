"""Plays one episode in each environment of a vector environment."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from policies.registry import Policy
from policies.stepping import batch_steps


class Played(NamedTuple):
    """Outcomes of n episodes; arrays (n,)."""

    success: np.ndarray
    """Whether the task succeeded."""
    dropped: np.ndarray
    """Whether the object was dropped."""
    reward: np.ndarray
    """Sum of rewards."""
    grip: np.ndarray
    """Mean actuator force of both fingers over the episode [N]."""
    slip: np.ndarray
    """Length of the way that the object slid [m]; what the task asks for is part of it."""


def play(
    envs: Any, policy: Policy, seeds: Sequence[int], options: Sequence[Mapping[str, Any]] | None = None
) -> Played:
    """Plays the first episode of every environment of a vector environment to its end.

    Args:
        envs: A vector environment of n slipgym environments.
        policy: What acts.
        seeds: Of the environments, (n,).
        options: Options of reset of each environment; None: none.
    """
    rows = None if options is None else {"rows": list(options)}
    observations, _ = envs.reset(seed=list(seeds), options=rows)
    n = len(seeds)
    success, dropped = np.zeros((2, n), bool)
    reward, grip, slip, count = np.zeros((4, n))
    before = np.zeros((n, 2))
    for step in batch_steps(envs, policy, observations):
        reward += np.where(step.running, step.rewards, 0.0)
        grip += np.where(step.running, step.infos["grip_force"].mean(axis=1), 0.0)
        now = step.infos["slip"][:, :2].copy()
        slip += np.where(step.running, np.hypot(*(now - before).T), 0.0)
        before = now
        count += step.running
        success[step.ended] = step.infos["is_success"][step.ended]
        dropped[step.ended] = step.infos["dropped"][step.ended]
    return Played(success, dropped, reward, grip / count, slip)
