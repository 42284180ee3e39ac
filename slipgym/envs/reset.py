"""Samples the initial conditions of episodes: friction, object, task, disturbances and sensors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from slipgym.config import Config
from slipgym.config.errors import NEEDS_TILT, unknown
from slipgym.config.task import TaskConfig
from slipgym.contact.pressure import stretch
from slipgym.contact.records import CELL_FIELDS
from slipgym.envs.randomizer import Drawn, Randomizer
from slipgym.envs.reset_kernels import HARDWARE, START
from slipgym.envs.sampling_kernels import GIVEN, compose, inside
from slipgym.envs.values import DIFFERENCES
from slipgym.sensors.starting import draw_sensors
from slipgym.tasks import Task
from slipgym.tasks.episode import EPISODE
from slipgym.tasks.options import EpisodeOptions
from slipgym.world.plant import (
    Plant,
    check_slip_latency,
    dead_ticks,
    patch_of,
    ticks_per_second,
    without_cells,
)
from slipgym.world.scene import Box

_CHECKED = "mu_s", "mu_c", "r", "finger_radius"
"""Options that can contradict sampled values."""


class _Chosen(NamedTuple):
    """What reset options and the name of a material fix."""

    settings: TaskConfig
    """The task's settings, with the options in place."""
    given: np.ndarray
    """GIVEN (1,)."""
    radii: np.ndarray
    """Radius r by pressure profile [m]."""
    fixed: Mapping[str, object]
    """Fields of VALUES, and what stands in place of sampled values."""
    reported: list[bool]
    """See `Drawn.reported`."""


class EpisodeSampler:
    """Samples the episodes of n environments, whose rows of EPISODE (n,) it fills in.

    Its attributes are those of the same names of a `Simulation`.
    """

    def __init__(
        self, config: Config, settings: TaskConfig, task: Task, randomizer: Randomizer, episode: np.ndarray
    ) -> None:
        n = len(episode)
        self._config, self._task, self._randomizer = config, task, randomizer
        self._episode, self._settings = episode, settings
        self.blank = _blank_episode(config, settings, task)
        self._names = sorted(config.materials)
        friction = [(config.materials[name].mu_s, config.materials[name].mu_c) for name in self._names]
        self._friction = np.array(friction)
        self._variants = list(randomizer.variants.values())
        self._last: tuple[EpisodeOptions, str, _Chosen] | None = None
        self.materials: list[str] = [""] * n
        self.boxes: list[Any] = [None] * n
        self.drawn = Drawn(randomizer, n)

    def sample(
        self,
        rows: np.ndarray,
        generators: Sequence[np.random.Generator],
        options: EpisodeOptions,
        material: str,
    ) -> tuple[np.ndarray, np.ndarray]:
        """Sample START (m,) and VALUES (m,) of episodes; an environment's draws do not depend on the others.

        Args:
            rows: Environments to reset, (m,).
            generators: Random generator of each.
            options: Parameters to fix for all of them.
            material: Name of a material, or "random".

        Raises:
            ValueError: The options contradict each other or the configuration.
        """
        chosen = self._choose(options, material)
        m, settings, scale = len(rows), chosen.settings, chosen.given["scale"].item()
        shares, picked = np.empty((m, self._randomizer.count)), np.empty(m, np.int64)
        further = np.zeros((m, 3))  # of mass, friction and radius
        ranges = settings.mass_range, settings.friction_range, settings.radius_range
        ranged = [j for j, each in enumerate(ranges) if each is not None]
        count = len(self._names)
        for k, rng in enumerate(generators):
            rng.random(out=shares[k])
            picked[k] = rng.integers(count)  # drawn always, so that options do not shift later draws
            for j in ranged:
                further[k, j] = rng.random()
        values, starts = self._randomizer.sample(shares, scale), np.zeros(m, START)
        starts["row"] = rows
        for name, numbers in chosen.fixed.items():
            values[name] = numbers
        tables = self._friction, chosen.radii, values, starts, self._episode, self.blank
        valid = compose(picked, further, chosen.given, *tables)
        if not valid or any(getattr(options, name) is not None for name in _CHECKED):
            for start, value in zip(starts, values, strict=True):
                self._check(start, value, options)
        if options.wrist_roll:
            self._episode["wrist_roll"][rows] = options.wrist_roll
        start_task, biases, keys, rests = self._task.start, starts["biases"], starts["keys"], starts["shares"]
        for k, (i, rng) in enumerate(zip(rows.tolist(), generators, strict=True)):
            start_task(settings, options, rng, self._episode[i])
            rng.standard_normal(out=biases[k])
            keys[k], rests[k] = draw_sensors(2, rng)
        if (shortest := self._episode["steps"][rows].min()) < 1:
            raise ValueError(
                f"{self._task.id}: start leaves episode.steps = {shortest}: expected at least 1, the length "
                "of the episode in control steps of episode.step_time"
            )
        happened = self._randomizer.schedule(shares, scale, rows, self._episode)
        self._note(rows, starts)
        self.drawn.keep(rows, chosen.reported, starts, values, happened)
        return starts, values

    def _choose(self, options: EpisodeOptions, material: str) -> _Chosen:
        """What options and the name of a material fix.

        Raises:
            ValueError: The options contradict the configuration.
        """
        if self._last is not None and self._last[:2] == (options, material):
            return self._last[2]
        config, settings = self._config, options.applied_to(self._settings)
        name, default = options.material or material, settings.object or config.object
        if name not in ("random", *self._names):
            raise ValueError(unknown("material", name, ["random", *self._names]))
        if options.wrist_roll and not config.physics.tilt:
            raise ValueError(f"option wrist_roll = {options.wrist_roll:g} rad {NEEDS_TILT}")
        low, high = config.gripper.force_min, config.gripper.force_max
        if not low <= settings.initial_force <= high:
            raise ValueError(
                f"option initial_force = {settings.initial_force:g} N must lie within the gripper's "
                f"{low:g} to {high:g} N"
            )
        if options.cop_offset is not None:
            config.check_cop_offset("option cop_offset", options.cop_offset)
        fields = {
            "scale": 1.0 if options.randomization_scale is None else options.randomization_scale,
            "force": settings.initial_force,
            "material": -1 if name == "random" else self._names.index(name),
            **{each: getattr(options, each) for each in ("mu_s", "mu_c", "r", "object_mass")},
            "object_com": options.com_offset,
            **{each: getattr(settings, each) for each in ("mass_range", "friction_range", "radius_range")},
            **{each: getattr(default, each) for each in ("mass", "com_offset", "grasp_offset", "inertia")},
            "size": options.object_size or default.size,
        }
        given = np.zeros(1, GIVEN)
        for each, value in fields.items():
            given[each] = np.nan if value is None else value
        differences = {each: getattr(options, each) for each in DIFFERENCES}
        fixed: dict[str, object] = {
            each: np.ravel(value) for each, value in differences.items() if value is not None
        }
        if options.object_size is not None:
            fixed["size_scale"] = 1.0
        radii = np.array([settings.radius or variant.contact_radius for variant in self._variants])
        chosen = _Chosen(settings, given, radii, fixed, self.drawn.reported(options))
        self._last = options, material, chosen
        return chosen

    def _check(self, start: np.void, value: np.void, options: EpisodeOptions) -> None:
        """Raise ValueError if the options contradict sampled values."""
        mu_s, mu_c, r = start["friction"].tolist()
        if mu_s < mu_c:
            name = self._names[start["material"]]
            raise ValueError(f"mu_s = {mu_s:g} must be at least mu_c = {mu_c:g} (material {name!r})")
        size, margin = tuple(start["size"].tolist()), self._config.gripper.pad_radius
        _check_inside("com_offset", start["com_offset"].tolist(), size, margin=0.0)
        _check_inside("grasp_offset", start["grasp_offset"].tolist(), size, margin=margin)
        variant = self._variants[start["pressure"]]
        variant.check_patch("option r", r)
        largest = r * max(value["finger_radius"].tolist())
        if options.finger_radius is not None:
            variant.check_radius("option finger_radius: the larger radius r", largest)
        elif largest != r:
            variant.check_patch("option r times finger_radius", largest)

    def _note(self, rows: np.ndarray, starts: np.ndarray) -> None:
        """Store materials and objects."""
        points = (
            zip(*starts[name].T.tolist(), strict=True) for name in ("size", "com_offset", "grasp_offset")
        )
        boxes = map(Box, *points, starts["mass"].tolist(), starts["inertia"].tolist())
        for i, box, place in zip(rows.tolist(), boxes, starts["material"].tolist(), strict=True):
            self.boxes[i], self.materials[i] = box, self._names[place]


def _blank_episode(config: Config, settings: TaskConfig, task: Task) -> np.ndarray:
    """The values that all episodes of a task begin with, EPISODE (1,)."""
    episode = np.zeros(1, EPISODE)
    episode["step_time"] = 1.0 / config.physics.control_rate
    for field in ("force_min", "force_max", "wrist_speed_max", "wrist_pitch_rate_max", "pad_radius"):
        episode[field] = getattr(config.gripper, field)
    if settings.wrist_speed is not None:
        episode["wrist_speed_max"] = settings.wrist_speed
    scales = [settings.reward[term] for term in task.term_names]
    episode["scales"][0, : len(scales)] = scales
    episode["mass_factor"] = episode["jump_factor"] = episode["region_factor"] = 1.0
    return episode


def _check_inside(name: str, point: list[float], size: tuple[float, ...], margin: float) -> None:
    """Raise ValueError unless a point (x, z) lies on the object, `margin` away from its edges."""
    if not inside(tuple(point), size, margin):
        around = f" with the pad of radius {margin:g} m around it" if margin else ""
        raise ValueError(
            f"{name} {tuple(point)} m{around} must lie on the object, {size[0]:g} m by {size[2]:g} m"
        )


def prepare_hardware(config: Config, plant: Plant, randomizer: Randomizer) -> tuple[np.ndarray, np.ndarray]:
    """Check that a plant, as it was built, can hold what is sampled, and make room for it.

    Returns:
        HARDWARE (1,), and the patch of each pressure profile (p, CELL_FIELDS, m), not stretched.

    Raises:
        ValueError: The plant's buffers do not hold the longest delays that may be sampled.
    """
    dead_ticks(config, randomizer.most("dead_time"), "randomization.dead_time")
    check_slip_latency(config, round(randomizer.most("slip_latency")), "randomization.slip_latency")
    sensor = config.sensors.force_torque
    tangential, normal, torque = sensor.bias_tangential, sensor.bias_normal, sensor.bias_torque
    hardware = np.zeros(1, HARDWARE)
    hardware["spread"] = tangential, tangential, normal, torque, torque, torque
    hardware["noise"] = plant.force_torque["noise"][0, 0]
    hardware["slip_noise"] = plant.slip_sensors["noise"][0, 0]
    hardware["clock"], hardware["randomized"] = ticks_per_second(config), randomizer.active
    if randomizer.soft and plant.cells is None:
        plant.cells = without_cells(len(plant.pads))
    if config.contact.model != "distributed":
        return hardware, np.zeros((0, CELL_FIELDS, 0))
    return hardware, _enlarge(plant, randomizer.variants)


def _enlarge(plant: Plant, variants: Mapping[str, Config]) -> np.ndarray:
    """Give a plant the patches of the first variant, in the size of the largest; returns all patches."""
    found = [patch_of(variant) for variant in variants.values()]
    patches = np.zeros((len(found), CELL_FIELDS, max(cells.shape[1] for cells in found)))
    for cells, own in zip(patches, found, strict=True):
        cells[:, : own.shape[1]] = own  # a cell of weight 0 does nothing
    first = patches[0].copy()
    stretch(first, plant.pads["axes"][0, 0])
    plant.cells = np.tile(first, (*plant.pads.shape, 1, 1))
    return patches
