"""Boxes, grippers, sensors and estimators of n environments, closed by a grip force."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

import numpy as np

import estimator as estimators
from slipgym.config import Config, Randomization, TaskConfig
from slipgym.envs.actions import COMMANDS
from slipgym.envs.choices import LATENCY, chosen_estimator
from slipgym.envs.draw import Randomizer
from slipgym.envs.equipment import Equipment
from slipgym.envs.observation import FRICTION_COLUMNS, Sight
from slipgym.envs.starter import Row, Starter
from slipgym.envs.told import Told, tell
from slipgym.tasks import Task
from slipgym.tasks.episode import EPISODE
from slipgym.tasks.options import EpisodeOptions
from slipgym.world.plant import Plant, build
from slipgym.world.scene import Box
from slipgym.world.snapshot import EngineState


@dataclass(frozen=True)
class SimulationState:
    """State of a `Simulation` between two samples, as plain data."""

    engine: EngineState | None
    """Bodies in the engine, if there is one."""
    plant: Plant
    """Worlds, pads, fingers and sensors."""
    arrays: Mapping[str, np.ndarray]
    """Estimators, episodes and what they said last."""
    materials: list[str]
    """Name of every episode's material."""
    boxes: list[Box]
    """Its object."""


class Simulation(ABC):
    """n environments that advance by slip-velocity samples; knows nothing of Gymnasium.

    Arrays have a leading batch axis, for the compiled functions that serve many worlds. What moves the
    bodies is left to the subclasses.

    Args:
        config: Configuration.
        settings: The task's settings.
        task: The task.
        estimator: Name of an estimator, or a mapping with its `name` and parameters.
        randomization: What is drawn per episode; None: nothing.
        n: Environments.

    Attributes:
        plant: State of worlds, pads, fingers and sensors.
        episode: EPISODE (n,).
        commands: Grip force and wrist velocity, (n, 4), see `slipgym.envs.actions.COMMANDS`.
        wrenches: Measured wrench per finger at the centre of pressure, (n, 2, 4) [N, N, N, N m].
        twists: Measured slip twist per finger there, (n, 2, 3) [m/s, m/s, rad/s].
        task_part: The task's part of the observation, (n, k).
        materials: Name of every episode's material.
        boxes: Its object.
        drawn: What the randomization drew for it, JSON-like; empty without one.
        truth: (mu_s, mu_c, r) now and full support, (n, 6); columns as `estimated`.
        per_finger: Estimates (mu_s, mu_c, r) per finger, (n, 2, 3).
        estimated: Estimates of both fingers merged, with their support, (n, 6).
        told: What infos tell, the last step's reward terms among it.
        estimator_choice: Name and parameters of the estimators; `velocity_delay` only if it was given.
        step_time: Length of a sample [s].
    """

    def __init__(
        self,
        config: Config,
        settings: TaskConfig,
        task: Task,
        estimator: str | Mapping[str, Any],
        randomization: Randomization | None = None,
        n: int = 1,
    ) -> None:
        self.config, self.settings, self.task, self.n = config, settings, task, n
        self.plant = build(config, n)
        randomizer = Randomizer(config, settings, task.key, randomization or Randomization())
        equipment = Equipment(config, self.plant, randomizer.pressures)
        equipment.check(randomizer.most)
        self.estimator_choice = chosen_estimator(estimator)
        self.estimator = estimators.make_batch(n=2 * n, **self.estimator_choice)
        asked = self.estimator.parameters_array.dtype.names or ()
        tells_latency = LATENCY in asked and LATENCY not in self.estimator_choice
        if tells_latency and n > 1 and randomizer.draws("slip_latency"):
            self.estimator.parameters_array = np.repeat(self.estimator.parameters_array, 2 * n)
        self.episode = np.zeros(n, EPISODE)
        self.commands = np.zeros((n, len(COMMANDS)))
        self.wrenches, self.twists = np.zeros((n, 2, 4)), np.zeros((n, 2, 3))
        self.task_part = np.zeros((n, len(task.columns)))
        self.truth, self.estimated = np.ones((2, n, len(FRICTION_COLUMNS)))
        self.per_finger = np.zeros((n, 2, 3))
        self.told = Told.zeros(n, len(task.term_names))
        bodies = self.plant.world, self.plant.pads, self.plant.fingers
        self._told_from = *bodies, self.episode, self.truth, self.estimated, self.per_finger
        self.step_time = 1.0 / config.physics.control_rate
        told = self.estimator.parameters_array if tells_latency else None
        self._starter = Starter(config, settings, task, randomizer, equipment, self.episode, told)
        self.materials, self.boxes = self._starter.materials, self._starter.boxes
        self.drawn = self._starter.drawn
        plant, learned = self.plant, (self.estimator.states, self.estimator.estimates)
        self._biases = equipment.biases
        self._equipped = plant.pads, plant.force_torque, plant.slip_sensors, self.truth
        # start values are the same for all and do not depend on a latency
        self._fresh = self.estimator.states[:2].copy(), self.estimator.estimates[:2].copy()
        self._opened = plant.slip_sensors, *learned, self.episode, self.commands

    @property
    def true_friction(self) -> np.ndarray:
        """(mu_s, mu_c, r) now, (n, 3)."""
        return self.truth[:, :3]

    @property
    def time(self) -> float:
        """Time since the start of the first environment's episode [s]."""
        return self.episode["step"].item(0) * self.step_time

    def reset(self, options: EpisodeOptions, material: str, rng: np.random.Generator) -> None:
        """Start an episode of the first environment: draw it, grip, and let grip and sensors come to rest.

        Args:
            options: What is fixed.
            material: Name of a material, or "random".
            rng: Source of every draw.

        Raises:
            ValueError: The options contradict each other or the configuration.
            RuntimeError: The world is closed.
        """
        self.reset_rows([(0, options, rng)], material)

    def reset_rows(self, rows: Sequence[Row], material: str) -> None:
        """Start episodes of some environments, see `reset`.

        Args:
            rows: Which, each with its options and its generator.
            material: As in `reset`.

        Raises:
            ValueError: See there.
            RuntimeError: See there.
        """
        self.check_open()
        self._begin(self._starter.draw(rows, material))

    @abstractmethod
    def step(
        self, actions: np.ndarray, components: np.ndarray, skip: int, active: np.ndarray, sight: Sight
    ) -> None:
        """Some samples with the same action, and what is observed then; an episode that ends does not go on.

        Args:
            actions: (n, m).
            components: COMPONENT (m,), what they mean.
            skip: Samples.
            active: Which environments take part, (n,).
            sight: Where to write what they observe.

        Raises:
            FloatingPointError: Something is no longer a finite number; only a reset helps.
            RuntimeError: The world is closed.
        """

    @abstractmethod
    def close(self) -> None:
        """Release what the worlds hold; closing twice is harmless."""

    @property
    @abstractmethod
    def closed(self) -> bool:
        """Whether it was closed."""

    def check_open(self) -> None:
        """Raise RuntimeError if it was closed."""
        if self.closed:
            raise RuntimeError("this environment is closed; make a new one")

    @abstractmethod
    def _begin(self, starts: np.ndarray) -> None:
        """Begin the episodes of START (m,): grip, settle for `WARM_UP_STEPS`, forget what was learned."""

    def get_state(self) -> SimulationState:
        """Copy everything that the next sample depends on.

        Raises:
            RuntimeError: The world is closed, or there was no reset yet.
        """
        self.check_open()
        arrays = {name: array.copy() for name, array in self._arrays().items()}
        return SimulationState(None, deepcopy(self.plant), arrays, list(self.materials), list(self.boxes))

    def set_state(self, state: SimulationState) -> None:
        """Go on from a state.

        Raises:
            RuntimeError: The world is closed.
        """
        self.check_open()
        self.plant.restore(state.plant)
        for name, array in self._arrays().items():
            array[:] = state.arrays[name]
        self.materials[:], self.boxes[:] = state.materials, state.boxes
        self._tell()

    def hand_over(self) -> Told:
        """What is told, the receiver's own from now on; the next step fills in new arrays."""
        told, self.told = self.told, self.told.empty_like()
        return told

    def _tell(self) -> None:
        """Fill in what is told but for the reward terms."""
        tell(self.told.numbers, self.told.flags, *self._told_from)

    def _arrays(self) -> dict[str, np.ndarray]:
        """Arrays besides the plant's that last from sample to sample."""
        return {
            "estimator_parameters": self.estimator.parameters_array,
            "estimator_states": self.estimator.states,
            "estimates": self.estimator.estimates,
            "episode": self.episode,
            "commands": self.commands,
            "wrenches": self.wrenches,
            "twists": self.twists,
            "task_part": self.task_part,
            "truth": self.truth,
            "per_finger": self.per_finger,
            "estimated": self.estimated,
        }
