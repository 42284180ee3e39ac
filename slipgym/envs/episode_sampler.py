"""Samples the initial conditions of episodes: friction, object, task, disturbances and sensors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from slipgym.config import Config
from slipgym.config.errors import NEEDS_TILT, unknown
from slipgym.config.hardware import box_inertia
from slipgym.config.task import TaskConfig
from slipgym.envs.finger_differences import chosen_differences
from slipgym.envs.hardware_randomization import HardwareRandomization
from slipgym.envs.randomizer import Draw, Randomizer, schedule_disturbance
from slipgym.envs.reset_kernels import NUMBERS, START, begin_episode
from slipgym.sensors.starting import draw_sensors
from slipgym.tasks import Task
from slipgym.tasks.episode import EPISODE
from slipgym.tasks.options import EpisodeOptions
from slipgym.world.scene import Box

Row: TypeAlias = tuple[int, EpisodeOptions, np.random.Generator]
"""An environment to reset, its options, and its random generator."""

LATENCY = "velocity_delay"
"""Parameter of an estimator: the latency of the slip velocity."""


@dataclass(frozen=True)
class Friction:
    """True friction of an episode, to which each finger's own factors apply."""

    mu_s: float
    """Static friction [-]."""
    mu_c: float
    """Coulomb friction [-]."""
    r: float
    """Radius of the equivalent rim contact [m]."""
    material: str
    """Name of the material it came from."""


class EpisodeSampler:
    """Samples the episodes of n environments.

    Args:
        config: Configuration.
        settings: The task's settings.
        task: The task.
        randomizer: Samples the randomized parameters.
        hardware: Applies the sampled parameters of gripper and sensors.
        episode: EPISODE (n,); rows are filled in.
        parameters: Of estimators whose `velocity_delay` follows the slip sensor's latency, (2 n,), or (1,)
            for all; None if it stays as it is.

    Attributes:
        materials: Name of every episode's material.
        boxes: Every episode's object.
        drawn: Values that the randomization sampled for every episode, JSON-like; may be empty.
    """

    def __init__(
        self,
        config: Config,
        settings: TaskConfig,
        task: Task,
        randomizer: Randomizer,
        hardware: HardwareRandomization,
        episode: np.ndarray,
        parameters: np.ndarray | None,
    ) -> None:
        n = len(episode)
        self._config, self._task, self._randomizer = config, task, randomizer
        self._hardware, self._episode, self._parameters = hardware, episode, parameters
        self._settings = settings
        self._blank = _blank_episode(config, settings, task)
        self.materials: list[str] = [""] * n
        self.boxes: list[Any] = [None] * n
        self.drawn: list[dict[str, Any]] = [{} for _ in range(n)]

    def sample(self, rows: Sequence[Row], material: str) -> np.ndarray:
        """Sample episodes, one generator after the other; returns START (m,).

        Args:
            rows: Of m environments.
            material: Name of a material, or "random".

        Raises:
            ValueError: The options contradict each other or the configuration.
        """
        starts = np.zeros(len(rows), START)
        numbers, biases, keys, shares = starts[NUMBERS], starts["biases"], starts["keys"], starts["shares"]
        for k, (i, options, rng) in enumerate(rows):
            scale = 1.0 if options.randomization_scale is None else options.randomization_scale
            draw = self._randomizer.draw(rng, scale)
            settings = options.applied_to(self._settings)
            friction = draw_friction(self._config, options, settings, material, draw, rng)
            box = make_box(self._config, options, settings, draw, rng)
            differences = chosen_differences(draw.config, options, draw.differences, friction.r)
            numbers[k] = self._numbers(i, settings, draw, friction, box, differences)
            begin_episode(self._episode, self._blank, starts, k)
            episode = self._episode[i]
            episode["wrist_roll"] = checked_roll(self._config, options)
            self._task.start(settings, options, rng, episode)
            for disturbance, u in draw.disturbances:
                schedule_disturbance(disturbance, u, episode)
            rng.standard_normal(out=biases[k])
            keys[k], shares[k] = draw_sensors(2, rng)
            self._hardware.apply_differences(i, differences, draw.values["lag"])
            self._note(i, options, draw, friction, box)
        return starts

    def _numbers(
        self,
        i: int,
        settings: TaskConfig,
        draw: Draw,
        friction: Friction,
        box: Box,
        differences: Mapping[str, tuple[float, ...]],
    ) -> tuple[Any, ...]:
        """Fields `NUMBERS` of START."""
        pad = self._config.gripper.pad_radius
        return (
            i,
            checked_force(self._config, settings),
            box.mass,
            box.inertia,
            box.size[1] / 2,
            box.grasp_from_com,
            (box.size[0] / 2 - pad, box.size[2] / 2 - pad),
            (-box.grasp_offset[0], -box.grasp_offset[1]),
            (friction.mu_s, friction.mu_c, friction.r),
            differences["finger_friction"],
            differences["finger_radius"],
            draw.values["friction_drift"],
            draw.values["bias_scale"],
        )

    def _note(self, i: int, options: EpisodeOptions, draw: Draw, friction: Friction, box: Box) -> None:
        """Store the episode's reported values; apply its parameters to gripper, sensors and estimators."""
        self.materials[i], self.boxes[i] = friction.material, box
        if self._parameters is not None:
            own = self._parameters[2 * i : 2 * i + 2] if len(self._parameters) > 1 else self._parameters
            own[LATENCY] = draw.values["slip_latency"]
        if self._randomizer.active:  # else the parameters are those of the configuration
            start = {"mu_s": friction.mu_s, "mu_c": friction.mu_c, "mass": box.mass}
            self.drawn[i] = {**start, **draw.report(options)}
            self._hardware.apply(i, draw.values, draw.config.contact.pressure)


def _blank_episode(config: Config, settings: TaskConfig, task: Task) -> np.ndarray:
    """The values that all episodes of a task begin with, EPISODE (1,)."""
    episode = np.zeros(1, EPISODE)
    episode["step_time"] = 1.0 / config.physics.control_rate
    for field in ("force_min", "force_max", "wrist_speed_max", "wrist_pitch_rate_max", "pad_radius"):
        episode[field] = getattr(config.gripper, field)
    scales = [settings.reward[term] for term in task.term_names]
    episode["scales"][0, : len(scales)] = scales
    episode["mass_factor"] = episode["jump_factor"] = episode["region_factor"] = 1.0
    return episode


def draw_friction(
    config: Config,
    options: EpisodeOptions,
    task: TaskConfig,
    material: str,
    draw: Draw,
    rng: np.random.Generator,
) -> Friction:
    """Friction of an episode: the options' values, else randomized ones, else the material's.

    If a material is named, friction is not randomized. Options that fix only mu_s or only mu_c keep the
    sampled ratio of the two.

    Raises:
        ValueError: The material is unknown, mu_s would be below mu_c, or the pad has no room for r.
    """
    names = sorted(config.materials)
    drawn = names[rng.integers(len(names))]  # drawn always, so that options do not shift later draws
    name = options.material or material
    random = name == "random"
    if random:
        name = draw.material or drawn
    if name not in config.materials:
        raise ValueError(unknown("material", name, ["random", *names]))
    mu_s, mu_c = config.materials[name].mu_s, config.materials[name].mu_c
    if random and draw.friction:
        mu_s, mu_c = draw.friction_of(config.materials[name])
        if options.mu_s is not None:
            mu_c *= options.mu_s / mu_s
        elif options.mu_c is not None:
            mu_s *= options.mu_c / mu_c
    mu_s, mu_c = options.mu_s or mu_s, options.mu_c or mu_c
    if mu_s < mu_c:
        raise ValueError(f"mu_s = {mu_s:g} must be at least mu_c = {mu_c:g} (material {name!r})")
    r = options.r or draw.values["radius_scale"] * (task.radius or draw.config.contact_radius)
    draw.config.check_patch("option r", r)
    return Friction(mu_s, mu_c, r, name)


def make_box(
    config: Config, options: EpisodeOptions, task: TaskConfig, draw: Draw, rng: np.random.Generator
) -> Box:
    """The configured object, with the values that the task and the randomization sample or the options fix.

    Raises:
        ValueError: The pads or the centre of mass would not lie on the object.
    """
    default, values = task.object or config.object, draw.values
    mass = default.mass if task.mass_range is None else rng.uniform(*task.mass_range)
    mass *= values["mass_scale"]
    scale = 1.0 if options.object_size is not None else values["size_scale"]
    x, y, z = default.size if options.object_size is None else options.object_size
    size = scale * x, y, scale * z
    grasp_offset = scale * default.grasp_offset[0], scale * default.grasp_offset[1]
    com_offset = (
        scale * default.com_offset[0] + values["com_x"] * size[0],
        scale * default.com_offset[1] + values["com_z"] * size[2],
    )
    if options.object_mass is not None:
        mass = options.object_mass
    if options.com_offset is not None:
        com_offset = options.com_offset
    _check_inside("com_offset", com_offset, size, margin=0.0)
    _check_inside("grasp_offset", grasp_offset, size, margin=config.gripper.pad_radius)
    inertia = box_inertia(mass, size[0], size[2])
    if default.inertia is not None:
        inertia = default.inertia * values["mass_scale"] * scale**2
    return Box(
        size=size,
        com_offset=com_offset,
        grasp_offset=grasp_offset,
        mass=float(mass),
        inertia=float(inertia),
    )


def _check_inside(
    name: str, point: tuple[float, float], size: tuple[float, float, float], margin: float
) -> None:
    """Raise ValueError unless a point (x, z) lies on the object, `margin` away from its edges."""
    room = size[0] / 2 - margin, size[2] / 2 - margin
    if abs(point[0]) > room[0] or abs(point[1]) > room[1]:
        around = f" with the pad of radius {margin:g} m around it" if margin else ""
        raise ValueError(
            f"{name} {tuple(point)} m{around} must lie on the object, {size[0]:g} m by {size[2]:g} m"
        )


def checked_roll(config: Config, options: EpisodeOptions) -> float:
    """Roll of the wrist at reset [rad].

    Raises:
        ValueError: It is given without `physics.tilt`.
    """
    roll = options.wrist_roll or 0.0
    if roll and not config.physics.tilt:
        raise ValueError(f"option wrist_roll = {roll:g} rad {NEEDS_TILT}")
    return roll


def checked_force(config: Config, settings: TaskConfig) -> float:
    """Grip force per finger at reset [N].

    Raises:
        ValueError: The gripper's force loop cannot hold it.
    """
    gripper, force = config.gripper, settings.initial_force
    if not gripper.force_min <= force <= gripper.force_max:
        raise ValueError(
            f"option initial_force = {force:g} N must lie within the gripper's "
            f"{gripper.force_min:g} to {gripper.force_max:g} N"
        )
    return force
