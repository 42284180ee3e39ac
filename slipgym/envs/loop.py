"""Box, gripper, sensors and estimator of one environment, closed by a grip force."""

from __future__ import annotations

from collections.abc import Mapping
from copy import deepcopy
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

import estimator as estimators
from estimator.registry import specification
from slipgym.config import Config, Randomization, TaskConfig
from slipgym.envs.draw import Draw, Randomizer
from slipgym.envs.episode import Friction, choose_force, draw_friction, make_box
from slipgym.envs.equipment import Equipment
from slipgym.envs.guard import Guard
from slipgym.envs.happenings import enter
from slipgym.envs.observation import FRICTION_COLUMNS, combine
from slipgym.sensors.measure import measure
from slipgym.sensors.slip_velocity import AXES
from slipgym.tasks import Task
from slipgym.tasks.disturbance import disturb
from slipgym.tasks.episode import EPISODE
from slipgym.tasks.options import EpisodeOptions
from slipgym.world.bullet import BulletWorld
from slipgym.world.plant import Plant, build
from slipgym.world.scene import Box
from slipgym.world.snapshot import EngineState

_LATENCY = "velocity_delay"
WARM_UP_STEPS = 6  # control steps before time 0 in which grip and sensors come to rest


@dataclass(frozen=True)
class LoopState:
    """State of a `SlipLoop` between two samples, as plain data."""

    engine: EngineState
    """Bodies in the engine."""
    plant: Plant
    """World, pads, fingers and sensors."""
    arrays: Mapping[str, np.ndarray]
    """Estimators, episode and what they said last."""
    material: str
    """Name of the episode's material."""


class SlipLoop:
    """Advances by one slip-velocity sample at a time; knows nothing of Gymnasium.

    Arrays have a leading batch axis of one, for the compiled functions that serve many worlds.

    Args:
        config: Configuration.
        task: The task.
        estimator: Name of an estimator, or a mapping with its `name` and parameters.
        randomization: What is drawn per episode; None: nothing.

    Attributes:
        plant: State of world, pads, fingers and sensors.
        world: PyBullet around it.
        episode: EPISODE (1,).
        wrenches: Measured wrench per finger at the centre of pressure, (1, 2, 4) [N, N, N, N m].
        twists: Measured slip twist per finger there, (1, 2, 3) [m/s, m/s, rad/s].
        task_part: The task's part of the observation, (1, k).
        material: Name of the episode's material.
        true_friction: (mu_s, mu_c, r) now, (3,).
        per_finger: Estimates (mu_s, mu_c, r) per finger, (1, 2, 3).
        estimated: Estimates of both fingers merged, with their support, (1, 6).
        estimator_choice: Name and parameters of the estimators; `velocity_delay` only if it was given.
        drawn: What the randomization drew for the episode, JSON-like; empty without one.
    """

    def __init__(
        self,
        config: Config,
        task: Task,
        estimator: str | Mapping[str, Any],
        randomization: Randomization | None = None,
    ) -> None:
        self.config, self.task = config, task
        self.plant = build(config)
        self._randomizer = Randomizer(config, task.key, randomization or Randomization())
        self._equipment = Equipment(config, self.plant, self._randomizer.pressures)
        self._equipment.check(self._randomizer.most)
        self.estimator_choice = _choose_estimator(estimator)
        self.estimator = estimators.make_batch(n=2, **self.estimator_choice)
        asked = self.estimator.parameters_array.dtype.names or ()
        self._tells_latency = _LATENCY in asked and _LATENCY not in self.estimator_choice
        self.episode = np.zeros(1, EPISODE)
        self.wrenches, self.twists = np.zeros((1, 2, 4)), np.zeros((1, 2, 3))
        self.task_part = np.zeros((1, len(task.columns)))
        self.true_friction, self.per_finger = np.zeros(3), np.zeros((1, 2, 3))
        self.estimated = np.zeros((1, len(FRICTION_COLUMNS)))
        self.material, self.drawn = "", {}
        self._true_rows = self.true_friction.reshape(1, 3)
        self._step_time = 1.0 / config.physics.control_rate
        self._wrench_rows, self._twist_rows = self.wrenches.reshape(2, 4), self.twists.reshape(2, 3)
        samples = -(-config.sensors.force_torque.rate // config.physics.control_rate) + 1
        sizes = 2 * samples * 6, 2 * AXES, 2 * 6
        self._noise = np.zeros(sum(sizes))
        force, slip, drift = np.split(self._noise, np.cumsum(sizes)[:-1])  # views
        self._force_noise = force.reshape(1, 2, samples, 6)
        self._slip_noise, self._drift_noise = slip.reshape(1, 2, AXES), drift.reshape(1, 2, 6)
        self.world = BulletWorld(config, self.plant)
        self._guard = Guard()

    @property
    def time(self) -> float:
        """Time since the episode's start [s]."""
        return self.episode["step"].item() * self._step_time

    def reset(self, options: EpisodeOptions, material: str, rng: np.random.Generator) -> None:
        """Start an episode: draw it, grip, and let grip and sensors come to rest.

        Args:
            options: What is fixed.
            material: Name of a material, or "random".
            rng: Source of every draw.

        Raises:
            ValueError: The options contradict each other or the configuration.
            RuntimeError: The world is closed.
        """
        _ = self.world.client
        task_config: TaskConfig = getattr(self.config.tasks, self.task.key)
        scale = 1.0 if options.randomization_scale is None else options.randomization_scale
        draw = self._randomizer.draw(rng, scale)
        friction = draw_friction(self.config, options, task_config, material, draw, rng)
        box = make_box(self.config, options, task_config, draw, rng)
        force = choose_force(self.config, options, task_config)
        self._start_episode(box, friction, options, task_config, draw, rng)
        self.world.reset(box, force, tuple(self.episode["wrist_start"][0].tolist()))
        self._guard.reset()
        self.material = friction.material
        start = {"mu_s": friction.mu_s, "mu_c": friction.mu_c, "mass": box.mass}
        self.drawn = {**start, **draw.report(options)} if self._randomizer.active else {}
        self.true_friction[:] = friction.mu_s, friction.mu_c, friction.r
        for field, value in zip(("mu_s", "mu_c", "r"), self.true_friction, strict=True):
            self.plant.pads[field] = value
        self._equipment.fit(draw.values, draw.config.contact.pressure)
        self._equipment.start_sensors(draw.values["bias_scale"], rng)
        if self._tells_latency:
            self.estimator.parameters_array[_LATENCY] = draw.values["slip_latency"]
        for _ in range(WARM_UP_STEPS):
            self._advance(force, rng)
        self.plant.chips["travel"] = 0.0
        self.estimator.reset()
        combine(self.estimator.estimates, self.per_finger, self.estimated)
        self.episode["command"] = self.episode["last_command"] = force
        self.task.judge(self.episode, self.plant.world, self.plant.fingers, self.task_part)

    def sample(self, force: float, rng: np.random.Generator, wrist: np.ndarray | None = None) -> None:
        """One slip-velocity sample: act, move, measure, estimate, judge.

        Args:
            force: Grip force per finger [N].
            rng: Source of the sensors' noise.
            wrist: Velocity (x, z, pitch) on top of what the task scripts, (3,) [m/s, m/s, rad/s]; None: the
                last one.

        Raises:
            FloatingPointError: Something is no longer a finite number; only a reset helps.
        """
        plant, episode = self.plant, self.episode
        episode["last_command"] = episode["command"]
        episode["command"] = force
        if wrist is not None:
            episode["wrist_command"] = wrist
        disturb(episode, plant.world, plant.pads, self._true_rows)
        self.world.weigh()
        self.task.plan(episode, plant.world)
        self._advance(force, rng)
        episode["step"] += 1
        self.estimator.update(self.time, self._wrench_rows, self._twist_rows)
        combine(self.estimator.estimates, self.per_finger, self.estimated)
        self.task.judge(episode, plant.world, plant.fingers, self.task_part)
        arrays = plant.world, plant.pads, plant.fingers, self.wrenches, self.twists, self.per_finger, episode
        try:
            self._guard.watch(self.time, *arrays)
        except FloatingPointError:
            self.world.discard()
            raise

    def get_state(self) -> LoopState:
        """Copy everything that the next sample depends on.

        Raises:
            RuntimeError: The world is closed, or there was no reset yet.
        """
        arrays = {name: array.copy() for name, array in self._arrays().items()}
        return LoopState(self.world.get_state(), deepcopy(self.plant), arrays, self.material)

    def set_state(self, state: LoopState) -> None:
        """Go on from a state.

        Raises:
            RuntimeError: The world is closed.
        """
        self.world.set_state(state.engine)
        self.plant.restore(state.plant)
        for name, array in self._arrays().items():
            array[:] = state.arrays[name]
        self.material = state.material

    def _arrays(self) -> dict[str, np.ndarray]:
        """Arrays besides the plant's that last from sample to sample."""
        return {
            "estimator_parameters": self.estimator.parameters_array,
            "estimator_states": self.estimator.states,
            "estimates": self.estimator.estimates,
            "episode": self.episode,
            "wrenches": self.wrenches,
            "twists": self.twists,
            "task_part": self.task_part,
            "true_friction": self.true_friction,
            "per_finger": self.per_finger,
            "estimated": self.estimated,
        }

    def _advance(self, force: float, rng: np.random.Generator) -> None:
        """One control step of the world and its sensors."""
        plant = self.plant
        rng.standard_normal(out=self._noise)
        self.world.command(force)
        self.world.step(self._force_noise)
        measure(
            plant.world,
            plant.force_torque,
            plant.chips,
            self._slip_noise,
            self._drift_noise,
            self.wrenches,
            self.twists,
        )

    def _start_episode(
        self,
        box: Box,
        friction: Friction,
        options: EpisodeOptions,
        task_config: TaskConfig,
        draw: Draw,
        rng: np.random.Generator,
    ) -> None:
        episode = self.episode
        episode[:] = 0
        episode["step_time"] = self._step_time
        for field in ("force_min", "force_max", "wrist_speed_max", "wrist_pitch_rate_max"):
            episode[field] = getattr(self.config.gripper, field)
        pad = self.config.gripper.pad_radius
        episode["pad_radius"] = pad
        episode["reach"] = box.size[0] / 2 - pad, box.size[2] / 2 - pad
        episode["object_centre"] = -box.grasp_offset[0], -box.grasp_offset[1]
        scales = [getattr(task_config.reward, term) for term in self.task.terms]
        episode["scales"][0, : len(scales)] = scales
        episode["mass"], episode["inertia"] = box.mass, box.inertia
        episode["mu_s"], episode["mu_c"] = friction.mu_s, friction.mu_c
        episode["mass_factor"] = episode["jump_factor"] = episode["patch_factor"] = 1.0
        episode["drift"] = draw.values["friction_drift"]
        self.task.start(self.config, options, rng, episode[0])
        for disturbance, shares in draw.happenings:
            enter(disturbance, shares, episode[0])


def _choose_estimator(choice: str | Mapping[str, Any]) -> dict[str, Any]:
    """Name and all parameters; one that asks how old a velocity is, is told unless it was given that."""
    if isinstance(choice, str):
        choice = {"name": choice}
    if not isinstance(choice, Mapping) or not isinstance(choice.get("name"), str):
        raise ValueError(
            f"estimator = {choice!r} must be a name or a mapping with a name; "
            f"valid: {', '.join(estimators.names())}"
        )
    given = dict(choice)
    name = given.pop("name")
    parameters = asdict(specification(name).parameters.create(**given))
    if _LATENCY not in given:
        parameters.pop(_LATENCY, None)
    return {"name": name, **parameters}
