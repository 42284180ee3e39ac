"""The conditions of a study: one policy, friction source, world, block and preset, perhaps worse."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from policies.evaluation.experiment import Experiment, PolicyChoice, common_frame_skip
from policies.learned import pretrained
from policies.learned.files import DESCRIPTION
from policies.study.config import BLOCKS_MAX, SOURCES, Study, World
from policies.task_names import own_policy
from slipgym.config import load_randomization
from slipgym.config.yaml_model import validate
from slipgym.tasks import find

TRAINED_WITH: dict[str, str] = {source: source for source in SOURCES} | {"nominal": "true"}
"""Friction source of an evaluation -> that of the training; nobody trains on wrong values on purpose."""

Shelf = dict[tuple[str, str, str], dict[int, Path]]
"""(kind, task, source) -> seed -> folder."""


def policies_of(study: Study) -> Shelf:
    """The learned policies of a study, by kind, task and friction source of the training; by seed within.

    A policy lies in a folder <task>_<source> or <task>_<source>_<seed>, as in "linear_slip_true_2"; without a
    number it is seed 0. Or it is one of those that `slipgym train` or `slipgym imitate` left in the folder.
    Of those that come with slipgym, <task>_scratch is for the source "true", and `untold` is for "none".

    Raises:
        ValueError: Two folders stand for the same seed.
    """
    found: Shelf = {}
    for kind, where in folders(study).items():
        named = _named(where)
        names = [name for _, name in named]
        for (folder, name), task in itertools.product(named, study.tasks):
            key = find(task).key
            endings = {f"{key}_{source}": source for source in SOURCES}
            endings |= {f"{key}_scratch": "true", untold(study, key, names): "none"}
            for ending, source in endings.items():
                match = re.fullmatch(rf"{ending}(?:_+(\d+))?", name)
                if match is None:
                    continue
                seeds, seed = found.setdefault((kind, task, source), {}), int(match[1] or 0)
                if seed in seeds:
                    raise ValueError(f"{folder} and {seeds[seed]} are both seed {seed}")
                seeds[seed] = folder
    return found


def untold(study: Study, key: str, names: Iterable[str]) -> str:
    """Name of the policy that is given no friction, of those that come with slipgym, for a task's key.

    <task>_memory; with the sensors "lab" <task>_lab, or <task>_lab_rigid if the names have that one and no
    preset of the study has the pads of a laboratory.
    """
    if study.sensors != "lab":
        return f"{key}_memory"
    rigid = f"{key}_lab_rigid"
    return rigid if rigid in names and "lab" not in study.presets else f"{key}_lab"


def folders(study: Study) -> dict[str, Path]:
    """Kind of learned policy -> folder of its policies, of the kinds that have one."""
    given = {"learned": study.learned or str(pretrained.FOLDER), "imitation": study.imitation}
    return {kind: Path(folder) for kind, folder in given.items() if folder and kind in study.kinds}


def _named(top: Path) -> list[tuple[Path, str]]:
    """Folders of policies, and what they are called."""
    named = {path.parent: path.parent.name for path in top.glob(f"*/{DESCRIPTION}")}
    for path in top.glob(f"*/policy/{DESCRIPTION}"):
        named[path.parent] = path.parents[1].name
    for path in top.glob(f"*__*/*__*/policy/{DESCRIPTION}"):
        key, _, _ = path.parents[2].name.partition("__")
        named[path.parent] = f"{key}_{path.parents[1].name}"
    return sorted(named.items())


def missing(study: Study, found: Shelf) -> list[str]:
    """In words, the policies that a study would need and that are not there.

    Of imitations it needs those that see sensors alone.
    """
    lacking = []
    for kind, place in folders(study).items():
        wanted = ("none",) if kind == "imitation" else SOURCES
        for task in study.tasks:
            sources = [source for source in wanted if (kind, task, TRAINED_WITH[source]) not in found]
            if sources:
                where = "the policies that come with slipgym" if place == pretrained.FOLDER else place
                looked = f"looked for {find(task).key}_<source> in {where}"
                lacking.append(f"{task}: no policy of kind {kind} for {', '.join(sources)}; {looked}")
    return lacking


TITLES = {
    "noise_scale": "sensor noise, times the configured",
    "slip_latency": "age of the slip velocity [samples of 1/120 s]",
    "friction_jump": "friction after over before a jump in mid-episode",
}
"""Change -> what its levels are, in words."""

_WITHOUT_FRICTION = {
    "classic": "policies.controllers.no_friction_info:NoFrictionInfo",
    "memory": "policies.controllers.slip_memory:SlipMemory",
}
"""Kind -> how a controller acts without friction in its observation."""


@dataclass(frozen=True)
class Change:
    """One field of a preset, held at one value."""

    name: str
    """One of `TITLES`, or nothing."""
    level: float
    """Of what `TITLES` says."""
    time: tuple[float, float] = (0.0, 0.0)
    """When a jump happens [s]."""

    def of(self, preset: str, task: str) -> str | Mapping[str, Any]:
        """The preset with this change, for one task: what an environment takes as `randomization`."""
        if not self.name:
            return preset
        ranges = load_randomization(preset).of(find(task).key).model_dump(mode="json", exclude_defaults=True)
        if self.name == "friction_jump":
            jump = {
                "kind": "friction_jump",
                "probability": 1.0,
                "time": {"uniform": list(self.time)},
                "factor": {"choices": [self.level]},
            }
            others = [each for each in ranges.get("disturbances", []) if each["kind"] != "friction_jump"]
            return {**ranges, "disturbances": [*others, jump]}
        return {**ranges, self.name: {"choices": [self.level]}}


UNCHANGED = Change("", 0.0)


@dataclass(frozen=True)
class Condition:
    """Episodes that differ in nothing but their seeds."""

    world: World
    task: str
    preset: str
    change: Change
    kind: str
    source: str
    estimator: str
    policy: str
    """Its name, or the folder of a learned one."""
    block: int
    episodes: int
    frame_skip: int = 1
    """Control steps per action, the same for all policies of a task but the recurrent ones of slipgym."""
    force: float | None = None
    """Of a constant grip [N]."""

    @property
    def keys(self) -> dict[str, Any]:
        """Columns that distinguish its episodes from the others', for tables."""
        place = {"world": self.world.label, "task": self.task, "preset": self.preset}
        change = {"change": self.change.name, "level": self.change.level}
        friction = {"source": self.source, "estimator": self.estimator if self.source == "estimated" else ""}
        return {**place, **change, "kind": self.kind, **friction, "block": self.block}

    @property
    def name(self) -> str:
        """Names its file."""
        change = f"{self.change.name}_{self.change.level:g}" if self.change.name else ""
        parts = [find(self.task).key, self.preset, change, self.world.engine, self.world.contact, self.kind]
        parts += [self.source, self.keys["estimator"], str(self.block)]
        return re.sub(r"[^A-Za-z0-9_-]", "_", "__".join(part for part in parts if part))

    def experiment(self, study: Study) -> Experiment:
        """The experiment whose trials it holds."""
        values = {
            "name": self.name,
            "task": self.task,
            "seed": BLOCKS_MAX * study.seed + self.block,
            "trials": self.episodes,
            "policies": [self._policy()],
            "friction": [{"source": self.source, "estimator": {"name": self.estimator}}],
            "engine": self.world.engine,
            "frame_skip": self.frame_skip,
            "randomization": self.change.of(self.preset, self.task),
        }
        return experiment_of(study, self.world.contact, values)

    def _policy(self) -> PolicyChoice:
        if self.force is not None:
            return PolicyChoice(name=self.policy, parameters={"force": self.force}, label=self.kind)
        if self.kind in _WITHOUT_FRICTION and self.source == "none":
            parameters = {"controller": self.policy}
            return PolicyChoice(name=_WITHOUT_FRICTION[self.kind], parameters=parameters, label=self.kind)
        return PolicyChoice(name=self.policy, label=self.kind)


def experiment_of(study: Study, contact: str, values: Mapping[str, Any]) -> Experiment:
    """An experiment of some values, with a friction model and a study's level, sensors and configuration."""
    config = {**study.config, "contact": {**study.config.get("contact", {}), "model": contact}}
    same = {"level": study.level, "sensors": study.sensors, "config": config}
    return validate({**values, **same}, Experiment, values["name"])


def first_preset(study: Study) -> str:
    """The preset of the first world in which constant grips play."""
    return (study.worlds[0].presets or study.presets)[0]


def conditions(
    study: Study, learned: Shelf, forces: Mapping[str, float] = MappingProxyType({})
) -> list[Condition]:
    """Every condition of a study, in the order of the tables; policies that are not there are left out.

    Args:
        study: The study.
        learned: From `policies_of`.
        forces: Constant grips by task [N]; they play in the first world with its first preset.

    Raises:
        ValueError: Learned policies of a task act at different rates: they cannot be compared.
    """
    remembering = {
        str(path)
        for (_, _, source), seeds in learned.items()
        for path in seeds.values()
        if source == "none" and path.parent == pretrained.FOLDER
    }  # those that come with slipgym act at the rate of their training, as the kind "recurrent" does
    skips = {
        task: common_frame_skip(
            str(path)
            for (_, of, _), seeds in learned.items()
            if of == task
            for path in seeds.values()
            if str(path) not in remembering
        )
        for task in study.tasks
    }
    world, preset = study.worlds[0], first_preset(study)
    grip = UNCHANGED, "constant", "none", study.estimators[0], "constant_force"
    constant = [
        Condition(world, task, preset, *grip, block, study.episodes, skips[task], force)
        for task, force in forces.items()
        for block in range(study.blocks)
    ]
    return constant + [
        Condition(world, task, preset, change, kind, source, estimator, policy, block, episodes, skip)
        for world, task, preset, change, sources, estimators, episodes in _places(study)
        for kind, source in itertools.product(study.kinds, sources)
        for estimator in (estimators if source == "estimated" else study.estimators[:1])
        for block in range(study.blocks)
        for policy in _policy(study, task, kind, source, block, learned)
        for alone in [kind == "recurrent" or policy in remembering]
        for skip in [common_frame_skip([policy]) if alone else skips[task]]
    ]


def _places(study: Study) -> Iterator[tuple]:
    """World, task, preset, change, sources, estimators and episodes of a block."""
    for world, task in itertools.product(study.worlds, study.tasks):
        estimators = [name for name in study.estimators if name in (world.estimators or study.estimators)]
        for preset in world.presets or study.presets:
            yield world, task, preset, UNCHANGED, world.sources, estimators, study.episodes
    worse = study.degradation
    if worse is not None:
        world = next(world for world in study.worlds if world.label == worse.world)
        changes = [Change(name, level, worse.jump_time) for name in TITLES for level in getattr(worse, name)]
        for task, change in itertools.product(study.tasks, changes):
            yield world, task, worse.preset, change, worse.sources, study.estimators[:1], worse.episodes


def _policy(study: Study, task: str, kind: str, source: str, block: int, learned: Shelf) -> list[str]:
    """The policy of a block, or none."""
    if kind == "classic" or (kind == "memory" and source == "none"):
        return [own_policy(task)]
    if kind == "recurrent":
        shipped = pretrained.folders()
        folder = shipped.get(untold(study, find(task).key, shipped))
        return [str(folder)] if folder and source == "none" else []
    seeds = learned.get((kind, task, TRAINED_WITH[source]), {})
    chosen = sorted(seeds)
    return [str(seeds[chosen[block % len(chosen)]])] if chosen else []
