"""Finds the constant grip force that serves a task best: an opponent that reacts to nothing.

A conservative controller without friction information is one baseline; the best constant force is another. It
is tuned to the distribution of episodes, which nobody could do for a single new object.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import gymnasium as gym
import numpy as np
from tqdm import tqdm

from policies.controllers.constant_force import ConstantForcePolicy
from policies.evaluation.batch import row_options
from policies.evaluation.experiment import Experiment
from policies.evaluation.plan import plan
from policies.evaluation.play import Played, play
from slipgym.tasks import find

CANDIDATES = 24
"""Forces that are tried, spaced geometrically over the gripper's range."""
_SELECTION_SEED = 1000
"""Added to the seed of an experiment: the force is chosen on other episodes than those it is evaluated on."""


class Outcomes(NamedTuple):
    """Outcomes of episodes with a constant force."""

    force: float
    """The command, per finger [N]."""
    played: Played
    """The episodes."""


def best_force(experiment: Experiment, candidates: int = CANDIDATES, progress: bool = True) -> float:
    """The force with the highest success rate, among equals with the largest mean sum of rewards.

    Args:
        experiment: Says which task and episodes; its policies and friction choices are not used. The episodes
            have other seeds than its trials and run on the planar engine.
        candidates: Forces to try.
        progress: Whether to show a progress bar.

    Returns:
        Force per finger, rounded to 0.01 N [N].
    """
    chosen = experiment.model_copy(update={"seed": experiment.seed + _SELECTION_SEED})
    gripper = experiment.environment_config().gripper
    forces = np.geomspace(gripper.force_min, gripper.force_max, candidates).round(2)
    found = run_constant(chosen, forces.tolist(), progress)
    return max(found, key=lambda one: (one.played.success.mean(), one.played.reward.mean())).force


def run_constant(experiment: Experiment, forces: Sequence[float], progress: bool = True) -> list[Outcomes]:
    """Runs the episodes of an experiment with constant forces, in one vector environment.

    Args:
        experiment: As for `best_force`; here its own seeds count.
        forces: Forces per finger [N].
        progress: Whether to show a progress bar.
    """
    alone = {"policies": experiment.policies[:1], "friction": experiment.friction[:1]}
    trials = plan(experiment.model_copy(update=alone))
    seeds, options = zip(*((trial.seed, row_options(trial)) for trial in trials), strict=True)
    config = dict(experiment.config)
    envs = gym.make_vec(
        f"slipgym:{find(experiment.task).id}",
        len(trials),
        "vector_entry_point",
        action_mode="grip_force",
        friction_source="none",
        sensors=experiment.sensors,
        randomization=experiment.randomization,
        level=experiment.level,
        config=config,
    )
    try:
        bar = tqdm(forces, desc=f"{experiment.task}, constant grip", unit="force", disable=not progress)
        return [
            Outcomes(force, play(envs, ConstantForcePolicy(force, config), seeds, options)) for force in bar
        ]
    finally:
        envs.close()
