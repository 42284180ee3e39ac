"""One environment whose bodies PyBullet moves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from slipgym.config import Config, Randomization, TaskConfig
from slipgym.envs.actions import interpret
from slipgym.envs.guard import Guard
from slipgym.envs.observation import Sight, combine, observe
from slipgym.envs.simulation import Simulation, SimulationState
from slipgym.envs.start import WARM_UP_STEPS, equip, open_episodes
from slipgym.sensors.measure import measure
from slipgym.tasks import Task
from slipgym.tasks.disturbance import disturb
from slipgym.tasks.episode import begin_step
from slipgym.world.bullet_engine import BulletWorld


class BulletSimulation(Simulation):
    """A loop around a PyBullet world.

    Args:
        config: As of `Simulation`, like the others.
        settings: The task's settings.
        task: The task.
        estimator: The estimator.
        randomization: What is drawn.

    Attributes:
        world: PyBullet around the plant.
    """

    def __init__(
        self,
        config: Config,
        settings: TaskConfig,
        task: Task,
        estimator: str | Mapping[str, Any],
        randomization: Randomization | None = None,
    ) -> None:
        super().__init__(config, settings, task, estimator, randomization)
        self.world = BulletWorld(config, self.plant)
        self._guard = Guard()
        self._wrench_rows, self._twist_rows = self.wrenches.reshape(2, 4), self.twists.reshape(2, 3)

    def step(
        self, actions: np.ndarray, components: np.ndarray, skip: int, active: np.ndarray, sight: Sight
    ) -> None:
        """See `Simulation.step`."""
        episode, terms = self.episode, self.told.terms
        terms[:] = 0.0
        for _ in range(skip if active[0] else 0):
            interpret(actions, components, episode, self.commands)
            self._sample()
            terms += episode["terms"][:, : terms.shape[1]]
            if episode["dropped"].item() or episode["step"].item() >= episode["steps"].item():
                break
        plant = self.plant
        observe(self.wrenches, self.twists, plant.slip_sensors, episode, self.task_part, plant.world, *sight)
        self._tell()

    def sample(self, force: float) -> None:
        """One slip-velocity sample with a grip force per finger [N], the wrist as the task scripts it.

        Raises:
            FloatingPointError: Something is no longer a finite number; only a reset helps.
        """
        self.commands[0] = force, 0.0, 0.0, 0.0
        self._sample()

    def get_state(self) -> SimulationState:
        """See `Simulation.get_state`."""
        return replace(super().get_state(), engine=self.world.get_state())

    def set_state(self, state: SimulationState) -> None:
        """See `Simulation.set_state`."""
        self.check_open()
        if state.engine is None:
            raise ValueError("the state is of a loop without PyBullet")
        self.world.set_state(state.engine)
        super().set_state(state)

    @property
    def closed(self) -> bool:
        """Whether it was closed."""
        return self.world.closed

    def close(self) -> None:
        """Release the physics client; closing twice is harmless."""
        self.world.close()

    def _begin(self, starts: np.ndarray) -> None:
        force, episode = starts["force"].item(), self.episode
        x, z, pitch = episode["wrist_start"][0].tolist()
        self.world.reset(self.boxes[0], force, (x, z, pitch))
        self._guard.reset()
        equip(starts, *self._biases, *self._equipped)
        for _ in range(WARM_UP_STEPS):
            self._advance(force)
        open_episodes(starts, *self._fresh, *self._opened, self.told.terms)
        combine(self.estimator.estimates, self.per_finger, self.estimated)
        self.task.evaluate_step(episode, self.plant.world, self.plant.fingers, self.task_part)
        self._tell()

    def _sample(self) -> None:
        """Act, move, measure, estimate, judge."""
        plant, episode = self.plant, self.episode
        begin_step(episode, self.commands)
        disturb(episode, plant.world, plant.pads, self.truth)
        self.world.weigh()
        self.task.script_wrist(episode, plant.world)
        self._advance(self.commands.item(0))
        episode["step"] += 1
        self.estimator.update(self.time, self._wrench_rows, self._twist_rows)
        combine(self.estimator.estimates, self.per_finger, self.estimated)
        self.task.evaluate_step(episode, plant.world, plant.fingers, self.task_part)
        arrays = plant.world, plant.pads, plant.fingers, self.wrenches, self.twists, self.per_finger, episode
        try:
            self._guard.watch(self.time, 0, *arrays)
        except FloatingPointError:
            self.world.discard()
            raise

    def _advance(self, force: float) -> None:
        """One control step of the world and its sensors."""
        plant = self.plant
        self.world.command(force)
        self.world.step()
        measure(plant.world, plant.force_torque, plant.slip_sensors, self.wrenches, self.twists)
