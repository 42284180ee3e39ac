"""Assembles observations: their layout, history and groups."""

from __future__ import annotations

from typing import Any, TypeAlias

import gymnasium as gym
import numpy as np

from slipgym._numba.fixed import Fixed
from slipgym.envs.load_part import LOAD
from slipgym.envs.observation import DEVIATIONS, ObservationBuffers, columns, wrist_part
from slipgym.envs.privileged import privileged_columns, write_privileged
from slipgym.envs.sensor_part import sensor_rows
from slipgym.envs.simulation import Simulation
from slipgym.envs.stages import STATE
from slipgym.tasks.task import Column

Observation: TypeAlias = np.ndarray | dict[str, np.ndarray]
"""An array, or one per group."""


class Observer:
    """Assembles the observations of a simulation, in the layout of the environments' arguments.

    Attributes:
        columns: Columns of one observation, or of its group "policy".
        privileged: Columns of the group "privileged"; empty unless the mode has groups.
        space: The observation space of one environment.
        buffers: Buffers that the simulation writes the observations to.
        history: Number of earlier observations in each observation.
    """

    def __init__(
        self,
        simulation: Simulation,
        friction_source: str,
        action_mode: str,
        mode: str,
        history: int,
        load_columns: bool = False,
    ) -> None:
        self._simulation, self._state = simulation, Fixed(simulation.state, STATE)
        self.history = history
        named = friction_source, action_mode, mode, load_columns
        self.columns = columns(simulation.config, simulation.task, *named)
        low, high = _bounds(self.columns)
        wrist = np.array(wrist_part(simulation.task, action_mode), dtype=np.int64)
        friction = _friction_part(simulation, friction_source)
        settings = wrist, friction, low, high, np.arange(len(LOAD) if load_columns else 0)
        out = np.zeros((simulation.n, len(self.columns)), dtype=np.float32)
        self.buffers = ObservationBuffers(*settings, out, sensor_rows(simulation.config))
        self._first = out[0]
        if history:  # the newest observation comes last
            self._frames = np.zeros((simulation.n, history + 1, len(self.columns)), dtype=np.float32)
        policy = gym.spaces.Box(np.tile(low, history + 1), np.tile(high, history + 1))
        self.privileged: tuple[Column, ...] = ()
        self.space: gym.Space = policy
        if mode.endswith("dict"):
            self.privileged = privileged_columns(simulation.config)
            self._privileged_bounds = _bounds(self.privileged)
            self._ground_truth = np.zeros((simulation.n, len(self.privileged)), dtype=np.float32)
            ground_truth = gym.spaces.Box(*self._privileged_bounds)
            self.space = gym.spaces.Dict({"policy": policy, "privileged": ground_truth})
        self._all = np.arange(simulation.n)
        self._look(self._all)

    def begin(self, rows: np.ndarray) -> None:
        """Observe some environments after a reset; the first observation fills their whole history."""
        self._look(rows)
        if self.history:
            self._frames[rows] = self.buffers.out[rows, np.newaxis]

    def next(self, active: np.ndarray) -> None:
        """Complete the observations of a step, which the simulation has written to `buffers`.

        Args:
            active: Environments that made a step, (n,) bool.
        """
        if self.history:
            self._frames[active, :-1] = self._frames[active, 1:]
            self._frames[active, -1] = self.buffers.out[active]
        if self.privileged:
            self._look_behind(self._all)

    def read(self, row: Any = ...) -> Observation:
        """Observations of all environments (n, k), or of one, owned by the caller."""
        policy = self._frames.reshape(self._simulation.n, -1) if self.history else self.buffers.out
        if not self.privileged:
            return policy[row].copy()
        return {"policy": policy[row].copy(), "privileged": self._ground_truth[row].copy()}

    def first(self) -> Observation:
        """The observation of the first environment, owned by the caller."""
        return self.read(0) if self.history or self.privileged else self._first.copy()

    def get_state(self) -> np.ndarray:
        """The last observations (n, history + 1, m), the newest one last."""
        if self.history:
            return self._frames.copy()
        return self.buffers.out[:, np.newaxis].copy()

    def set_state(self, frames: np.ndarray, rows: np.ndarray) -> None:
        """Restore the history of some rows (n,) bool; all else follows from the simulation's state."""
        self._look(self._all)
        if self.history:
            self._frames[rows] = frames[rows]

    def _look(self, rows: np.ndarray) -> None:
        self._simulation.stages.look_at(rows, self._state, self.buffers)
        if self.privileged:
            self._look_behind(rows)

    def _look_behind(self, rows: np.ndarray) -> None:
        """Write the group "privileged" of some environments."""
        plant, (low, high) = self._simulation.plant, self._privileged_bounds
        write_privileged(rows, self._state, plant.force_torque, low, high, self._ground_truth)


def _friction_part(simulation: Simulation, source: str) -> np.ndarray:
    """Values of the friction part, (n, 11): a view of the simulation's array, or constants."""
    if source in ("estimated", "true"):
        return simulation.estimated if source == "estimated" else simulation.ground_truth
    nominal = simulation.config.nominal
    radius = simulation.settings.radius or nominal.r
    return np.tile(
        [nominal.mu_s, nominal.mu_c, radius, 1.0, 1.0, 1.0, *[0.0] * len(DEVIATIONS)], (simulation.n, 1)
    )


def _bounds(named: tuple[Column, ...]) -> tuple[np.ndarray, np.ndarray]:
    low, high = ([getattr(column, end) for column in named] for end in ("low", "high"))
    return np.array(low, dtype=np.float32), np.array(high, dtype=np.float32)
