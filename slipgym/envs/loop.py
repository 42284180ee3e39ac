"""Boxes, grippers, sensors and estimators of n environments, closed by a grip force."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

import numpy as np

import estimator as estimators
from slipgym.compiled import compiled
from slipgym.config import Config, Randomization, TaskConfig
from slipgym.envs.actions import COMMANDS
from slipgym.envs.choices import LATENCY, chosen_estimator
from slipgym.envs.draw import Draw, Randomizer
from slipgym.envs.episode import Friction, choose_force, draw_friction, make_box
from slipgym.envs.equipment import Equipment
from slipgym.envs.happenings import enter
from slipgym.envs.observation import FRICTION_COLUMNS, Sight, combine
from slipgym.envs.told import WIDTH, tell
from slipgym.tasks import Task
from slipgym.tasks.episode import EPISODE
from slipgym.tasks.options import EpisodeOptions
from slipgym.world.plant import Plant, build
from slipgym.world.scene import Box
from slipgym.world.snapshot import EngineState

WARM_UP_STEPS = 6  # control steps before time 0 in which grip and sensors come to rest


@dataclass(frozen=True)
class LoopState:
    """State of a `SlipLoop` between two samples, as plain data."""

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


class SlipLoop(ABC):
    """n environments that advance by slip-velocity samples; knows nothing of Gymnasium.

    Arrays have a leading batch axis, for the compiled functions that serve many worlds. What moves the
    bodies is left to the subclasses.

    Args:
        config: Configuration.
        task: The task.
        estimator: Name of an estimator, or a mapping with its `name` and parameters.
        randomization: What is drawn per episode; None: nothing.
        n: Environments.

    Attributes:
        plant: State of worlds, pads, fingers and sensors.
        episode: EPISODE (n,).
        commands: Grip force and wrist velocity, (n, 4), see `slipgym.envs.actions.COMMANDS`.
        terms: Reward terms of the last step, summed over its samples, (n, k).
        wrenches: Measured wrench per finger at the centre of pressure, (n, 2, 4) [N, N, N, N m].
        twists: Measured slip twist per finger there, (n, 2, 3) [m/s, m/s, rad/s].
        task_part: The task's part of the observation, (n, k).
        materials: Name of every episode's material.
        boxes: Its object.
        drawn: What the randomization drew for it, JSON-like; empty without one.
        truth: (mu_s, mu_c, r) now and full support, (n, 6); columns as `estimated`.
        per_finger: Estimates (mu_s, mu_c, r) per finger, (n, 2, 3).
        estimated: Estimates of both fingers merged, with their support, (n, 6).
        told: What infos tell, see `slipgym.envs.told`, (n, WIDTH).
        estimator_choice: Name and parameters of the estimators; `velocity_delay` only if it was given.
        step_time: Length of a sample [s].
    """

    def __init__(
        self,
        config: Config,
        task: Task,
        estimator: str | Mapping[str, Any],
        randomization: Randomization | None = None,
        n: int = 1,
    ) -> None:
        self.config, self.task, self.n = config, task, n
        self.plant = build(config, n)
        self._randomizer = Randomizer(config, task.key, randomization or Randomization())
        self._equipment = Equipment(config, self.plant, self._randomizer.pressures)
        self._equipment.check(self._randomizer.most)
        self.estimator_choice = chosen_estimator(estimator)
        self.estimator = estimators.make_batch(n=2 * n, **self.estimator_choice)
        asked = self.estimator.parameters_array.dtype.names or ()
        self._tells_latency = LATENCY in asked and LATENCY not in self.estimator_choice
        if self._tells_latency and n > 1 and self._randomizer.draws("slip_latency"):
            self.estimator.parameters_array = np.repeat(self.estimator.parameters_array, 2 * n)
        self.episode = np.zeros(n, EPISODE)
        self.commands, self.terms = np.zeros((n, len(COMMANDS))), np.zeros((n, len(task.terms)))
        self.wrenches, self.twists = np.zeros((n, 2, 4)), np.zeros((n, 2, 3))
        self.task_part = np.zeros((n, len(task.columns)))
        self.truth, self.estimated = np.ones((2, n, len(FRICTION_COLUMNS)))
        self.per_finger = np.zeros((n, 2, 3))
        self.told = np.zeros((n, WIDTH))
        bodies = self.plant.world, self.plant.pads, self.plant.fingers
        self._told_from = *bodies, self.episode, self.truth, self.estimated, self.per_finger
        self.materials: list[str] = [""] * n
        self.boxes: list[Any] = [None] * n
        self.drawn: list[dict[str, Any]] = [{} for _ in range(n)]
        self.step_time = 1.0 / config.physics.control_rate
        self._blank = _blank_episode(config, task, self.step_time)
        # start values are the same for all and do not depend on a latency
        self._fresh = self.estimator.states[:2].copy(), self.estimator.estimates[:2].copy()

    @property
    def true_friction(self) -> np.ndarray:
        """(mu_s, mu_c, r) now, (n, 3)."""
        return self.truth[:, :3]

    @property
    def time(self) -> float:
        """Time since the start of the first environment's episode [s]."""
        return self.episode["step"].item(0) * self.step_time

    def reset(self, options: EpisodeOptions, material: str, rng: np.random.Generator, i: int = 0) -> None:
        """Start an episode: draw it, grip, and let grip and sensors come to rest.

        Args:
            options: What is fixed.
            material: Name of a material, or "random".
            rng: Source of every draw.
            i: Which of the environments.

        Raises:
            ValueError: The options contradict each other or the configuration.
            RuntimeError: The world is closed.
        """
        self.check_open()
        task_config: TaskConfig = getattr(self.config.tasks, self.task.key)
        scale = 1.0 if options.randomization_scale is None else options.randomization_scale
        draw = self._randomizer.draw(rng, scale)
        friction = draw_friction(self.config, options, task_config, material, draw, rng)
        box = make_box(self.config, options, task_config, draw, rng)
        force = choose_force(self.config, options, task_config)
        copy_rows(self.episode, self._blank, i)
        self._start_episode(self.episode[i], box, friction, options, draw, rng)
        self._place(i, box, force, tuple(self.episode["wrist_start"][i].tolist()))
        self.materials[i], self.boxes[i] = friction.material, box
        start = {"mu_s": friction.mu_s, "mu_c": friction.mu_c, "mass": box.mass}
        self.drawn[i] = {**start, **draw.report(options)} if self._randomizer.active else {}
        for k, field in enumerate(("mu_s", "mu_c", "r")):
            self.truth[i, k] = self.plant.pads[field][i] = getattr(friction, field)
        if self._randomizer.active:  # it fits from the start otherwise
            self._equipment.fit(i, draw.values, draw.config.contact.pressure)
        self._equipment.start_sensors(i, draw.values["bias_scale"], rng)
        fingers = slice(2 * i, 2 * i + 2)
        if self._tells_latency:
            parameters = self.estimator.parameters_array
            own = parameters[fingers if len(parameters) > 1 else slice(1)]
            own[LATENCY] = draw.values["slip_latency"]
        self._settle(i, force)
        self.plant.chips["travel"][i] = 0.0
        for array, fresh in zip((self.estimator.states, self.estimator.estimates), self._fresh, strict=True):
            copy_rows(array, fresh, 2 * i)
        row = slice(i, i + 1)
        combine(self.estimator.estimates[fingers], self.per_finger[row], self.estimated[row])
        self.terms[i] = self.commands[i] = 0.0
        self.episode["command"][i] = self.episode["last_command"][i] = force
        self.task.judge(
            self.episode[row], self.plant.world[row], self.plant.fingers[row], self.task_part[row]
        )
        self._tell(row)

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
    def _place(self, i: int, box: Box, force: float, wrist: tuple[float, ...]) -> None:
        """Put a box between the pads of a world, held with a force [N], the wrist at rest."""

    @abstractmethod
    def _settle(self, i: int, force: float) -> None:
        """Hold it for `WARM_UP_STEPS`."""

    def get_state(self) -> LoopState:
        """Copy everything that the next sample depends on.

        Raises:
            RuntimeError: The world is closed, or there was no reset yet.
        """
        self.check_open()
        arrays = {name: array.copy() for name, array in self._arrays().items()}
        return LoopState(None, deepcopy(self.plant), arrays, list(self.materials), list(self.boxes))

    def set_state(self, state: LoopState) -> None:
        """Go on from a state.

        Raises:
            RuntimeError: The world is closed.
        """
        self.check_open()
        self.plant.restore(state.plant)
        for name, array in self._arrays().items():
            array[:] = state.arrays[name]
        self.materials[:], self.boxes[:] = state.materials, state.boxes
        self._tell(slice(None))

    def _tell(self, rows: slice) -> None:
        """Note what infos tell of some environments."""
        tell(self.told[rows], *(array[rows] for array in self._told_from))

    def _arrays(self) -> dict[str, np.ndarray]:
        """Arrays besides the plant's that last from sample to sample."""
        return {
            "estimator_parameters": self.estimator.parameters_array,
            "estimator_states": self.estimator.states,
            "estimates": self.estimator.estimates,
            "episode": self.episode,
            "commands": self.commands,
            "terms": self.terms,
            "wrenches": self.wrenches,
            "twists": self.twists,
            "task_part": self.task_part,
            "truth": self.truth,
            "per_finger": self.per_finger,
            "estimated": self.estimated,
        }

    def _start_episode(
        self,
        row: np.void,
        box: Box,
        friction: Friction,
        options: EpisodeOptions,
        draw: Draw,
        rng: np.random.Generator,
    ) -> None:
        pad = self.config.gripper.pad_radius
        row["reach"] = box.size[0] / 2 - pad, box.size[2] / 2 - pad
        row["object_centre"] = -box.grasp_offset[0], -box.grasp_offset[1]
        row["mass"], row["inertia"] = box.mass, box.inertia
        row["mu_s"], row["mu_c"] = friction.mu_s, friction.mu_c
        row["drift"] = draw.values["friction_drift"]
        self.task.start(self.config, options, rng, row)
        for disturbance, shares in draw.happenings:
            enter(disturbance, shares, row)


@compiled
def copy_rows(array, rows, first):
    """Copy rows (k,) into an array (n,) of the same records, from row `first` on; faster than numpy."""
    for k in range(rows.shape[0]):
        array[first + k] = rows[k]


def _blank_episode(config: Config, task: Task, step_time: float) -> np.ndarray:
    """What all episodes of a task begin with, EPISODE (1,)."""
    episode = np.zeros(1, EPISODE)
    episode["step_time"] = step_time
    for field in ("force_min", "force_max", "wrist_speed_max", "wrist_pitch_rate_max", "pad_radius"):
        episode[field] = getattr(config.gripper, field)
    reward = getattr(config.tasks, task.key).reward
    scales = [getattr(reward, term) for term in task.terms]
    episode["scales"][0, : len(scales)] = scales
    episode["mass_factor"] = episode["jump_factor"] = episode["patch_factor"] = 1.0
    return episode
