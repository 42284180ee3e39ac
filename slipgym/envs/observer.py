"""What an environment observes: layout, history and groups."""

from __future__ import annotations

from typing import TypeAlias

import gymnasium as gym
import numpy as np

from slipgym.envs import privileged
from slipgym.envs.choices import one_of, whole
from slipgym.envs.observation import (
    FRICTION_SOURCES,
    OBSERVATION_MODES,
    WRIST_COLUMNS,
    Sight,
    columns,
    observe_some,
    wrist_columns,
)
from slipgym.envs.simulation import Simulation
from slipgym.tasks.task import Column

Observation: TypeAlias = np.ndarray | dict[str, np.ndarray]
"""An array, or one per group."""


class Observer:
    """Reads the observations out of a simulation.

    Args:
        simulation: What is observed.
        friction_source: What the friction part holds.
        action_mode: What actions mean; decides about the wrist part.
        mode: "flat", "sensor" or "dict".
        history: How many earlier observations come along.

    Attributes:
        columns: Of one observation, or of its group "policy".
        privileged: Columns of the group "privileged"; empty without one.
        space: The observation space of one environment.
        sight: Where the loop writes what is observed.

    Raises:
        ValueError: The value of an argument is unknown or not allowed.
    """

    def __init__(
        self, simulation: Simulation, friction_source: str, action_mode: str, mode: str, history: int
    ) -> None:
        one_of("friction_source", friction_source, FRICTION_SOURCES)
        one_of("observation_mode", mode, OBSERVATION_MODES)
        self._simulation = simulation
        self._history = whole("history", history, 0)
        self.columns = columns(simulation.config, simulation.task, friction_source, action_mode, mode)
        wrist = wrist_columns(simulation.task, action_mode)
        low, high = _bounds(self.columns)
        placed = np.array([WRIST_COLUMNS.index(column) for column in wrist], dtype=np.int64)
        self._looks = placed, _friction_part(simulation, friction_source), low, high
        self.sight = Sight(*self._looks, np.zeros((simulation.n, len(self.columns)), dtype=np.float32))
        if history:  # the last observations, the present one last; without it `sight` has all
            self._frames = np.zeros((simulation.n, history + 1, len(self.columns)), dtype=np.float32)
        policy = gym.spaces.Box(np.tile(low, history + 1), np.tile(high, history + 1))
        self.privileged: tuple[Column, ...] = ()
        self.space: gym.Space = policy
        if mode == "dict":
            self.privileged = privileged.columns(simulation.config)
            self._truth_bounds = _bounds(self.privileged)
            self._truth = np.zeros((simulation.n, len(self.privileged)), dtype=np.float32)
            truth = gym.spaces.Box(*self._truth_bounds)
            self.space = gym.spaces.Dict({"policy": policy, "privileged": truth})

    def begin(self, rows: np.ndarray) -> None:
        """Take the first observations of some environments; they stand for those before them, too."""
        self._look(rows)
        if self._history:
            self._frames[rows] = self.sight.out[rows, np.newaxis]

    def next(self, active: np.ndarray) -> None:
        """Take what the loop observed after a step.

        Args:
            active: Which environments took part, (n,).
        """
        if self._history:
            self._frames[active, :-1] = self._frames[active, 1:]
            self._frames[active, -1] = self.sight.out[active]

    def again(self) -> None:
        """Take the present observations of all environments once more, after some were handed over."""
        self._look(np.arange(self._simulation.n))

    def present(self) -> Observation:
        """Observations of all environments, (n, k) each, for as long as nothing changes."""
        policy = self._frames.reshape(self._simulation.n, -1) if self._history else self.sight.out
        if not self.privileged:
            return policy
        plant, (low, high) = self._simulation.plant, self._truth_bounds
        privileged.reveal(
            plant.world, plant.pads, plant.fingers, self._simulation.truth, low, high, self._truth
        )
        return {"policy": policy, "privileged": self._truth}

    def read(self) -> Observation:
        """Observations of all environments, the receiver's own; the next ones go into another array."""
        observations = self.present()
        if self._history:
            self._frames = self._frames.copy()
        else:
            self.sight = Sight(*self._looks, np.empty_like(self.sight.out))
        if self.privileged:
            self._truth = np.empty_like(self._truth)
        return observations

    def get_state(self) -> np.ndarray:
        """The last observations (n, history + 1, m), the present one last."""
        if self._history:
            return self._frames.copy()
        self.again()
        return self.sight.out[:, np.newaxis].copy()

    def set_state(self, frames: np.ndarray) -> None:
        """Go on from the last observations; without history the loop's state has all that is needed."""
        if self._history:
            self._frames[:] = frames

    def _look(self, rows: np.ndarray) -> None:
        simulation = self._simulation
        arrays = (
            simulation.wrenches,
            simulation.twists,
            simulation.plant.slip_sensors,
            simulation.episode,
            simulation.task_part,
            simulation.plant.world,
        )
        observe_some(rows, *arrays, *self.sight)


def first(observations: Observation) -> Observation:
    """That of the first environment."""
    if isinstance(observations, dict):
        return {group: values[0] for group, values in observations.items()}
    return observations[0]


def _friction_part(simulation: Simulation, source: str) -> np.ndarray:
    """What the friction part holds, (n, 6): an array of the loop's, or values that never change."""
    if source in ("estimated", "true"):
        return simulation.estimated if source == "estimated" else simulation.truth
    nominal = simulation.config.nominal
    radius = simulation.settings.radius or nominal.r
    return np.tile([nominal.mu_s, nominal.mu_c, radius, 1.0, 1.0, 1.0], (simulation.n, 1))


def _bounds(named: tuple[Column, ...]) -> tuple[np.ndarray, np.ndarray]:
    low, high = ([getattr(column, end) for column in named] for end in ("low", "high"))
    return np.array(low, dtype=np.float32), np.array(high, dtype=np.float32)
