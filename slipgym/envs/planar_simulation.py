"""The simulation of n environments with the planar engine; one compiled call steps all of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from slipgym.config import Config, Randomization, TaskConfig
from slipgym.envs.nan_guard import Guard
from slipgym.envs.observation import ObservationBuffers
from slipgym.envs.planar_step import compiled_batch
from slipgym.envs.simulation import Simulation
from slipgym.envs.threads import Threads
from slipgym.tasks import Task


class PlanarSimulation(Simulation):
    """Simulation of n environments with the planar engine.

    Args:
        config: Configuration.
        settings: The task's settings.
        task: The task.
        estimator: Name of an estimator, or a mapping with its `name` and parameters.
        randomization: Distributions that an episode is sampled from; None: no randomization.
        n: Number of environments.
        threads: Number of threads; None: one per processor, each with at least 32 environments.

    Attributes:
        rewards: Sum of the last step's reward terms, (n,); 0 for environments that made no step.
        terminated: Whether the object was dropped in the last step, (n,).
        truncated: Whether the last step reached the time limit without a drop, (n,).

    Raises:
        ValueError: The configuration lets the object tilt, or a value is not allowed.
    """

    def __init__(
        self,
        config: Config,
        settings: TaskConfig,
        task: Task,
        estimator: str | Mapping[str, Any],
        randomization: Randomization | None = None,
        n: int = 1,
        threads: int | None = None,
    ) -> None:
        if config.physics.tilt:
            raise ValueError('physics.tilt = true needs engine="bullet": the planar engine has no tilt')
        super().__init__(config, settings, task, estimator, randomization, n)
        self._threads = Threads(n, threads)
        self._closed = False
        self._blank()
        self._drive, self._start = compiled_batch(*self._kinds)
        self._contact = self.plant.cells, self.plant.force_torque
        self._begun = *self._hardware, self._fresh

    def step(
        self,
        actions: np.ndarray,
        components: np.ndarray,
        skip: int,
        active: np.ndarray,
        buffers: ObservationBuffers,
        meanwhile: Callable[[], None] | None = None,
    ) -> None:
        """Make `skip` control steps, see `Simulation.step`; results are written to new arrays.

        Args:
            actions: (n, m).
            components: COMPONENT (m,), the meaning of the actions.
            skip: Number of control steps.
            active: Environments that take part, (n,) bool.
            buffers: Buffers that their observations are written to.
            meanwhile: Function to call while threads step; it may change the other environments.
        """
        self.check_open()
        self._blank()
        action = actions, components, active
        results = *self.infos, self.rewards, self.terminated, self.truncated

        def part(lo: int, hi: int) -> int:
            return self._drive(self.state, self._contact, buffers, action, results, skip, lo, hi)

        for bad in self._threads.run(part, meanwhile):
            if bad >= 0:
                self._explain(bad)

    @property
    def closed(self) -> bool:
        """Whether it was closed."""
        return self._closed

    def close(self) -> None:
        """End the threads; closing twice is harmless."""
        self._threads.close()
        self._closed = True

    def _begin(self, starts: np.ndarray, values: np.ndarray) -> None:
        self._start(starts, values, self.state, self._contact, self._begun, self.infos)

    def _blank(self) -> None:
        """Make new arrays for the results of a step: the caller owns those of the last step."""
        self.rewards, (self.terminated, self.truncated) = np.zeros(self.n), np.zeros((2, self.n), dtype=bool)

    def _explain(self, bad: int) -> None:
        """Raise FloatingPointError that names the first quantity of an environment that is not finite."""
        guard = Guard()
        found = self.stages.note(guard.rows, guard.next(), self.state, bad)
        try:
            guard.check(found)
        except FloatingPointError as error:
            where = f"environment {bad}: " if self.n > 1 else ""
            raise FloatingPointError(f"{where}{error}") from None
