"""Policies of every quality for a task: random, constant, classic, disturbed, learned."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from policies import registry
from policies.controllers.constant_force import ConstantForcePolicy
from policies.controllers.no_friction_info import NoFrictionInfo
from policies.controllers.slip_memory import SlipMemory
from policies.learned import LearnedPolicy, pretrained
from policies.registry import Policy
from slipgym.config import load
from slipgym.envs.actions import components
from slipgym.tasks import find

GRIPS = 9
"""Constant forces, spaced geometrically over the gripper's range."""
NOISES = (0.05, 0.1, 0.2, 0.4)
"""Standard deviations of the noise on the actions of the controller with true friction."""


class Member(NamedTuple):
    """A policy and what its environments are made with."""

    name: str
    policy: Policy
    arguments: Mapping[str, Any]


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


def constant(force: float) -> Member:
    """A constant grip force [N]."""
    arguments = {"friction_source": "none", "action_mode": "grip_force"}
    return Member(f"constant {force:g} N", ConstantForcePolicy(force), arguments)


def controllers(key: str, called: str = "controller") -> list[Member]:
    """A controller with every friction source.

    Args:
        key: Its name: that of a task, or another one of `policies.controllers.table.CLASSES`.
        called: How the members' names begin.
    """
    made, blind = registry.make(key), NoFrictionInfo(key)
    members = [Member(f"{called}, none", blind, {**registry.modes(blind), "friction_source": "none"})]
    for source in ("nominal", "estimated", "true"):
        arguments = {**registry.modes(made), "friction_source": source}
        members.append(Member(f"{called}, {source}", made, arguments))
    return members


def remembering(key: str) -> Member:
    """A controller without friction information that remembers slips.

    Args:
        key: Its name.
    """
    made = SlipMemory(key)
    return Member("controller, memory of slips", made, {**made.modes, "friction_source": "none"})


def learned(key: str) -> list[Member]:
    """The policies of a task that come with slipgym.

    Args:
        key: Of the task.
    """
    members = []
    for source in ("estimated", "true", "none"):
        if (name := f"{key}_{source}") in pretrained.folders():
            policy = LearnedPolicy(pretrained.folders()[name])
            members.append(Member(f"learned, {source}", policy, {"friction_source": source, **policy.modes}))
    return members
