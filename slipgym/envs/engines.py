"""What can move the bodies of an environment."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from slipgym.config import Config, Randomization, TaskConfig
from slipgym.envs.choices import one_of
from slipgym.envs.simulation import Simulation
from slipgym.tasks import Task

ENGINES = ("bullet", "planar")


def make_simulation(
    engine: str,
    config: Config,
    settings: TaskConfig,
    task: Task,
    estimator: str | Mapping[str, Any],
    randomization: Randomization,
) -> Simulation:
    """The loop of one environment.

    Raises:
        ValueError: The engine is unknown.
    """
    arguments = config, settings, task, estimator, randomization
    if one_of("engine", engine, ENGINES) == "planar":
        from slipgym.envs.planar_simulation import PlanarSimulation

        return PlanarSimulation(*arguments)
    from slipgym.envs.bullet_simulation import BulletSimulation

    return BulletSimulation(*arguments)
