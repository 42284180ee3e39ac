"""The simulation of one environment with PyBullet."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from typing import Any

import numpy as np

from slipgym._numba.compiled import patience
from slipgym.config import Config, Randomization, TaskConfig
from slipgym.envs.actions import interpret
from slipgym.envs.nan_guard import Guard
from slipgym.envs.observation import ObservationBuffers, combine, observe
from slipgym.envs.reset_kernels import WARM_UP_STEPS, equip, open_episodes
from slipgym.envs.simulation import Simulation, SimulationState
from slipgym.sensors.measure import measure
from slipgym.tasks import Task
from slipgym.tasks.disturbance import disturb, shake_tilt
from slipgym.tasks.episode import begin_step
from slipgym.world.bullet_engine import BulletWorld

_NOTHING: AbstractContextManager[None] = nullcontext()


class BulletSimulation(Simulation):
    """Simulation of one environment; PyBullet moves the bodies.

    Args:
        config: Configuration.
        settings: The task's settings.
        task: The task.
        estimator: Name of an estimator, or a mapping with its `name` and parameters.
        randomization: Distributions that an episode is sampled from; None: no randomization.

    Attributes:
        world: The PyBullet world, which moves the bodies of `plant`.
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
        self._compiled: set[str] = set()
        self._wrench_rows, self._twist_rows = self.wrenches.reshape(2, 4), self.twists.reshape(2, 3)

    def step(
        self,
        actions: np.ndarray,
        components: np.ndarray,
        skip: int,
        active: np.ndarray,
        buffers: ObservationBuffers,
    ) -> None:
        """See `Simulation.step`."""
        with self._patience("step"):
            self._step(actions, components, skip, active, buffers)

    def _step(
        self,
        actions: np.ndarray,
        components: np.ndarray,
        skip: int,
        active: np.ndarray,
        buffers: ObservationBuffers,
    ) -> None:
        episode, terms = self.episode, self.infos.terms
        terms[:] = 0.0
        for _ in range(skip if active[0] else 0):
            interpret(actions, components, episode, self.commands)
            self._control_step()
            terms += episode["terms"][:, : terms.shape[1]]
            if episode["dropped"].item() or episode["step"].item() >= episode["steps"].item():
                break
        plant = self.plant
        observe(
            self.wrenches, self.twists, plant.slip_sensors, episode, self.task_part, plant.world, *buffers
        )
        self._write_infos()

    def sample(self, force: float) -> None:
        """One control step with a grip force per finger [N], the wrist as the task scripts it.

        Raises:
            FloatingPointError: A quantity is not finite; the environment needs a reset.
        """
        self.commands[0] = force, 0.0, 0.0, 0.0
        self._control_step()

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
        with self._patience("reset"):
            self._reset(starts)

    def _patience(self, stage: str) -> AbstractContextManager[None]:
        """Explains on stderr that code is being compiled, if the first reset or step takes long."""
        if stage in self._compiled:
            return _NOTHING
        self._compiled.add(stage)
        return patience(f"the {stage} of {self.task.name} with PyBullet")

    def _reset(self, starts: np.ndarray) -> None:
        force, episode = starts["force"].item(), self.episode
        x, z, pitch = episode["wrist_start"][0].tolist()
        self.world.reset(self.boxes[0], force, (x, z, pitch), episode["wrist_roll"].item())
        self._guard.reset()
        equip(starts, *self._biases, *self._equipped)
        for _ in range(WARM_UP_STEPS):
            self._advance(force)
        open_episodes(starts, *self._fresh, *self._opened, self.infos.terms)
        combine(self.estimator.estimates, self.per_finger, self.estimated)
        self.task.evaluate_step(episode, self.plant.world, self.plant.fingers, self.task_part)
        self._write_infos()

    def _control_step(self) -> None:
        """Act, move, measure, estimate, evaluate: the stages of `slipgym.envs.control_step`."""
        plant, episode = self.plant, self.episode
        begin_step(episode, self.commands)
        disturb(episode, plant.world, plant.pads, self.ground_truth)
        self.world.update_mass()
        self.task.script_wrist(episode, plant.world)
        if plant.tilt is not None:
            shake_tilt(episode, plant.tilt)
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
