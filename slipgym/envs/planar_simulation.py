"""n environments without an engine, many of them in one compiled call."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from estimator.registry import specification
from slipgym.config import Config, Randomization, TaskConfig
from slipgym.envs.guard import Guard
from slipgym.envs.observation import Sight
from slipgym.envs.planar_step import compiled_batch
from slipgym.envs.simulation import Simulation
from slipgym.envs.threads import Threads
from slipgym.tasks import Task


class PlanarSimulation(Simulation):
    """A loop around planar worlds that the pads' friction alone moves.

    Args:
        config: As of `Simulation`, like the others.
        settings: The task's settings.
        task: The task.
        estimator: The estimator.
        randomization: What is drawn.
        n: Environments.
        threads: Threads that share them; None: as many as there are processors, if there is work for them.

    Attributes:
        rewards: Sum of the last step's reward terms, (n,); 0 without a step.
        terminated: Whether the object was dropped in it, (n,).
        truncated: Whether the episode's time had passed after it, and nothing was dropped, (n,).
        tells_all: Whether a step fills in `told` of all environments, or only where an episode ends; True.
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
        super().__init__(config, settings, task, estimator, randomization, n)
        self._threads = Threads(n, threads)
        self._closed, self.tells_all = False, True
        self._blank()
        kind, plant = specification(self.estimator_choice["name"]), self.plant
        batch = self.estimator
        dtypes = batch.states.dtype, batch.parameters_array.dtype, plant.force_torque.dtype
        self._drive, self._start = compiled_batch(task, kind.update_batch, *dtypes, plant.cells is not None)
        self._records = (
            plant.world, plant.pads, plant.cells, plant.fingers, plant.force_torque, plant.slip_sensors,
            batch.parameters_array, batch.states, batch.estimates,
            self.episode, self.commands, self.wrenches, self.twists,
            self.per_finger, self.estimated, self.task_part, self.truth,
        )  # fmt: skip
        self._begun = *self._fresh, *self._biases

    def step(
        self,
        actions: np.ndarray,
        components: np.ndarray,
        skip: int,
        active: np.ndarray,
        sight: Sight,
        meanwhile: Callable[[], None] | None = None,
    ) -> None:
        """See `Simulation.step`; results are written into new arrays.

        Args:
            actions: See there, like all but the last.
            components: See there.
            skip: See there.
            active: See there.
            sight: See there.
            meanwhile: What may be done with the other environments at the same time.
        """
        self.check_open()
        self._blank()
        action = actions, components, active
        results = *self.told, self.rewards, self.terminated, self.truncated

        def part(lo: int, hi: int) -> int:
            return self._drive(self._records, sight, action, results, self.tells_all, skip, lo, hi)

        for bad in self._threads.run(part, meanwhile):
            if bad >= 0:
                self._explain(bad)

    @property
    def closed(self) -> bool:
        """Whether it was closed."""
        return self._closed

    def close(self) -> None:
        """Give the threads back; closing twice is harmless."""
        self._threads.close()
        self._closed = True

    def _begin(self, starts: np.ndarray) -> None:
        self._start(starts, self._records, self._begun, self.told)

    def _blank(self) -> None:
        """New arrays for a step's results: the former ones belong to whoever has them."""
        self.rewards, (self.terminated, self.truncated) = np.zeros(self.n), np.zeros((2, self.n), dtype=bool)

    def _explain(self, bad: int) -> None:
        """Raise FloatingPointError, naming what of an environment is not finite."""
        plant, time = self.plant, self.episode["step"].item(bad) * self.step_time
        arrays = (
            plant.world,
            plant.pads,
            plant.fingers,
            self.wrenches,
            self.twists,
            self.per_finger,
            self.episode,
        )
        try:
            Guard().watch(time, bad, *arrays)
        except FloatingPointError as error:
            where = f"environment {bad}: " if self.n > 1 else ""
            raise FloatingPointError(f"{where}{error}") from None
