"""The simulation of one environment with PyBullet."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import nullcontext
from dataclasses import replace
from typing import Any

import numpy as np

from slipgym._numba.compiled import patience
from slipgym._numba.fixed import Fixed
from slipgym.config import Config, Randomization, TaskConfig
from slipgym.envs.actions import COMPONENT
from slipgym.envs.bullet_step import BulletStep, fixed_action
from slipgym.envs.nan_guard import Guard
from slipgym.envs.observation import SENSORS, ObservationBuffers
from slipgym.envs.reset_kernels import WARM_UP_STEPS
from slipgym.envs.simulation import Simulation
from slipgym.envs.states import SimulationState
from slipgym.sensors.force_torque import roomier
from slipgym.tasks import Task
from slipgym.tasks.disturbance import bear_all, shake_tilt
from slipgym.world.bullet_engine import BulletWorld

_NO_ACTION = np.zeros((1, 0)), np.zeros(0, COMPONENT), np.ones(1, dtype=bool)
"""Changes no command."""


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
        self._first = True
        self._given: tuple[np.ndarray, ...] = _NO_ACTION
        self._action = self._no_action = fixed_action(*_NO_ACTION)
        m = len(SENSORS) + len(task.columns)
        low, high = np.full((2, m), [[-np.inf], [np.inf]], dtype=np.float32)
        out = np.zeros((1, m), dtype=np.float32)
        self._unseen = ObservationBuffers(np.zeros(0, dtype=np.int64), self.estimated, low, high, out)
        self._bind(self._unseen)

    def step(
        self,
        actions: np.ndarray,
        components: np.ndarray,
        skip: int,
        active: np.ndarray,
        buffers: ObservationBuffers,
    ) -> None:
        """See `Simulation.step`."""
        if buffers is not self._calls.buffers:
            self._bind(buffers)
        if not active.item(0):
            self.infos.terms[:] = 0.0
            return
        if actions is not self._given[0] or components is not self._given[1] or active is not self._given[2]:
            self._given = actions, components, active
            self._action = fixed_action(*self._given)
        for k in range(skip):
            self._control_step(self._action, k == 0)
            if k + 1 < skip and self.over:
                break

    def keep_samples(self, count: int) -> None:
        """Have the force/torque sensors keep their newest samples for the caller to read; they keep none yet.

        Args:
            count: How many, at most `slipgym.sensors.force_torque.HISTORY`.
        """
        self.plant.force_torque = roomier(self.plant.force_torque, count)
        self._choose_programs()
        self._bind(self._calls.buffers)
        self.world.bind()

    def sample(self, force: float) -> None:
        """One control step with a grip force per finger [N], the wrist as the task scripts it.

        Raises:
            FloatingPointError: A quantity is not finite; the environment needs a reset.
        """
        self.commands[0] = force, 0.0, 0.0, 0.0
        self._control_step(self._no_action, False)

    def get_state(self) -> SimulationState:
        """See `Simulation.get_state`."""
        return replace(super().get_state(), engine=self.world.get_state())

    def set_state(self, state: SimulationState, ready: np.ndarray) -> None:
        """See `Simulation.set_state`.

        Raises:
            ValueError: PyBullet does not accept its part of the state.
        """
        self.check_open()
        assert state.engine is not None
        self.world.set_state(state.engine)
        super().set_state(state, ready)

    @property
    def closed(self) -> bool:
        """Whether it was closed."""
        return self.world.closed

    def close(self) -> None:
        """Release the physics client; closing twice is harmless."""
        self.world.close()

    def _begin(self, starts: np.ndarray, values: np.ndarray) -> None:
        with patience(f"the reset of {self.task.name} with PyBullet") if self._first else nullcontext():
            self._reset(starts, values)
        self._first = False

    def _reset(self, starts: np.ndarray, values: np.ndarray) -> None:
        force, episode = starts["force"].item(), self.episode
        self._calls.equip(starts, values, *self._hardware, self.plant.cells)
        x, z, pitch = episode["wrist_start"][0].tolist()
        self.world.reset(self.boxes[0], force, (x, z, pitch), episode["wrist_roll"].item())
        bear_all(episode, self.plant.world)
        self._guard.reset()
        for _ in range(WARM_UP_STEPS):
            self._settle(force)
        self._calls.open(starts, self._fresh)

    def _bind(self, buffers: ObservationBuffers) -> None:
        """Have control steps write the observations to these buffers."""
        self._calls = BulletStep(
            self._kinds, self.state, self.plant.force_torque, buffers, self.infos, self._guard.rows
        )

    def _control_step(self, action: Fixed, fresh: bool) -> None:
        """The stages of `slipgym.envs.control_step`; PyBullet moves the bodies.

        Args:
            action: See `fixed_action`.
            fresh: Whether the reward terms start at 0.
        """
        world, calls = self.world, self._calls
        mass = calls.begin(action, fresh)
        if self.plant.tilt is not None:
            shake_tilt(self.episode, self.plant.tilt)
        pose, _, wrist, normals, _ = world.move(mass)
        bad = calls.finish(pose, wrist, normals, self._guard.next())
        if bad > 0:
            world.discard()
            self._guard.check(bad)

    def _settle(self, force: float) -> None:
        """One control step of the world and its sensors alone, with a grip force per finger [N]."""
        self.world.command(force)
        pose, _, wrist, normals, _ = self.world.move()
        self._calls.finish(pose, wrist, normals, -1)
