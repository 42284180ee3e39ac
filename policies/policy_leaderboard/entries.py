"""Makes the policies that take part in the leaderboard."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import gymnasium as gym
import numpy as np

from policies import registry
from policies.controllers.constant_force import ConstantForcePolicy
from policies.controllers.no_friction_info import NoFrictionInfo
from policies.controllers.slip_memory import SlipMemory
from policies.controllers.table import CLASSES
from policies.evaluation.one_policy import environment_of
from policies.evaluation.play import play
from policies.learned import LearnedPolicy, pretrained
from policies.registry import Policy
from slipgym.config import load
from slipgym.tasks import find

CANDIDATES = 16
"""Constant forces that are tried, spaced geometrically over the gripper's range."""
SKIPS = 1, 2, 4
"""Control steps of an action that are tried for a memory of slips."""
LEARNED = {
    "scratch": "learned from nothing",
    "memory": "recurrent",
    "lab": "recurrent, trained on lab",
}
"""What the names of shipped policies have behind the task's key -> what tables call them."""
_SELECTION_SEED = 10_000_000
"""Of the first episode on which a constant force or a rate is chosen."""


class Member(NamedTuple):
    """A policy and what its environments are made with."""

    name: str
    policy: Policy
    arguments: Mapping[str, Any]


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


def remembering(task: str, arguments: Mapping[str, Any], episodes: int) -> Member:
    """The task's controller without friction information that remembers slips, at the rate that solves most.

    The rate is chosen as the force of `best_constant` is, which describes the arguments.
    """
    made, rate = SlipMemory(find(task).key), load().physics.control_rate
    members = []
    for skip in SKIPS:
        given = {**made.modes, "friction_source": "none", "frame_skip": skip}
        members.append(Member(f"controller, memory of slips ({rate // skip} Hz)", made, given))
    return _strongest(task, members, arguments, episodes)


def learned(key: str) -> list[Member]:
    """The policies of a task that come with slipgym.

    Args:
        key: Of the task.
    """
    members, shipped = [], pretrained.folders()
    for ending, called in LEARNED.items():
        if (name := f"{key}_{ending}") in shipped:
            policy = LearnedPolicy(shipped[name])
            source = policy.description.environment.arguments.get("friction_source", "estimated")
            members.append(Member(f"{called}, {source}", policy, {"friction_source": source, **policy.modes}))
    return members


def best_constant(task: str, arguments: Mapping[str, Any], episodes: int) -> Member:
    """The constant grip that solves most, among equals the one with the largest mean return.

    It is chosen on other episodes of the same distribution, on the planar engine.

    Args:
        task: As `slipgym.tasks.find` takes it.
        arguments: Of the environments: level, randomization, sensors.
        episodes: How many for each force.
    """
    gripper = load().gripper
    forces = np.geomspace(gripper.force_min, gripper.force_max, CANDIDATES).round(2).tolist()
    best = _strongest(task, [constant(force) for force in forces], arguments, episodes)
    return best._replace(name=f"best constant ({best.name.removeprefix('constant ')})")


def _strongest(task: str, members: Sequence[Member], arguments: Mapping[str, Any], episodes: int) -> Member:
    """The member that solves most, among equals with the largest mean return, on episodes of its own."""
    seeds, found = range(_SELECTION_SEED, _SELECTION_SEED + episodes), []
    for member in members:
        made = {**arguments, **member.arguments}
        envs = gym.make_vec(f"slipgym:{find(task).id}", episodes, "vector_entry_point", **made)
        try:
            found.append(play(envs, member.policy, seeds))
        finally:
            envs.close()
    rank = [(played.success.mean(), played.reward.mean()) for played in found]
    return members[max(range(len(members)), key=rank.__getitem__)]


def further(task: str) -> list[Member]:
    """Controllers of a task beside the one of its name, such as "planar_slip_continuous".

    Args:
        task: As `slipgym.tasks.find` takes it.
    """
    key, name, members = find(task).key, find(task).name, []
    for other in CLASSES:
        if other != key and getattr(registry.find(other), "task", None) == name:
            members += controllers(other, other)
    return members


def imitated(task: str, folder: Path) -> list[Member]:
    """Policies of `slipgym imitate` for a task.

    Args:
        task: As `slipgym.tasks.find` takes it.
        folder: Of its runs, `<task>_<friction source>_<seed>/policy`.
    """
    members = []
    for place in sorted(folder.glob(f"{find(task).key}_*/policy")):
        source = place.parent.name.removeprefix(f"{find(task).key}_").rpartition("_")[0]
        policy = LearnedPolicy(place)
        kind = "recurrent" if policy.description.network.memory is not None else "memoryless"
        arguments = {"friction_source": source, **policy.modes}
        members.append(Member(f"imitation, {source}, {kind}", policy, arguments))
    return members


def entered(names: Sequence[str], source: str) -> list[Member]:
    """Policies that a user enters.

    Args:
        names: As `policies.load` takes them: "module:class", or folders of learned policies.
        source: Friction source of their observations.

    Returns:
        Members whose names end with the source.

    Raises:
        FileNotFoundError: There is no such policy.
        ValueError: What lies there is no policy.
    """
    members = []
    for name in names:
        policy = registry.load(name)
        arguments = {"friction_source": source, **registry.modes(policy)}
        members.append(Member(f"{name}, {source}", policy, arguments))
    return members


def check_task(members: Sequence[Member], task: str) -> None:
    """Raise ValueError if a policy is for another task, whose observations may be as long."""
    for member in members:
        environment_of(member.name, member.policy, task)


def opponents(
    task: str, arguments: Mapping[str, Any], episodes: int, folder: Path | None = None
) -> list[Member]:
    """The policies that everyone is compared with.

    Args:
        task: As `slipgym.tasks.find` takes it.
        arguments: Of the environments: level, randomization, sensors.
        episodes: On which the constant grip and the rate of the memory are chosen, for each.
        folder: Of the runs of `slipgym imitate`; None: none.
    """
    key = find(task).key
    found = [best_constant(task, arguments, episodes), remembering(task, arguments, episodes)]
    found += [*controllers(key), *further(task), *learned(key)]
    return found if folder is None else [*found, *imitated(task, folder)]
