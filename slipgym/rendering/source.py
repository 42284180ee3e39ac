"""The interface of a simulation that the renderer needs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from estimator.batch import BatchEstimator
from slipgym.config import Config
from slipgym.tasks.task import Task
from slipgym.world.plant import Plant
from slipgym.world.scene import Box


class Source(Protocol):
    """The state of n environments; `slipgym.envs.simulation.Simulation` is one."""

    @property
    def config(self) -> Config:
        """Configuration."""
        ...

    @property
    def task(self) -> Task:
        """The task."""
        ...

    @property
    def plant(self) -> Plant:
        """Worlds, pads, fingers and sensors."""
        ...

    @property
    def estimator(self) -> BatchEstimator:
        """Estimators of both fingers of each environment, (2n,)."""
        ...

    @property
    def episode(self) -> np.ndarray:
        """EPISODE (n,)."""
        ...

    @property
    def task_part(self) -> np.ndarray:
        """The task's part of the observation, (n, k)."""
        ...

    @property
    def estimated(self) -> np.ndarray:
        """Estimates of both fingers merged, with their confidence and deviations, (n, 11)."""
        ...

    @property
    def ground_truth(self) -> np.ndarray:
        """True friction, columns as `estimated`, (n, 11)."""
        ...

    @property
    def materials(self) -> Sequence[str]:
        """Name of every episode's material."""
        ...

    @property
    def boxes(self) -> Sequence[Box]:
        """Its object."""
        ...
