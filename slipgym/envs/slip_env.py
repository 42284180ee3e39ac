"""The environment that every task runs in."""

from __future__ import annotations

import inspect
import math
import os
from collections.abc import Mapping
from typing import Any, ClassVar

import gymnasium as gym
import numpy as np

from slipgym.config import load
from slipgym.envs import observation
from slipgym.envs.choices import DEFAULT_ESTIMATOR, check_action, one_of, refuse_unknown
from slipgym.envs.loop import SlipLoop
from slipgym.envs.state import EnvState, checked, restored_generator
from slipgym.screen import obstacle
from slipgym.tasks import Task


class SlipEnv(gym.Env[np.ndarray, np.ndarray]):
    """A box between the two pads of a gripper; one step is `frame_skip` slip-velocity samples.

    The tasks are subclasses that name a `Task`; their docstrings describe spaces and rewards.

    Args:
        friction_source: What the observation's friction part holds: "estimated", "true",
            "nominal" or "none".
        estimator: Name of an estimator (`estimator.names()`), or a mapping with its `name`
            and parameters.
        contact: Friction model of the pads, "ellipsoid" or "distributed".
        sensors: Sensor preset, "realistic" or "ideal".
        material: Name of a material, or "random" for another in every episode.
        action_mode: "grip_force".
        observation_mode: "flat".
        randomization: "none".
        frame_skip: Slip-velocity samples per step.
        render_mode: None, "rgb_array", "depth_array" or "human".
        config: File or mapping of overrides of the default configuration.

    Raises:
        ValueError: The value of an argument is unknown or not allowed.
        TypeError: An argument is unknown.
        RuntimeError: A window cannot open here; `metadata["render_modes"]` then lacks "human".
    """

    task: ClassVar[Task]
    metadata: dict[str, Any] = {  # noqa: RUF012
        "render_modes": ["human", "rgb_array", "depth_array"],
        "render_fps": 120,
    }

    def __init__(
        self,
        friction_source: str = "estimated",
        estimator: str | Mapping[str, Any] = DEFAULT_ESTIMATOR,
        contact: str = "ellipsoid",
        sensors: str = "realistic",
        material: str = "random",
        action_mode: str = "grip_force",
        observation_mode: str = "flat",
        randomization: str = "none",
        frame_skip: int = 1,
        render_mode: str | None = None,
        config: str | os.PathLike[str] | Mapping[str, Any] | None = None,
        **unknown: Any,
    ) -> None:
        refuse_unknown(unknown, _KEYWORDS)
        self.friction_source = one_of("friction_source", friction_source, observation.FRICTION_SOURCES)
        one_of("contact", contact, ("ellipsoid", "distributed"))
        one_of("action_mode", action_mode, ("grip_force",))
        one_of("observation_mode", observation_mode, ("flat",))
        one_of("randomization", randomization, ("none",))
        if render_mode is not None:
            one_of("render_mode", render_mode, self.metadata["render_modes"])
        if isinstance(frame_skip, bool) or not isinstance(frame_skip, int) or frame_skip < 1:
            raise ValueError(f"frame_skip = {frame_skip!r} must be a whole number >= 1")
        self.config = load(config, sensors, contact)
        self.material = one_of("material", material, ("random", *self.config.materials))
        self.render_mode = render_mode
        modes = [mode for mode in self.metadata["render_modes"] if mode != "human" or not obstacle()]
        rate = self.config.physics.control_rate / frame_skip
        self.metadata = {**self.metadata, "render_modes": modes, "render_fps": rate}
        self.columns = observation.columns(self.config, self.task, self.friction_source)
        self._low = np.array([c.low for c in self.columns], dtype=np.float32)
        self._high = np.array([c.high for c in self.columns], dtype=np.float32)
        self.observation_space = gym.spaces.Box(self._low, self._high, dtype=np.float32)
        self.action_space = gym.spaces.Box(-1.0, 1.0, (1,), dtype=np.float32)
        self._out = np.zeros((1, len(self.columns)), dtype=np.float32)
        self._terms = np.zeros(len(self.task.terms))
        self._frame_skip = frame_skip
        self._loop = SlipLoop(self.config, self.task, estimator)
        self._arguments = {
            "friction_source": friction_source,
            "estimator": self._loop.estimator_choice,
            "contact": contact,
            "sensors": sensors,
            "material": material,
            "action_mode": action_mode,
            "observation_mode": observation_mode,
            "randomization": randomization,
            "frame_skip": frame_skip,
            "config": self.config.model_dump(mode="json"),
        }
        # the friction part: the merged estimates, or values that stand for the episode
        self._friction = self._loop.estimated if friction_source == "estimated" else np.ones((1, 6))
        self._views = self._info_views()
        self._renderer: Any = None
        if render_mode is not None:
            from slipgym.rendering import Renderer

            self._renderer = Renderer(render_mode, self._loop)
        self._ready = False

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
        self._ready = False
        self._loop.reset(self.task.options.parse(options), self.material, self.np_random)
        nominal = self.config.nominal
        if self.friction_source == "true":
            self._friction[0, :3] = self._loop.true_friction
        elif self.friction_source == "nominal":
            radius = getattr(self.config.tasks, self.task.key).radius or nominal.r
            self._friction[0, :3] = nominal.mu_s, nominal.mu_c, radius
        self._terms[:] = 0.0
        if self._renderer is not None:
            self._renderer.begin()
        self._ready = True
        return self._observation(), self._info()

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Command a grip force for `frame_skip` slip-velocity samples.

        Args:
            action: Grip force per finger, -1 for `gripper.force_min` to +1 for `force_max`, shape (1,).

        Raises:
            ValueError: The action has the wrong shape or is not finite.
            RuntimeError: The environment is closed or needs a reset.
            FloatingPointError: The simulation left the finite numbers; the message names the first.
        """
        share = 0.5 * (1.0 + check_action(action))
        if not self._ready:
            _ = self._loop.world.client
            raise RuntimeError("call reset() before step()")
        gripper = self.config.gripper
        force = gripper.force_min + share * (gripper.force_max - gripper.force_min)
        loop, episode, rng = self._loop, self._loop.episode, self.np_random
        self._terms[:] = 0.0
        dropped = finished = self._ready = False
        for _ in range(self._frame_skip):
            loop.sample(force, rng)
            self._terms += episode["terms"][0, : len(self._terms)]
            dropped = episode["dropped"].item()
            finished = episode["step"].item() >= episode["steps"].item()
            if self._renderer is not None:
                self._renderer.keep()
            if dropped or finished:
                break
        self._ready = True
        reward = math.fsum(self._terms.tolist())
        return self._observation(), reward, dropped, finished and not dropped, self._info()

    def render(self) -> np.ndarray | None:
        """What the render mode asks for; None without one.

        Returns:
            "rgb_array": picture (480, 720, 3) uint8; "depth_array": distances (480, 448) float32 [m],
            infinite where nothing is; "human": None, the picture is in the window.

        Raises:
            RuntimeError: The environment is closed or was never reset.
        """
        world = self._loop.world
        _ = world.client
        if self._renderer is None:
            return None
        _ = world.box
        return self._renderer.render()

    def get_state(self) -> EnvState:
        """Everything that decides what the environment does next, as plain data.

        Raises:
            RuntimeError: The environment is closed.
        """
        _ = self._loop.world.client
        return EnvState(
            made_of={"task": self.task.name, **self._arguments},
            generator=self.np_random.bit_generator.state,
            seed=self._np_random_seed,
            loop=self._loop.get_state() if self._ready else None,
            friction=self._friction.copy(),
        )

    def set_state(self, state: EnvState) -> None:
        """Go on from a state, bit for bit, also from that of another environment or process.

        Args:
            state: From `get_state` of an environment made with the same arguments.

        Raises:
            TypeError: It is no state.
            ValueError: It is of another kind of environment.
            RuntimeError: This environment is closed.
        """
        checked(state).check({"task": self.task.name, **self._arguments})
        _ = self._loop.world.client
        self._np_random = restored_generator(state.generator)
        self._np_random_seed = state.seed
        if state.loop is not None:
            self._loop.set_state(state.loop)
            if self._renderer is not None:
                self._renderer.begin()
        self._friction[:] = state.friction
        self._ready = state.loop is not None

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickling and copying make a new environment with a world of its own, in the same state."""
        state = None if self._loop.world.closed else self.get_state()
        arguments = {**self._arguments, "render_mode": self.render_mode}
        return _rebuild, (type(self), arguments, state, self.spec)

    def close(self) -> None:
        """Release the physics client; closing twice is harmless."""
        self._loop.world.close()
        if self._renderer is not None:
            self._renderer.close()
        self._ready = False

    def _observation(self) -> np.ndarray:
        loop = self._loop
        observation.observe(
            loop.wrenches,
            loop.twists,
            loop.plant.chips,
            loop.episode,
            loop.task_part,
            self._friction,
            self._low,
            self._high,
            self._out,
        )
        return self._out[0].copy()

    def _info_views(self) -> dict[str, np.ndarray]:
        """Arrays that every info carries a copy of."""
        loop = self._loop
        return {
            "true": loop.true_friction,
            "estimated": loop.estimated[0, :3],
            "estimated_per_finger": loop.per_finger[0],
            "slip": loop.plant.world["slip"][0],
            "slip_twist": loop.plant.world["slip_twist"][0],
            "contact_wrench": loop.plant.pads["wrench"][0],
            "grip_force": loop.plant.fingers["force"][0],
            "reference": loop.episode["reference"][0],
        }

    def _info(self) -> dict[str, Any]:
        episode = self._loop.episode
        info: dict[str, Any] = {name: view.copy() for name, view in self._views.items()}
        info["reward_terms"] = dict(zip(self.task.terms, self._terms.tolist(), strict=True))
        info["time"] = self._loop.time
        info["is_success"] = episode["success"].item()
        info["dropped"] = episode["dropped"].item()
        return info


def _rebuild(kind: type[SlipEnv], arguments: Mapping[str, Any], state: EnvState | None, spec: Any) -> SlipEnv:
    env = kind(**arguments)
    env.spec = spec
    if state is None:
        env.close()
    else:
        env.set_state(state)
    return env


_KEYWORDS = [
    name
    for name, parameter in inspect.signature(SlipEnv.__init__).parameters.items()
    if parameter.kind is parameter.POSITIONAL_OR_KEYWORD and name != "self"
]
