"""The conditions of a study: one policy, friction source, world and block of episodes."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from policies.evaluation.experiment import Experiment, PolicyChoice
from policies.evaluation.rate import common_frame_skip
from policies.learned import pretrained
from policies.study.changes import UNCHANGED, Change, changes
from policies.study.config import BLOCKS_MAX, Study, World
from policies.study.learned import TRAINED_WITH, Shelf
from policies.task_names import own_policy
from slipgym.config.yaml_model import validate
from slipgym.tasks import find

_WITHOUT_FRICTION = {
    "classic": "policies.controllers.no_friction_info:NoFrictionInfo",
    "memory": "policies.controllers.slip_memory:SlipMemory",
}
"""Kind -> how a controller acts without friction in its observation."""


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
    """Control steps per action, the same for all policies of a task but the recurrent ones."""

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
        if self.kind in _WITHOUT_FRICTION and self.source == "none":
            parameters = {"controller": self.policy}
            return PolicyChoice(name=_WITHOUT_FRICTION[self.kind], parameters=parameters, label=self.kind)
        return PolicyChoice(name=self.policy, label=self.kind)


def experiment_of(study: Study, contact: str, values: Mapping[str, Any]) -> Experiment:
    """An experiment of some values, with a friction model and a study's level, sensors and configuration."""
    config = {**study.config, "contact": {**study.config.get("contact", {}), "model": contact}}
    same = {"level": study.level, "sensors": study.sensors, "config": config}
    return validate({**values, **same}, Experiment, values["name"])


def conditions(study: Study, learned: Shelf) -> list[Condition]:
    """Every condition of a study, in the order of the tables; policies that are not there are left out.

    Raises:
        ValueError: Learned policies of a task act at different rates: they cannot be compared.
    """
    skips = {
        task: common_frame_skip(
            str(path) for (_, of, _), seeds in learned.items() if of == task for path in seeds.values()
        )
        for task in study.tasks
    }
    return [
        Condition(world, task, preset, change, kind, source, estimator, policy, block, episodes, skip)
        for world, task, preset, change, sources, estimators, episodes in _places(study)
        for kind, source in itertools.product(study.kinds, sources)
        for estimator in (estimators if source == "estimated" else study.estimators[:1])
        for block in range(study.blocks)
        for policy in _policy(task, kind, source, block, learned)
        for skip in [common_frame_skip([policy]) if kind == "recurrent" else skips[task]]
    ]


def _places(study: Study) -> Iterator[tuple]:
    """World, task, preset, change, sources, estimators and episodes of a block."""
    for world, task in itertools.product(study.worlds, study.tasks):
        estimators = [name for name in study.estimators if name in (world.estimators or study.estimators)]
        for preset in world.presets or study.presets:
            yield world, task, preset, UNCHANGED, world.sources, estimators, study.episodes
    worse = study.degradation
    if worse is not None:
        for task, change in itertools.product(study.tasks, changes(worse)):
            world = study.world(worse.world)
            yield world, task, worse.preset, change, worse.sources, study.estimators[:1], worse.episodes


def _policy(task: str, kind: str, source: str, block: int, learned: Shelf) -> list[str]:
    """The policy of a block, or none."""
    if kind == "classic" or (kind == "memory" and source == "none"):
        return [own_policy(task)]
    if kind == "recurrent":
        folder = pretrained.folders().get(f"{find(task).key}_memory")
        return [str(folder)] if folder and source == "none" else []
    seeds = learned.get((kind, task, TRAINED_WITH[source]), {})
    chosen = sorted(seeds)
    return [str(seeds[chosen[block % len(chosen)]])] if chosen else []
