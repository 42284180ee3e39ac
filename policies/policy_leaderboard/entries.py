"""Makes the policies that take part in the leaderboard."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from policies import registry
from policies.controllers.constant_force import ConstantForcePolicy
from policies.controllers.no_friction_info import NoFrictionInfo
from policies.controllers.slip_memory import SlipMemory
from policies.controllers.table import CLASSES
from policies.evaluation.constant_grip import MODES, best_of, candidates, play_forces
from policies.evaluation.one_policy import environment_of
from policies.learned import LearnedPolicy, pretrained
from policies.registry import Policy
from slipgym.config import load
from slipgym.tasks import find

CANDIDATES = 16
"""Constant forces that are tried, spaced geometrically over the gripper's range."""
LEARNED = {
    "scratch": "learned from nothing",
    "memory": "recurrent",
    "lab": "recurrent, trained on lab",
}
"""What the names of shipped policies have behind the task's key -> what tables call them."""
_SELECTION_SEED = 10_000_000
"""Of the first episode on which the constant force is chosen."""


class Member(NamedTuple):
    """A policy and what its environments are made with."""

    name: str
    policy: Policy
    arguments: Mapping[str, Any]


def constant(force: float) -> Member:
    """A constant grip force [N]."""
    return Member(f"constant {force:g} N", ConstantForcePolicy(force), MODES)


def member(name: str, policy: Policy, source: str) -> Member:
    """A policy with a friction source; it sets the modes of its environments."""
    return Member(name, policy, {**registry.modes(policy), "friction_source": source})


def controllers(key: str, called: str = "controller") -> list[Member]:
    """A controller with every friction source: that of a task's key, or another one of `CLASSES`.

    The members' names begin with what it is called.
    """
    made = registry.make(key)
    members = [member(f"{called}, {source}", made, source) for source in ("nominal", "estimated", "true")]
    return [member(f"{called}, none", NoFrictionInfo(key), "none"), *members]


def remembering(key: str) -> Member:
    """The controller of a name without friction information, which remembers slips."""
    return member("controller, memory of slips", SlipMemory(key), "none")


def learned(key: str) -> list[Member]:
    """The policies that come with slipgym for the task of a key."""
    members, shipped = [], pretrained.folders()
    for ending, called in LEARNED.items():
        if (name := f"{key}_{ending}") in shipped:
            policy = LearnedPolicy(shipped[name])
            source = str(policy.description.environment.arguments.get("friction_source", "estimated"))
            members.append(member(f"{called}, {source}", policy, source))
    return members


def best_constant(task: str, arguments: Mapping[str, Any], episodes: int) -> Member:
    """The constant grip that solves most, among equals the one with the largest mean return.

    It is chosen on a number of other episodes of the same distribution, on the planar engine.
    """
    forces = candidates(load().gripper, CANDIDATES)
    seeds = range(_SELECTION_SEED, _SELECTION_SEED + episodes)
    force = best_of(play_forces(task, arguments, forces, seeds))
    return constant(force)._replace(name=f"best constant ({force:g} N)")


def further(task: str) -> list[Member]:
    """Controllers of a task beside the one of its name, such as "planar_slip_continuous"."""
    found = find(task)
    others = [name for name in CLASSES if getattr(registry.find(name), "task", None) == found.name]
    return [each for name in others if name != found.key for each in controllers(name, name)]


def imitated(task: str, folder: Path) -> list[Member]:
    """Policies of `slipgym imitate` for a task, in its folder of `<task>_<friction source>_<seed>/policy`."""
    members = []
    for place in sorted(folder.glob(f"{find(task).key}_*/policy")):
        source = place.parent.name.removeprefix(f"{find(task).key}_").rpartition("_")[0]
        policy = LearnedPolicy(place)
        kind = "recurrent" if policy.description.network.memory is not None else "memoryless"
        members.append(member(f"imitation, {source}, {kind}", policy, source))
    return members


def entered(names: Sequence[str], source: str) -> list[Member]:
    """Policies that a user enters, as `policies.load` takes them; their names end with their friction source.

    Raises:
        FileNotFoundError: There is no such policy.
        ValueError: What lies there is no policy.
    """
    return [member(f"{name}, {source}", registry.load(name), source) for name in names]


def check_task(members: Sequence[Member], task: str) -> None:
    """Raise ValueError if a policy is for another task, whose observations may be as long."""
    for each in members:
        environment_of(each.name, each.policy, task)


def opponents(
    task: str, arguments: Mapping[str, Any], episodes: int, folder: Path | None = None
) -> list[Member]:
    """The policies that everyone is compared with.

    Args:
        task: As `slipgym.tasks.find` takes it.
        arguments: Of the environments: level, randomization, sensors.
        episodes: On which the constant grip is chosen, for each force.
        folder: Of the runs of `slipgym imitate`; None: none.
    """
    key = find(task).key
    found = [best_constant(task, arguments, episodes), remembering(key), *controllers(key), *further(task)]
    found += learned(key)
    return found if folder is None else [*found, *imitated(task, folder)]
