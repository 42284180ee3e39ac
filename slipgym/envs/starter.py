"""Draws how episodes begin."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np

from slipgym.config import Config
from slipgym.config.task import TaskConfig
from slipgym.envs.choices import LATENCY
from slipgym.envs.draw import Draw, Randomizer
from slipgym.envs.episode import Friction, checked_force, draw_friction, make_box
from slipgym.envs.equipment import Equipment
from slipgym.envs.happenings import enter
from slipgym.envs.start import NUMBERS, START, begin_episode
from slipgym.sensors.starting import draw_sensors
from slipgym.tasks import Task
from slipgym.tasks.episode import EPISODE
from slipgym.tasks.options import EpisodeOptions
from slipgym.world.scene import Box

Row: TypeAlias = tuple[int, EpisodeOptions, np.random.Generator]
"""An environment that is to start, what its options fix, and the source of its draws."""


class Starter:
    """Draws the episodes of n environments.

    Args:
        config: Configuration.
        settings: The task's settings.
        task: The task.
        randomizer: Of the randomization.
        equipment: Fitted to what it draws.
        episode: EPISODE (n,); rows are filled in.
        parameters: Of the estimators that are to be told the slip sensor's latency, (2 n,), or (1,) for all;
            None: of none.

    Attributes:
        materials: Name of every episode's material.
        boxes: Its object.
        drawn: What the randomization drew for it, JSON-like; empty without one.
    """

    def __init__(
        self,
        config: Config,
        settings: TaskConfig,
        task: Task,
        randomizer: Randomizer,
        equipment: Equipment,
        episode: np.ndarray,
        parameters: np.ndarray | None,
    ) -> None:
        n = len(episode)
        self._config, self._task, self._randomizer = config, task, randomizer
        self._equipment, self._episode, self._parameters = equipment, episode, parameters
        self._settings = settings
        self._blank = _blank_episode(config, settings, task)
        self.materials: list[str] = [""] * n
        self.boxes: list[Any] = [None] * n
        self.drawn: list[dict[str, Any]] = [{} for _ in range(n)]

    def draw(self, rows: Sequence[Row], material: str) -> np.ndarray:
        """Draw episodes, one generator after the other; returns START (m,).

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
            numbers[k] = self._numbers(i, settings, draw, friction, box)
            begin_episode(self._episode, self._blank, starts, k)
            episode = self._episode[i]
            self._task.start(settings, options, rng, episode)
            for disturbance, luck in draw.happenings:
                enter(disturbance, luck, episode)
            rng.standard_normal(out=biases[k])
            keys[k], shares[k] = draw_sensors(2, rng)
            self._note(i, options, draw, friction, box)
        return starts

    def _numbers(
        self, i: int, settings: TaskConfig, draw: Draw, friction: Friction, box: Box
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
            draw.values["friction_drift"],
            draw.values["bias_scale"],
        )

    def _note(self, i: int, options: EpisodeOptions, draw: Draw, friction: Friction, box: Box) -> None:
        """Keep what is reported of an episode, and what its gripper, sensors and estimators differ in."""
        self.materials[i], self.boxes[i] = friction.material, box
        if self._parameters is not None:
            own = self._parameters[2 * i : 2 * i + 2] if len(self._parameters) > 1 else self._parameters
            own[LATENCY] = draw.values["slip_latency"]
        if self._randomizer.active:  # everything fits from the start otherwise
            start = {"mu_s": friction.mu_s, "mu_c": friction.mu_c, "mass": box.mass}
            self.drawn[i] = {**start, **draw.report(options)}
            self._equipment.fit(i, draw.values, draw.config.contact.pressure)


def _blank_episode(config: Config, settings: TaskConfig, task: Task) -> np.ndarray:
    """What all episodes of a task begin with, EPISODE (1,)."""
    episode = np.zeros(1, EPISODE)
    episode["step_time"] = 1.0 / config.physics.control_rate
    for field in ("force_min", "force_max", "wrist_speed_max", "wrist_pitch_rate_max", "pad_radius"):
        episode[field] = getattr(config.gripper, field)
    scales = [settings.reward[term] for term in task.term_names]
    episode["scales"][0, : len(scales)] = scales
    episode["mass_factor"] = episode["jump_factor"] = episode["patch_factor"] = 1.0
    return episode
