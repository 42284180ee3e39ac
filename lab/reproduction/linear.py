"""The paper's linear slip: 160 recorded trials, every estimator on the same data."""

from __future__ import annotations

import itertools
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import policies
from lab.reproduction.campaign import Campaign, reproduce
from lab.reproduction.published import TABLES
from lab.reproduction.records import Record, RecordKeeper
from policies.evaluation.plan import seed as seed_of
from policies.stepping import steps
from slipgym.config import Overrides
from slipgym.envs import LinearSlipEnv

DISTANCES, DURATIONS = (0.02, 0.04), (2.0, 5.0)  # [m], [s]


def reproduce_linear(
    output: str | os.PathLike[str] = "runs",
    trials: int = 10,
    jobs: int = 1,
    seed: int = 0,
    friction_source: str = "true",
    contact: str = "distributed",
    progress: bool = True,
) -> Path:
    """Records {20, 40 mm} x {2, 5 s} x `trials` for each material and runs the estimators on the records.

    Args:
        output: Folder that the run's own folder goes to.
        trials: Per material, distance and duration.
        jobs: Processes; -1 for one per core. The results do not depend on it.
        seed: Of the experiment.
        friction_source: Friction that the controller acts on, "true" or "estimated" ("rls" with its
            heuristic), or "nominal".
        contact: Friction model of the pads, "distributed" or "ellipsoid".
        progress: Whether to show progress bars.

    Returns:
        The run's folder, as described in docs/reproduction/linear.md.

    Raises:
        ValueError: An argument is not allowed.
    """
    cells = itertools.product(TABLES["linear"], DISTANCES, DURATIONS, range(trials))
    scenarios = [
        {
            "material": material,
            "distance": distance,
            "duration": duration,
            "trial": trial,
            "seed": seed_of(seed, material, {"distance": distance, "duration": duration}, trial),
        }
        for material, distance, duration, trial in cells
    ]
    settings = {"friction_source": friction_source, "contact": contact}
    exploration = {"distance": DISTANCES[0], "duration": DURATIONS[0]}
    campaign = Campaign("linear", record_linear, settings, seed, exploration)
    example = {"material": "plastic", "distance": 0.04, "duration": 5.0}
    return reproduce(campaign, scenarios, example, output, jobs, progress)


def record_linear(
    scenario: Mapping[str, Any], friction_source: str, contact: str, config: Overrides | None = None
) -> Record:
    """Runs one trial, closed loop with realistic sensors, and keeps what the sensors say.

    Args:
        scenario: material, distance [m], duration [s] and seed.
        friction_source: Friction that the controller acts on.
        contact: Friction model of the pads.
        config: Overrides of the environment's configuration.
    """
    policy = policies.make("linear_slip_continuous")
    chosen: dict[str, Any] = {"friction_source": friction_source, "contact": contact, "config": config}
    env = LinearSlipEnv(**chosen, material=scenario["material"])
    try:
        options = {name: scenario[name] for name in ("distance", "duration")}
        observation, _ = env.reset(seed=scenario["seed"], options=options)
        recorder = RecordKeeper(env.simulation)
        for _ in steps(env, policy, observation):
            recorder.take()
        return recorder.finish(scenario)
    finally:
        env.close()
