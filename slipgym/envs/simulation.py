"""Base class of the simulations of n environments: boxes, grippers, sensors and estimators."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from copy import deepcopy
from typing import Any

import numpy as np

from estimator.batch import BatchEstimator
from slipgym.config import Config, Randomization, TaskConfig
from slipgym.envs.actions import COMMANDS
from slipgym.envs.control_step import BatchState
from slipgym.envs.estimates import UNCHANGED, chosen_estimator, compiled_update, make_estimators
from slipgym.envs.infos import InfoBuffer
from slipgym.envs.observation import DEVIATION_COLUMNS, FRICTION_COLUMNS, ObservationBuffers
from slipgym.envs.randomizer import Randomizer
from slipgym.envs.reset import EpisodeSampler, prepare_hardware
from slipgym.envs.stages import compiled_stages
from slipgym.envs.states import SimulationState, check_layout
from slipgym.tasks import Task
from slipgym.tasks.episode import EPISODE
from slipgym.tasks.options import EpisodeOptions
from slipgym.world.plant import build


class Simulation(ABC):
    """Simulation of n environments that advances by control steps, independent of Gymnasium.

    Arrays have a leading batch axis. A subclass for each engine moves the bodies. With an estimator of None
    nothing estimates, with a randomization of None nothing is randomized.

    Attributes:
        plant: State of worlds, pads, fingers and sensors.
        state: `BatchState`: views of the plant's arrays, of the bytes of the estimators, and the arrays
            `commands`, `wrenches`, `twists`, `task_part`, `per_finger`, `estimated` and `ground_truth`
            (with full confidence), which are attributes, too.
        episode: EPISODE (n,).
        materials: Name of every episode's material.
        boxes: Every episode's object; None before the first reset.
        drawn: Values that the randomization sampled for every episode.
        blank: The values that all episodes begin with, EPISODE (1,).
        infos: Infos of all environments, including the last step's reward terms.
        estimator_choice: Name and parameters of the estimators, None for none; `velocity_delay` only if the
            user gave it.
        step_time: Length of a control step [s].
    """

    def __init__(
        self,
        config: Config,
        settings: TaskConfig,
        task: Task,
        estimator: str | Mapping[str, Any] | None,
        randomization: Randomization | None = None,
        n: int = 1,
    ) -> None:
        self.config, self.settings, self.task, self.n = config, settings, task, n
        self.plant = build(config, n)
        randomizer = Randomizer(config, settings, task.key, randomization or Randomization())
        hardware = prepare_hardware(config, self.plant, randomizer)
        self.estimator_choice = chosen_estimator(estimator)
        self._estimators = make_estimators(self.estimator_choice, config, 2 * n)
        self.episode = np.zeros(n, EPISODE)
        self.commands = np.zeros((n, len(COMMANDS)))
        self.wrenches, self.twists = np.zeros((n, 2, 4)), np.zeros((n, 2, 3))
        self.task_part = np.zeros((n, len(task.columns)))
        self.ground_truth, self.estimated = np.ones((2, n, len(FRICTION_COLUMNS) + len(DEVIATION_COLUMNS)))
        self.ground_truth[:, len(FRICTION_COLUMNS) :] = 0.0
        self.per_finger = np.zeros((n, 2, 3))
        self.infos = InfoBuffer.zeros(n, len(task.term_names))
        self.step_time = 1.0 / config.physics.control_rate
        self._sampler = EpisodeSampler(config, settings, task, randomizer, self.episode)
        self.materials, self.boxes = self._sampler.materials, self._sampler.boxes
        self.drawn, self.blank = self._sampler.drawn, self._sampler.blank
        plant, learned = self.plant, self._estimators
        self.state = BatchState(
            worlds=plant.world,
            parameters=_bytes(learned.parameters_array),
            estimator_states=_bytes(learned.states),
            estimates=learned.estimates,
            episodes=self.episode,
            **{name: getattr(plant, name) for name in _PLANTS},
            **{name: getattr(self, name) for name in _OWN},
        )
        self._hardware = hardware
        states = self.state.estimator_states[:2].copy()
        self._fresh = states, learned.estimates[:2].copy(), self.estimating
        self._choose_programs()
        self._dropped, self._ended, self._steps, self._length = (
            self.episode[name] for name in ("dropped", "ended", "step", "steps")
        )

    def _choose_programs(self) -> None:
        """Find the compiled programs for the kinds of arrays that the plant has."""
        plant = self.plant
        cells = 0 if plant.cells is None else plant.cells.ndim
        update = compiled_update(self._estimators) if self.estimating else UNCHANGED
        self._kinds = self.task, update, plant.force_torque.dtype, cells
        self.stages = compiled_stages(*self._kinds)

    @property
    def estimating(self) -> bool:
        """Whether there are estimators."""
        return self.estimator_choice is not None

    @property
    def estimator(self) -> BatchEstimator:
        """Estimators of both fingers of each environment, (2n,).

        Raises:
            AttributeError: There are none.
        """
        if not self.estimating:
            raise AttributeError("there are no estimates: this environment has estimator=None")
        return self._estimators

    @property
    def true_friction(self) -> np.ndarray:
        """(mu_s, mu_c, r) now, (n, 3)."""
        return self.ground_truth[:, :3]

    @property
    def over(self) -> bool:
        """Whether the first environment's episode has ended."""
        return self._dropped.item(0) or self._ended.item(0) or self.timed_out

    @property
    def timed_out(self) -> bool:
        """Whether the first environment's episode has its full length."""
        return self._steps.item(0) >= self._length.item(0)

    @property
    def time(self) -> float:
        """Time since the start of the first environment's episode [s]."""
        return self._steps.item(0) * self.step_time

    def reset(self, options: EpisodeOptions, material: str, rng: np.random.Generator) -> None:
        """Start an episode of the first environment, see `reset_rows`."""
        self.reset_rows(_FIRST, [rng], options, material)

    def reset_rows(
        self,
        rows: np.ndarray,
        generators: Sequence[np.random.Generator],
        options: EpisodeOptions,
        material: str,
    ) -> None:
        """Start episodes of some environments: sample them, close the grip, let grip and sensors settle.

        Args and errors are those of `slipgym.envs.reset.EpisodeSampler.sample`.

        Raises:
            RuntimeError: The world is closed.
        """
        self.check_open()
        self._begin(*self._sampler.sample(rows, generators, options, material))

    @abstractmethod
    def step(
        self,
        actions: np.ndarray,
        components: np.ndarray,
        skip: int,
        active: np.ndarray,
        buffers: ObservationBuffers,
    ) -> None:
        """Make `skip` control steps with the same action, then observe; episodes that end are not stepped on.

        Args:
            actions: (n, m).
            components: COMPONENT (m,), the meaning of the actions.
            skip: Number of control steps.
            active: Environments that take part, (n,) bool.
            buffers: Buffers that their observations are written to.

        Raises:
            FloatingPointError: A quantity is not finite; the environment needs a reset.
            RuntimeError: The world is closed.
        """

    @abstractmethod
    def close(self) -> None:
        """Release the simulation's resources; closing twice is harmless."""

    @property
    @abstractmethod
    def closed(self) -> bool:
        """Whether it was closed."""

    def check_open(self) -> None:
        """Raise RuntimeError if it was closed."""
        if self.closed:
            raise RuntimeError("this environment is closed; make a new one")

    @abstractmethod
    def _begin(self, starts: np.ndarray, values: np.ndarray) -> None:
        """Begin the episodes of START (m,) and VALUES (m,).

        Set up hardware, grip, settle for `WARM_UP_STEPS`, reset the estimators.
        """

    def get_state(self) -> SimulationState:
        """Copy everything that the next control step depends on.

        Raises:
            RuntimeError: The world is closed, or there was no reset yet.
        """
        self.check_open()
        arrays = {name: array.copy() for name, array in self._arrays().items()}
        return SimulationState(None, deepcopy(self.plant), arrays, list(self.materials), list(self.boxes))

    def check_state(self, state: SimulationState, ready: np.ndarray) -> None:
        """Check a whole state before anything of it is restored, see `check_layout`."""
        own = SimulationState(None, self.plant, self._arrays(), self.materials, self.boxes)
        check_layout(state, own, ready)

    def set_state(self, state: SimulationState, ready: np.ndarray) -> None:
        """Restore a state that `check_state` has accepted, in the environments that are `ready` in it.

        Raises:
            RuntimeError: The world is closed.
        """
        self.check_open()
        self.plant.restore(state.plant, ready)
        for name, array in self._arrays().items():
            if name != "estimator_parameters":
                rows = np.repeat(ready, len(array) // self.n)
                array[rows] = state.arrays[name][rows]
        for i in np.flatnonzero(ready).tolist():
            self.materials[i], self.boxes[i] = state.materials[i], state.boxes[i]
        self.stages.report(
            self.state, self.infos.numbers, self.infos.flags, 0, self.n
        )  # but the reward terms

    def hand_over_infos(self) -> InfoBuffer:
        """Return the infos, which the caller then owns; the next step fills new arrays."""
        infos, self.infos = self.infos, self.infos.empty_like()
        return infos

    def _arrays(self) -> dict[str, np.ndarray]:
        """Arrays besides the plant's that persist from one control step to the next."""
        return {
            "estimator_parameters": self._estimators.parameters_array,
            "estimator_states": self._estimators.states,
            "episode": self.episode,
            **{name: getattr(self.state, name) for name in _KEPT},
        }


_FIRST = np.zeros(1, dtype=np.int64)
_PLANTS = "pads", "fingers", "slip_sensors", "grippers", "markers"
"""Arrays of `BatchState` that are those of the plant."""
_OWN = "commands", "wrenches", "twists", "task_part", "ground_truth", "per_finger", "estimated"
"""Arrays of `BatchState` that are attributes of a `Simulation`."""
_KEPT = ("estimates", *_OWN)
"""Arrays of `BatchState` that states of environments hold by these names."""


def _bytes(records: np.ndarray) -> np.ndarray:
    """Records (n,) as bytes, (n, size): a view."""
    return records.view(np.uint8).reshape(len(records), -1)
