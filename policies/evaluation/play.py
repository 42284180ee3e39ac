"""Plays episodes side by side and keeps their outcomes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import closing
from typing import Any, NamedTuple

import gymnasium as gym
import numpy as np

from policies.registry import Policy
from policies.stepping import batch_steps
from slipgym.tasks import find

ROWS = {"planar": 1000, "bullet": 50}
"""Most environments side by side; one of PyBullet takes 28 MB."""


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

    @property
    def strength(self) -> tuple[float, float]:
        """Share of the episodes that are solved and mean return, by which policies are ranked."""
        return float(self.success.mean()), float(self.reward.mean())


def play_episodes(
    task: str,
    policy: Policy,
    arguments: Mapping[str, Any],
    seeds: Sequence[int],
    options: Sequence[Mapping[str, Any]] | None = None,
    engine: str = "planar",
) -> Played:
    """Plays an episode for each seed.

    Args:
        task: As `slipgym.tasks.find` takes it.
        policy: What acts.
        arguments: Of the environments.
        seeds: Of the episodes, (n,).
        options: Options of reset of each episode; None: none.
        engine: "planar" or "bullet".
    """
    made, parts, mode = dict(arguments), [], "vector_entry_point"
    if engine != "planar":
        made, mode = {**made, "engine": engine, "disable_env_checker": True}, "sync"
    for first in range(0, len(seeds), ROWS[engine]):
        block = slice(first, first + ROWS[engine])
        with closing(gym.make_vec(f"slipgym:{find(task).id}", len(seeds[block]), mode, **made)) as envs:
            parts.append(play(envs, policy, seeds[block], None if options is None else options[block]))
    return Played(*(np.concatenate(values) for values in zip(*parts, strict=True)))


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
