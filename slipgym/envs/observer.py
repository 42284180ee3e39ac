"""Assembles observations: their layout, history and groups, the privileged one with the truth among them."""

from __future__ import annotations

from typing import TypeAlias

import gymnasium as gym
import numpy as np

from slipgym._numba.compiled import compiled
from slipgym._numba.fixed import Fixed
from slipgym.config import Config
from slipgym.envs.observation import (
    DEVIATIONS,
    FRICTION,
    FRICTION_COLUMNS,
    LOAD,
    ObservationBuffers,
    columns,
    wrist_part,
)
from slipgym.envs.readings import Reading, row_writer
from slipgym.envs.simulation import Simulation
from slipgym.envs.stages import STATE
from slipgym.tasks.task import Column


def _force(config: Config) -> tuple[float, float]:
    return 0.0, config.gripper.force_limit


def _friction(config: Config) -> tuple[float, float]:
    """Bound of one pad's friction, at the largest friction coefficient [N]."""
    limit = FRICTION_COLUMNS[0].high * config.gripper.force_limit
    return -limit, limit


def _torque(config: Config) -> tuple[float, float]:
    limit = _friction(config)[1] * config.gripper.pad_radius
    return -limit, limit


def _true(k: int) -> Reading:
    """Row k of the friction part, from the ground truth in place of the estimates."""
    return FRICTION[k]._replace(read=f"friction[i, {k}]")


def _pad(f: int) -> tuple[Reading, ...]:
    wrench = f"pads[i, {f - 1}].wrench"
    return (
        Reading(
            f"friction_x_{f}", _friction, "N", f"friction of pad {f} on the object, pad frame", f"{wrench}[0]"
        ),
        Reading(f"friction_y_{f}", _friction, "N", "the same along the pad's y axis", f"{wrench}[1]"),
        Reading(f"friction_tau_{f}", _torque, "N m", f"friction torque at pad {f}'s CoP", f"{wrench}[2]"),
    )


PRIVILEGED = (
    *(_true(k) for k in range(3)),
    Reading("slip_x", (-1.0, 1.0), "m", "slip displacement since the grasp, pad frame", "worlds[i].slip[0]"),
    Reading("slip_y", (-1.0, 1.0), "m", "the same along the pad's y axis", "worlds[i].slip[1]"),
    Reading("slip_theta", (-10.0, 10.0), "rad", "the same about the grip axis", "worlds[i].slip[2]"),
    Reading(
        "slip_velocity_x", (-10.0, 10.0), "m/s", "slip velocity at the pad centre", "worlds[i].slip_twist[0]"
    ),
    Reading(
        "slip_velocity_y", (-10.0, 10.0), "m/s", "the same along the pad's y axis", "worlds[i].slip_twist[1]"
    ),
    Reading("slip_rate", (-100.0, 100.0), "rad/s", "the same about the grip axis", "worlds[i].slip_twist[2]"),
    *_pad(1),
    *_pad(2),
    Reading("object_x", (-10.0, 10.0), "m", "the object's centre of mass along world x", "worlds[i].com[0]"),
    Reading("object_z", (-10.0, 10.0), "m", "the same along world z, up", "worlds[i].com[1]"),
    Reading(
        "object_angle", (-10.0, 10.0), "rad", "the object's angle about the grip axis", "worlds[i].angle"
    ),
    Reading("object_mass", (0.0, 100.0), "kg", "the object's mass", "worlds[i].mass"),
    Reading("grip_force_1", _force, "N", "actuator force of finger 1", "fingers[i, 0].force"),
    Reading("grip_force_2", _force, "N", "actuator force of finger 2", "fingers[i, 1].force"),
)
"""The group's columns, in order."""

_write_privileged_row = row_writer(
    "_write_privileged_row",
    [reading.read for reading in PRIVILEGED],
    ("worlds", "pads", "fingers", "friction"),
    __file__,
    "Write `PRIVILEGED` of environment i.",
)


def privileged_columns(config: Config) -> tuple[Column, ...]:
    """Columns of the privileged group, in order."""
    return tuple(reading.column(config) for reading in PRIVILEGED)


@compiled
def write_privileged(worlds, pads, fingers, friction, low, high, out):
    """Write the privileged group, clipped to its bounds.

    Args:
        worlds: WORLD (n,).
        pads: PAD (n, 2).
        fingers: FINGER (n, 2).
        friction: The ground truth (n, 11), of which the first three (mu_s, mu_c, r) are used.
        low: Lower bounds (m,).
        high: Upper bounds (m,).
        out: Output (n, m), float32.
    """
    for i in range(out.shape[0]):
        _write_privileged_row(out[i], i, worlds, pads, fingers, friction)
        for k in range(out.shape[1]):
            out[i, k] = min(max(out[i, k], low[k]), high[k])


Observation: TypeAlias = np.ndarray | dict[str, np.ndarray]
"""An array, or one per group."""


class Observer:
    """Assembles the observations of a simulation.

    Args:
        simulation: The simulation.
        friction_source: Source of the friction part: "estimated", "true", "nominal" or "none".
        action_mode: One of `ACTION_MODES`; it decides which wrist columns are observed.
        mode: "flat", "deviations", "sensor" or "dict".
        history: Number of earlier observations in each observation.
        load_columns: Whether an observation has the load part.

    Attributes:
        columns: Columns of one observation, or of its group "policy".
        privileged: Columns of the group "privileged"; empty unless the mode is "dict".
        space: The observation space of one environment.
        buffers: Buffers that the simulation writes the observations to.
        history: As given.
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
        self._settings = wrist, friction, low, high, np.arange(len(LOAD) if load_columns else 0)
        self._write_to(np.zeros((simulation.n, len(self.columns)), dtype=np.float32))
        if history:  # the newest observation comes last
            self._frames = np.zeros((simulation.n, history + 1, len(self.columns)), dtype=np.float32)
        policy = gym.spaces.Box(np.tile(low, history + 1), np.tile(high, history + 1))
        self.privileged: tuple[Column, ...] = ()
        self.space: gym.Space = policy
        if mode == "dict":
            self.privileged = privileged_columns(simulation.config)
            self._privileged_bounds = _bounds(self.privileged)
            self._ground_truth = np.zeros((simulation.n, len(self.privileged)), dtype=np.float32)
            ground_truth = gym.spaces.Box(*self._privileged_bounds)
            self.space = gym.spaces.Dict({"policy": policy, "privileged": ground_truth})

    def begin(self, rows: np.ndarray) -> None:
        """Observe some environments after a reset; the first observation fills their whole history."""
        self._look(rows)
        if self.history:
            self._frames[rows] = self.buffers.out[rows, np.newaxis]

    def next(self, active: np.ndarray) -> None:
        """Append the observations of a step, which the simulation has written to `buffers`, to the history.

        Args:
            active: Environments that made a step, (n,) bool.
        """
        if self.history:
            self._frames[active, :-1] = self._frames[active, 1:]
            self._frames[active, -1] = self.buffers.out[active]

    def again(self) -> None:
        """Write the present observations of all environments to `buffers` again, after `read` replaced it."""
        self._look(np.arange(self._simulation.n))

    def present(self) -> Observation:
        """Views of the observations of all environments, (n, k) each; the next step or reset changes them."""
        policy = self._frames.reshape(self._simulation.n, -1) if self.history else self.buffers.out
        if not self.privileged:
            return policy
        plant, (low, high) = self._simulation.plant, self._privileged_bounds
        bodies = plant.world, plant.pads, plant.fingers
        write_privileged(*bodies, self._simulation.ground_truth, low, high, self._ground_truth)
        return {"policy": policy, "privileged": self._ground_truth}

    def read(self) -> Observation:
        """Observations of all environments, owned by the caller; the next ones are written to new arrays."""
        observations = self.present()
        if self.history:
            self._frames = self._frames.copy()
        else:
            self._write_to(np.empty_like(self.buffers.out))
        if self.privileged:
            self._ground_truth = np.empty_like(self._ground_truth)
        return observations

    def first(self) -> Observation:
        """The observation of the first environment, owned by the caller."""
        if not self.history and not self.privileged:
            return self._first.copy()
        observations = self.present()
        if isinstance(observations, dict):
            return {group: values[0].copy() for group, values in observations.items()}
        return observations[0].copy()

    def get_state(self) -> np.ndarray:
        """The last observations (n, history + 1, m), the newest one last."""
        if self.history:
            return self._frames.copy()
        self.again()
        return self.buffers.out[:, np.newaxis].copy()

    def set_state(self, frames: np.ndarray, rows: np.ndarray) -> None:
        """Restore the history of some rows (n,) bool; without one, the simulation's state suffices."""
        if self.history:
            self._frames[rows] = frames[rows]

    def _write_to(self, out: np.ndarray) -> None:
        """Have observations written to an array, (n, k)."""
        self.buffers, self._first = ObservationBuffers(*self._settings, out), out[0]

    def _look(self, rows: np.ndarray) -> None:
        self._simulation.stages.look_at(rows, self._state, self.buffers)


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
