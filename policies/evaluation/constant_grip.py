"""Finds the constant grip force that serves a task best: an opponent that reacts to nothing.

A conservative controller without friction information is one baseline; the best constant force is another. It
is tuned to the distribution of episodes, which nobody could do for a single new object.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from tqdm import tqdm

from policies.controllers.constant_force import ConstantForcePolicy
from policies.evaluation.batch import row_options
from policies.evaluation.experiment import Experiment
from policies.evaluation.plan import plan
from policies.evaluation.play import Played, play_episodes
from slipgym.config import GripperConfig

CANDIDATES = 24
"""Forces that are tried, spaced geometrically over the gripper's range."""
MODES = {"friction_source": "none", "action_mode": "grip_force"}
"""Arguments of the environments of a constant grip."""
_SELECTION_SEED = 1000
"""Added to the seed of an experiment: the force is chosen on other episodes than those it is evaluated on."""


class Outcomes(NamedTuple):
    """Outcomes of episodes with a constant force."""

    force: float
    """The command, per finger [N]."""
    played: Played
    """The episodes."""


def candidates(gripper: GripperConfig, number: int = CANDIDATES) -> list[float]:
    """Forces to try, rounded to 0.01 N [N]."""
    return np.geomspace(gripper.force_min, gripper.force_max, number).round(2).tolist()


def best_force(experiment: Experiment, number: int = CANDIDATES, progress: bool = True) -> float:
    """The best of a number of constant forces, rounded to 0.01 N [N]; arguments as for `run_constant`.

    It is chosen on episodes of other seeds than the experiment's.
    """
    chosen = experiment.model_copy(update={"seed": experiment.seed + _SELECTION_SEED})
    forces = candidates(experiment.environment_config().gripper, number)
    found = run_constant(chosen, forces, progress)
    return max(found, key=lambda one: one.played.strength).force


def run_constant(experiment: Experiment, forces: Sequence[float], progress: bool = True) -> list[Outcomes]:
    """Runs the episodes of an experiment with constant forces per finger [N] on the planar engine.

    The policies and friction choices of the experiment are not used.
    """
    alone = {"policies": experiment.policies[:1], "friction": experiment.friction[:1]}
    trials = plan(experiment.model_copy(update=alone))
    seeds, options = zip(*((trial.seed, row_options(trial)) for trial in trials), strict=True)
    arguments, found = {**experiment.arguments, **MODES}, []
    bar = tqdm(forces, desc=f"{experiment.task}, constant grip", unit="force", disable=not progress)
    for force in bar:
        policy = ConstantForcePolicy(force, experiment.config)
        found.append(Outcomes(force, play_episodes(experiment.task, policy, arguments, seeds, options)))
    return found
