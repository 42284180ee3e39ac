"""The paper's planar motion: 40 recorded trials, every estimator on the same data."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from lab.reproduction.campaign import Campaign, reproduce
from lab.reproduction.hanging import TASK
from lab.reproduction.published import TABLES
from lab.reproduction.records import Record, RecordKeeper
from policies.evaluation.plan import seed as seed_of
from slipgym.config import Overrides
from slipgym.envs.bullet_simulation import BulletSimulation
from slipgym.tasks import configure

MASS, LEVER, ASIDE = (0.15, 0.25), (0.03, 0.05), (-0.003, 0.003)  # [kg], [m], [m]
DURATION = (2.0, 5.0)  # [s] for the turn
INITIAL_FORCE = 10.0  # [N]


def reproduce_planar(
    output: str | os.PathLike[str] = "runs",
    trials: int = 10,
    jobs: int = 1,
    seed: int = 0,
    contact: str = "distributed",
    progress: bool = True,
) -> Path:
    """Records `trials` turns round a hanging object per material and runs the estimators on the records.

    Args:
        output: Folder that the run's own folder goes to.
        trials: Per material.
        jobs: Processes; -1 for one per core. The results do not depend on it.
        seed: Of the experiment.
        contact: Friction model of the pads, "distributed" or "ellipsoid".
        progress: Whether to show progress bars.

    Returns:
        The run's folder, as described in docs/reproduction/planar.md.

    Raises:
        ValueError: An argument is not allowed.
    """
    campaign = Campaign("planar", record_planar, {"contact": contact}, seed)
    return reproduce(campaign, scenarios(trials, seed), {"material": "plastic"}, output, jobs, progress)


def scenarios(trials: int, seed: int) -> list[dict[str, Any]]:
    """Material, number and seed of every trial.

    Args:
        trials: Per material.
        seed: Of the experiment.

    Raises:
        ValueError: There are none.
    """
    if trials < 1:
        raise ValueError(f"trials = {trials} must be at least 1")
    return [
        {"material": material, "trial": trial, "seed": seed_of(seed, material, {"task": "planar"}, trial)}
        for material in TABLES["planar"]
        for trial in range(trials)
    ]


def record_planar(scenario: Mapping[str, Any], contact: str, config: Overrides | None = None) -> Record:
    """Runs one trial with realistic sensors and keeps what they say.

    Mass, grasp point (above the centre of mass, a little aside) and duration are drawn.

    Args:
        scenario: material and seed.
        contact: Friction model of the pads.
        config: Overrides of the environment's configuration.
    """
    rng = np.random.default_rng(scenario["seed"])
    mass, lever, aside, duration = (rng.uniform(*limits) for limits in (MASS, LEVER, ASIDE, DURATION))
    drawn = {"mass": mass, "lever": lever, "aside": aside, "duration": duration}
    fixed = {"object_mass": mass, "com_offset": (aside, -lever), "duration": duration}
    options = TASK.options.parse({**fixed, "initial_force": INITIAL_FORCE})
    simulation = BulletSimulation(*configure(TASK, config, contact=contact), TASK, "rls")
    try:
        simulation.reset(options, scenario["material"], rng)
        recorder, episode = RecordKeeper(simulation), simulation.episode[0]
        while episode["step"] < episode["steps"] and not episode["dropped"]:
            mu_c = simulation.true_friction[0, 1]
            simulation.sample(hinge_force(simulation.wrenches[0], simulation.twists[0], mu_c))
            recorder.take()
        return recorder.finish({**scenario, **drawn})
    finally:
        simulation.close()


def hinge_force(wrenches: np.ndarray, twists: np.ndarray, mu_c: float) -> float:
    """Hinge controller of arXiv 2410.19660: f = max(0.6, 1.4 f_t / mu_c + 100 v_t) [N].

    Args:
        wrenches: Measured f_x, f_y, f_n, tau of both fingers, (2, 4) [N, N, N, N m].
        twists: Measured v_x, v_y, omega, (2, 3) [m/s, m/s, rad/s].
        mu_c: Coulomb friction that it acts on [-].
    """
    f_t = np.hypot(wrenches[:, 0], wrenches[:, 1]).mean()
    v_x, v_y, _ = twists.mean(axis=0)
    return max(0.6, 1.4 * float(f_t) / mu_c + 100.0 * math.hypot(v_x, v_y))
