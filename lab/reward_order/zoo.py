"""Policies of every quality for a task: random, constant, classic, disturbed, learned."""

from __future__ import annotations

from typing import Any

import numpy as np

from policies import registry
from policies.policy_leaderboard.entries import Member, constant, controllers, learned
from policies.registry import Policy
from slipgym.config import load
from slipgym.envs.actions import components
from slipgym.tasks import find

GRIPS = 9
"""Constant forces, spaced geometrically over the gripper's range."""
NOISES = (0.05, 0.1, 0.2, 0.4)
"""Standard deviations of the noise on the actions of the controller with true friction."""


class Disturbed:
    """A policy whose actions have white noise; without a policy, actions are uniformly random.

    Args:
        policy: What acts; None: random actions.
        size: Standard deviation of the noise; without effect on random actions.
        width: Components of an action.
    """

    def __init__(self, policy: Policy | None, size: float, width: int) -> None:
        self._policy, self._size, self._width = policy, size, width
        self._rng = np.random.default_rng(0)

    def predict(
        self,
        observation: np.ndarray,
        state: Any = None,
        episode_start: np.ndarray | None = None,
        deterministic: bool = True,
    ) -> tuple[np.ndarray, Any]:
        """See `policies.registry.Policy.predict`."""
        shape = len(observation), self._width
        if self._policy is None:
            return self._rng.uniform(-1.0, 1.0, shape).astype(np.float32), None
        actions, state = self._policy.predict(observation, state, episode_start, deterministic)
        noisy = actions + self._size * self._rng.standard_normal(shape)
        return np.clip(noisy, -1.0, 1.0).astype(np.float32), state


def zoo(task: str) -> list[Member]:
    """The policies of a task.

    Args:
        task: As `slipgym.tasks.find` takes it.

    Raises:
        ValueError: There is no such task, or no controller of its name.
    """
    key, mode = find(task).key, find(task).action_mode
    gripper, width = load().gripper, len(components(mode, load()))
    members = [Member("random actions", Disturbed(None, 0.0, width), {"friction_source": "none"})]
    for force in np.geomspace(gripper.force_min, gripper.force_max, GRIPS).round(2).tolist():
        members.append(constant(force))
    members += controllers(key)
    for size in NOISES:
        made = registry.make(key)
        arguments = {**registry.modes(made), "friction_source": "true"}
        members.append(Member(f"controller, true, noise {size:g}", Disturbed(made, size, width), arguments))
    return [*members, *learned(key)]
