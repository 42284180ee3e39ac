"""The environment that every task runs in."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from typing import Any, ClassVar

import gymnasium as gym
import numpy as np

import estimator as estimators
from slipgym.config import TaskConfig, load
from slipgym.envs import observation
from slipgym.envs.choices import check_action, one_of
from slipgym.envs.episode import draw_friction, make_box
from slipgym.sensors.measure import measure
from slipgym.sensors.slip_velocity import AXES
from slipgym.tasks import Task
from slipgym.tasks.episode import EPISODE
from slipgym.tasks.options import EpisodeOptions
from slipgym.world.bullet import BulletWorld
from slipgym.world.plant import build
from slipgym.world.scene import Box

WARM_UP_STEPS = 6  # control steps before time 0 in which grip and sensors come to rest


class SlipEnv(gym.Env[np.ndarray, np.ndarray]):
    """A box between the two pads of a gripper; one step is `frame_skip` slip-velocity samples.

    The tasks are subclasses that name a `Task`; their docstrings describe spaces and rewards.

    Args:
        friction_source: What the observation's friction part holds: "estimated", "true",
            "nominal" or "none".
        estimator: Name of an estimator (`estimator.names()`), or a mapping with its `name`
            and parameters.
        contact: Friction model of the pads; "ellipsoid".
        sensors: Sensor preset, "realistic" or "ideal".
        material: Name of a material, or "random" for another in every episode.
        action_mode: "grip_force".
        observation_mode: "flat".
        randomization: "none".
        frame_skip: Slip-velocity samples per step.
        render_mode: None or "rgb_array".
        config: File or mapping of overrides of the default configuration.

    Raises:
        ValueError: An argument is unknown or not allowed.
    """

    task: ClassVar[Task]
    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 120}  # noqa: RUF012

    def __init__(
        self,
        friction_source: str = "estimated",
        estimator: str | Mapping[str, Any] = "rls",
        contact: str = "ellipsoid",
        sensors: str = "realistic",
        material: str = "random",
        action_mode: str = "grip_force",
        observation_mode: str = "flat",
        randomization: str = "none",
        frame_skip: int = 1,
        render_mode: str | None = None,
        config: str | os.PathLike[str] | Mapping[str, Any] | None = None,
    ) -> None:
        self.friction_source = one_of("friction_source", friction_source, observation.FRICTION_SOURCES)
        one_of("contact", contact, ("ellipsoid",))
        one_of("action_mode", action_mode, ("grip_force",))
        one_of("observation_mode", observation_mode, ("flat",))
        one_of("randomization", randomization, ("none",))
        if render_mode is not None:
            one_of("render_mode", render_mode, self.metadata["render_modes"])
        if isinstance(frame_skip, bool) or not isinstance(frame_skip, int) or frame_skip < 1:
            raise ValueError(f"frame_skip = {frame_skip!r} must be a whole number >= 1")
        self.config = load(config, sensors)
        self.material = one_of("material", material, ("random", *self.config.materials))
        self.render_mode = render_mode
        self.metadata = {**self.metadata, "render_fps": self.config.physics.control_rate / frame_skip}
        self._frame_skip = frame_skip
        self._step_time = 1.0 / self.config.physics.control_rate
        self._make_spaces()
        self._make_buffers(estimator)
        self._world = BulletWorld(self.config, self._plant)
        self._ready = False

    def _make_spaces(self) -> None:
        self.columns = observation.columns(self.config, self.task, self.friction_source)
        self._low = np.array([c.low for c in self.columns], dtype=np.float32)
        self._high = np.array([c.high for c in self.columns], dtype=np.float32)
        self.observation_space = gym.spaces.Box(self._low, self._high, dtype=np.float32)
        self.action_space = gym.spaces.Box(-1.0, 1.0, (1,), dtype=np.float32)

    def _make_buffers(self, estimator: str | Mapping[str, Any]) -> None:
        self._plant = build(self.config)
        self._estimator = _make_estimator(estimator)
        samples = -(-self.config.sensors.force_torque.rate // self.config.physics.control_rate) + 1
        self._noise = np.zeros(2 * (samples * 12 + AXES))
        self._force_noise = self._noise[: 2 * samples * 12].reshape(1, 2, samples, 12)
        self._slip_noise = self._noise[2 * samples * 12 :].reshape(1, 2, AXES)
        self._wrenches, self._twists = np.zeros((1, 2, 4)), np.zeros((1, 2, 3))
        self._wrench_rows, self._twist_rows = self._wrenches.reshape(2, 4), self._twists.reshape(2, 3)
        self._episode = np.zeros(1, EPISODE)
        self._terms = np.zeros(len(self.task.terms))
        self._task_part = np.zeros((1, len(self.task.columns)))
        self._friction_part = np.ones((1, len(observation.FRICTION_COLUMNS)))
        self._out = np.zeros((1, len(self.columns)), dtype=np.float32)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Start an episode.

        Args:
            seed: Seed of the environment's generator.
            options: Episode parameters to fix; the task's `Options` lists them.

        Raises:
            ValueError: An option is unknown or its value is not allowed.
            RuntimeError: The environment is closed.
        """
        super().reset(seed=seed)
        chosen = self.task.options.parse(options)
        _ = self._world.client
        self._friction = draw_friction(self.config, chosen, self.material, self.np_random)
        task_config = getattr(self.config.tasks, self.task.key)
        box = make_box(self.config, chosen, task_config, self.np_random)
        force = chosen.choose("initial_force", task_config)
        self._start_episode(box, chosen, task_config)
        self._world.reset(box, force)
        self._set_friction()
        self._draw_sensor_offsets()
        for _ in range(WARM_UP_STEPS):
            self._advance(force)
        self._start_clock(force)
        return self._observation(), self._info()

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Command a grip force for `frame_skip` slip-velocity samples.

        Args:
            action: Grip force per finger, -1 for `gripper.force_min` to +1 for `force_max`, shape (1,).

        Raises:
            ValueError: The action has the wrong shape or is not finite.
            RuntimeError: The environment is closed or was never reset.
        """
        share = 0.5 * (1.0 + check_action(action))
        if not self._ready:
            _ = self._world.client
            raise RuntimeError("call reset() before step()")
        gripper = self.config.gripper
        force = gripper.force_min + share * (gripper.force_max - gripper.force_min)
        self._terms[:] = 0.0
        dropped = truncated = False
        for _ in range(self._frame_skip):
            dropped, truncated = self._sample(force)
            if dropped or truncated:
                break
        reward = math.fsum(self._terms.tolist())
        return self._observation(), reward, dropped, truncated, self._info()

    def render(self) -> np.ndarray | None:
        """Picture of the scene, (height, width, 3) uint8, in render mode "rgb_array".

        Raises:
            RuntimeError: The environment is closed or was never reset.
        """
        _ = self._world.client
        if self.render_mode is None:
            return None
        from slipgym.rendering import look, picture

        _ = self._world.box
        return picture(look(self._world, self._friction.material, self.config.gripper.pad_radius))

    def close(self) -> None:
        """Release the physics client; closing twice is harmless."""
        self._world.close()
        self._ready = False

    def _sample(self, force: float) -> tuple[bool, bool]:
        """One slip-velocity sample: act, move, measure, estimate, judge. Returns dropped and truncated."""
        plant, episode = self._plant, self._episode
        episode["last_command"] = episode["command"]
        episode["command"] = force
        self.task.plan(episode, plant.world)
        self._advance(force)
        episode["step"] += 1
        time = episode["step"].item() * self._step_time
        self._estimator.update(time, self._wrench_rows, self._twist_rows)
        self.task.judge(episode, plant.world, plant.fingers, self._task_part)
        self._terms += episode["terms"][0, : len(self.task.terms)]
        dropped = episode["dropped"].item()
        return dropped, not dropped and episode["step"].item() >= episode["steps"].item()

    def _advance(self, force: float) -> None:
        """One control step of the world and its sensors."""
        plant = self._plant
        self.np_random.standard_normal(out=self._noise)
        self._world.command(force)
        self._world.step(self._force_noise)
        measure(plant.world, plant.force_torque, plant.chips, self._slip_noise, self._wrenches, self._twists)

    def _start_episode(self, box: Box, options: EpisodeOptions, task_config: TaskConfig) -> None:
        episode = self._episode
        episode[:] = 0
        episode["step_time"] = self._step_time
        episode["force_max"] = self.config.gripper.force_max
        pad = self.config.gripper.pad_radius
        episode["reach"] = box.size[0] / 2 - pad, box.size[2] / 2 - pad
        episode["object_centre"] = -box.grasp_offset[0], -box.grasp_offset[1]
        scales = [getattr(task_config.reward, term) for term in self.task.terms]
        episode["scales"][0, : len(scales)] = scales
        self.task.start(self.config, options, self.np_random, episode[0])

    def _start_clock(self, force: float) -> None:
        plant, episode = self._plant, self._episode
        plant.chips["travel"] = 0.0
        self._estimator.reset()
        episode["command"] = episode["last_command"] = force
        self.task.judge(episode, plant.world, plant.fingers, self._task_part)
        self._terms[:] = 0.0
        self._ready = True

    def _set_friction(self) -> None:
        friction, nominal = self._friction, self.config.nominal
        for field in ("mu_s", "mu_c", "r"):
            self._plant.pads[field] = getattr(friction, field)
        self._friction_part[:] = 1.0
        if self.friction_source == "true":
            self._friction_part[0, :3] = friction.as_array()
        elif self.friction_source == "nominal":
            self._friction_part[0, :3] = nominal.mu_s, nominal.mu_c, nominal.r

    def _draw_sensor_offsets(self) -> None:
        """Start the sensors afresh, with this episode's bias and sub-count phases."""
        rng, ft, chips = self.np_random, self._plant.force_torque, self._plant.chips
        sensor = self.config.sensors.force_torque
        tangential, normal, torque = sensor.bias_tangential, sensor.bias_normal, sensor.bias_torque
        spread = np.array([tangential, tangential, normal, torque, torque, torque])
        ft["bias"] = spread * rng.standard_normal((1, 2, 6))
        ft["history"] = chips["counted"] = 0.0
        for field in ("taken", "drawn"):
            ft[field] = 0
        chips["taken"] = 0
        chips["carry"] = rng.uniform(-1.0, 1.0, (1, 2, AXES)) * chips["count"][..., None]

    def _observation(self) -> np.ndarray:
        if self.friction_source == "estimated":
            observation.combine(self._estimator.estimates, self._friction_part)
        observation.observe(
            self._wrenches,
            self._twists,
            self._plant.chips,
            self._episode,
            self._task_part,
            self._friction_part,
            self._low,
            self._high,
            self._out,
        )
        return self._out[0].copy()

    def _info(self) -> dict[str, Any]:
        plant, episode = self._plant, self._episode[0]
        estimates = self._estimator.estimates
        per_finger = np.column_stack([estimates[field] for field in ("mu_s", "mu_c", "r")])
        return {
            "true": self._friction.as_array(),
            "estimated": per_finger.mean(axis=0),
            "estimated_per_finger": per_finger,
            "slip": plant.world["slip"][0].copy(),
            "slip_twist": plant.world["slip_twist"][0].copy(),
            "grip_force": plant.fingers["force"][0].copy(),
            "reference": episode["reference"].copy(),
            "reward_terms": dict(zip(self.task.terms, self._terms.tolist(), strict=True)),
            "time": episode["step"].item() * self._step_time,
            "is_success": bool(episode["success"]),
            "dropped": bool(episode["dropped"]),
        }


def _make_estimator(choice: str | Mapping[str, Any]) -> estimators.BatchEstimator:
    if isinstance(choice, str):
        return estimators.make_batch(choice, 2)
    if not isinstance(choice, Mapping) or not isinstance(choice.get("name"), str):
        raise ValueError(
            f"estimator = {choice!r} must be a name or a mapping with a name; "
            f"valid: {', '.join(estimators.names())}"
        )
    parameters = dict(choice)
    return estimators.make_batch(parameters.pop("name"), 2, **parameters)
