"""Makes the policies that take part in the leaderboard."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from policies import registry
from policies.controllers.constant_force import ConstantForcePolicy
from policies.controllers.no_friction_info import NoFrictionInfo
from policies.controllers.rate import at_rate
from policies.controllers.slip_memory import SlipMemory
from policies.controllers.table import CLASSES
from policies.evaluation.play import play_episodes
from policies.learned import LearnedPolicy, pretrained
from policies.registry import Policy
from slipgym.config import GripperConfig, Overrides, load
from slipgym.envs.privileged import PRIVILEGED
from slipgym.tasks import find

CANDIDATES = 16
"""Constant forces that are tried, spaced geometrically over the gripper's range."""
MODES = {"friction_source": "none", "action_mode": "grip_force"}
"""Arguments of the environments of a constant grip."""
SKIPS = 1, 2, 4
"""Control steps of an action that are tried for a memory of slips."""
LEARNED = {
    "scratch": "learned from nothing",
    "memory": "recurrent",
    "lab": "recurrent, trained on lab",
    "lab_rigid": "recurrent, trained on lab with rigid pads",
}
"""What the names of shipped policies have behind the task's key -> what tables call them."""
_SELECTION_SEED = 10_000_000
"""Of the first episode on which a constant force or a rate is chosen."""


class Member(NamedTuple):
    """A policy and what its environments are made with."""

    name: str
    policy: Policy
    arguments: Mapping[str, Any]


def constant(force: float, config: Overrides | None = None) -> Member:
    """A constant grip force [N]: an opponent that reacts to nothing."""
    return Member(f"constant {force:g} N", ConstantForcePolicy(force, config), MODES)


def constants(gripper: GripperConfig, number: int, config: Overrides | None = None) -> list[Member]:
    """A number of constant forces, rounded to 0.01 N, spaced geometrically over a gripper's range."""
    forces = np.geomspace(gripper.force_min, gripper.force_max, number).round(2).tolist()
    return [constant(force, config) for force in forces]


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
    return strongest(task, members, arguments, _selection(episodes))


def source_of(policy: Policy) -> str:
    """The friction source that a policy asks for or, if it is of a file, was trained with; else estimates."""
    arguments = registry.modes(policy)
    if isinstance(policy, LearnedPolicy):
        arguments = policy.description.environment.arguments
    return str(arguments.get("friction_source", "estimated"))


def learned(key: str, kinds: Mapping[str, str] = LEARNED) -> list[Member]:
    """The policies of some kinds, as `LEARNED` has them, that come with slipgym for the task of a key."""
    members, shipped = [], pretrained.folders()
    for ending, called in kinds.items():
        if (name := f"{key}_{ending}") in shipped:
            policy = LearnedPolicy(shipped[name])
            source = source_of(policy)
            members.append(member(f"{called}, {source}", policy, source))
    return members


def bounds(key: str) -> list[Member]:
    """The policy that knows the right grip, for the tasks that have one."""
    return [Member("oracle, privileged", Oracle(), ORACLE_MODES)] if key in ONE_GRIP else []


def best_constant(task: str, arguments: Mapping[str, Any], episodes: int) -> Member:
    """The constant grip that solves most, among equals the one with the largest mean return.

    It is chosen on a number of other episodes of the same distribution, on the planar engine.
    """
    best = strongest(task, constants(load().gripper, CANDIDATES), arguments, _selection(episodes))
    return best._replace(name=f"best constant ({best.name.removeprefix('constant ')})")


def _selection(episodes: int) -> range:
    """Seeds of a number of episodes on which a policy is chosen, and nothing else."""
    return range(_SELECTION_SEED, _SELECTION_SEED + episodes)


def strongest(
    task: str, members: Sequence[Member], arguments: Mapping[str, Any], seeds: Sequence[int]
) -> Member:
    """The member that solves most, among equals with the largest mean return, on episodes of these seeds."""
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
    if not folder.is_dir():
        raise FileNotFoundError(f"{folder}: no such folder of imitated policies")
    members = []
    for place in sorted(folder.glob(f"{find(task).key}_*/policy")):
        source = place.parent.name.removeprefix(f"{find(task).key}_").rpartition("_")[0]
        policy = LearnedPolicy(place)
        kind = "recurrent" if policy.description.network.memory is not None else "memoryless"
        members.append(member(f"imitation, {source}, {kind}", policy, source))
    return members


def entered(names: Sequence[str], source: str | None = None) -> list[Member]:
    """Policies that a user enters, as `policies.load` takes them; their names end with their friction source.

    None stands for that of `source_of`; a policy that asks for a source always has it.

    Raises:
        FileNotFoundError: There is no such policy.
        ValueError: What lies there is no policy.
    """
    members = []
    for name in names:
        policy = registry.load(name)
        own = str(registry.modes(policy).get("friction_source", source or source_of(policy)))
        members.append(member(f"{name}, {own}", policy, own))
    return members


def opponents(
    task: str, arguments: Mapping[str, Any], episodes: int, folder: Path | None = None
) -> list[Member]:
    """The policies that everyone is compared with, those of `slipgym imitate` in a folder among them.

    A constant grip and the rate of the memory are chosen on a number of episodes, for each. The arguments are
    those of the environments: level, randomization, sensors.
    """
    key = find(task).key
    mimics = [] if folder is None else imitated(task, folder)
    found = [best_constant(task, arguments, episodes), remembering(task, arguments, episodes)]
    return [*found, *controllers(key), *further(task), *learned(key), *bounds(key), *mimics]


ONE_GRIP = ("hold", "fragile_hold")
"""Keys of the tasks that a constant grip solves, if it is the right one of the episode."""
ORACLE_MODES = {"observation_mode": "dict", "action_mode": "grip_force"}
_LEAST, _LIMIT = (
    [reading.name for reading in PRIVILEGED].index(name) for name in ("least_grip", "grip_limit")
)


class Oracle:
    """Grips with the geometric mean of the episode's least grip and its limit, firmly if it has none.

    Its observations are dicts.
    """

    def predict(
        self,
        observation: Any,
        state: None = None,
        episode_start: np.ndarray | None = None,
        deterministic: bool = True,
    ) -> tuple[np.ndarray, None]:
        """Actions (n, 1) for observations with the group "privileged", (n, m); the rest has no effect."""
        gripper = load().gripper
        least, limit = observation["privileged"][:, [_LEAST, _LIMIT]].T
        force = np.where(limit > 0.0, np.sqrt(least * limit), gripper.force_max)
        force = np.clip(force, gripper.force_min, gripper.force_max)
        share = (force - gripper.force_min) / (gripper.force_max - gripper.force_min)
        return (2.0 * share - 1.0)[:, None].astype(np.float32), None
