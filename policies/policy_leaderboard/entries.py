"""Makes the policies that take part in the leaderboard."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from policies import registry
from policies.controllers.constant_force import ConstantForcePolicy
from policies.controllers.no_friction_info import NoFrictionInfo
from policies.controllers.rate import at_rate
from policies.controllers.slip_memory import SlipMemory
from policies.controllers.table import CLASSES
from policies.evaluation.constant_grip import MODES, candidates
from policies.evaluation.one_policy import environment_of
from policies.evaluation.play import play_episodes
from policies.learned import LearnedPolicy, pretrained
from policies.policy_leaderboard import oracle
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


def remembering(task: str, arguments: Mapping[str, Any], episodes: int) -> Member:
    """The task's controller without friction information that remembers slips, at the rate that solves most.

    The rate is chosen as the force of `best_constant` is.
    """
    rate, members = load().physics.control_rate, []
    for skip in SKIPS:
        made = SlipMemory(find(task).key, config=at_rate(rate / skip) if skip > 1 else None)
        one = member(f"controller, memory of slips ({rate // skip} Hz)", made, "none")
        members.append(one._replace(arguments={**one.arguments, "frame_skip": skip}))
    return _strongest(task, members, arguments, episodes)


def learned(key: str) -> list[Member]:
    """The policies that come with slipgym for the task of a key."""
    members, shipped = [], pretrained.folders()
    for ending, called in LEARNED.items():
        if (name := f"{key}_{ending}") in shipped:
            policy = LearnedPolicy(shipped[name])
            source = str(policy.description.environment.arguments.get("friction_source", "estimated"))
            members.append(member(f"{called}, {source}", policy, source))
    return members


def bounds(key: str) -> list[Member]:
    """The policy that knows the right grip, for the tasks that have one."""
    return [Member("oracle, privileged", oracle.Oracle(), oracle.MODES)] if key in oracle.TASKS else []


def best_constant(task: str, arguments: Mapping[str, Any], episodes: int) -> Member:
    """The constant grip that solves most, among equals the one with the largest mean return.

    It is chosen on a number of other episodes of the same distribution, on the planar engine.
    """
    members = [constant(force) for force in candidates(load().gripper, CANDIDATES)]
    best = _strongest(task, members, arguments, episodes)
    return best._replace(name=f"best constant ({best.name.removeprefix('constant ')})")


def _strongest(task: str, members: Sequence[Member], arguments: Mapping[str, Any], episodes: int) -> Member:
    """The member that solves most, among equals with the largest mean return, on episodes of its own."""
    seeds = range(_SELECTION_SEED, _SELECTION_SEED + episodes)
    played = (play_episodes(task, each.policy, {**arguments, **each.arguments}, seeds) for each in members)
    strength = [found.strength for found in played]
    return members[strength.index(max(strength))]


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
    members = []
    for name in names:
        policy = registry.load(name)
        own = str(registry.modes(policy).get("friction_source", source))
        members.append(member(f"{name}, {own}", policy, own))
    return members


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
        episodes: On which the constant grip and the rate of the memory are chosen, for each.
        folder: Of the runs of `slipgym imitate`; None: none.
    """
    key = find(task).key
    found = [best_constant(task, arguments, episodes), remembering(task, arguments, episodes)]
    found += [*controllers(key), *further(task), *learned(key)]
    found += bounds(key)
    return found if folder is None else [*found, *imitated(task, folder)]
