"""The interface of a simulation that the renderer needs."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from estimator.batch import BatchEstimator
from slipgym.config import Config
from slipgym.tasks.task import Task
from slipgym.world.plant import Plant
from slipgym.world.scene import Box


class Source(Protocol):
    """The state of n environments; `slipgym.envs.simulation.Simulation` is one."""

    config: Config
    """Configuration."""
    task: Task
    """The task."""
    plant: Plant
    """Worlds, pads, fingers and sensors."""
    episode: np.ndarray
    """EPISODE (n,)."""
    task_part: np.ndarray
    """The task's part of the observation, (n, k)."""
    estimated: np.ndarray
    """Estimates of both fingers merged, with their confidence and deviations, (n, 11)."""
    ground_truth: np.ndarray
    """True friction, columns as `estimated`, (n, 11)."""
    materials: list[str]
    """Name of every episode's material."""
    boxes: list[Box]
    """Its object."""

    @property
    def estimator(self) -> BatchEstimator:
        """Estimators of both fingers of each environment, (2n,); missing where nothing is estimated."""
        ...
