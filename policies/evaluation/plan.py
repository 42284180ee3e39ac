"""The trials of an experiment and their seeds."""

from __future__ import annotations

import json
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from policies.evaluation.experiment import Experiment, FrictionChoice, PolicyChoice


@dataclass(frozen=True)
class Trial:
    """One episode."""

    policy: PolicyChoice
    """Who acts."""
    friction: FrictionChoice
    """Its friction information."""
    material: str
    """Name of a material, or "random"."""
    options: Mapping[str, Any]
    """Options of reset."""
    number: int
    """Number within its cell, from 0."""
    seed: int
    """Seed of the environment."""

    @property
    def keys(self) -> dict[str, Any]:
        """Columns that distinguish this trial from the others, for tables."""
        return {
            "policy": self.policy.title,
            "friction": self.friction.title,
            "friction_source": self.friction.source,
            "estimator": json.dumps(self.friction.argument),
            "material": self.material,
            "options": json.dumps(dict(self.options), sort_keys=True),
            "trial": self.number,
            "seed": self.seed,
        }


def plan(experiment: Experiment) -> list[Trial]:
    """Every trial, in the order of the tables."""
    return [
        Trial(policy, friction, material, options, number, seed(experiment.seed, material, options, number))
        for policy in experiment.policies
        for friction in experiment.friction
        if not policy.friction or friction.title in policy.friction
        for material in experiment.materials
        for options in experiment.combinations()
        for number in range(experiment.trials)
    ]


def seed(experiment_seed: int, material: str, options: Mapping[str, Any], number: int) -> int:
    """Seed of an environment, the same for every policy and friction choice: trials come in pairs.

    It depends on the scenario by its content, so that leaving out a material moves no other trial.
    """
    scenario = zlib.crc32(json.dumps([material, dict(options)], sort_keys=True).encode())
    return int(np.random.SeedSequence([experiment_seed, scenario, number]).generate_state(1)[0])
