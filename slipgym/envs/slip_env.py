"""The environment that every task runs in."""

from __future__ import annotations

import inspect
import math
import os
from collections.abc import Mapping
from typing import Any, ClassVar

import gymnasium as gym
import numpy as np

from slipgym.config import load, load_randomization
from slipgym.envs.actions import ACTION_MODES, COMMANDS, Actions, interpret
from slipgym.envs.choices import DEFAULT_ESTIMATOR, one_of, refuse_unknown, whole
from slipgym.envs.loop import SlipLoop
from slipgym.envs.observer import Observer
from slipgym.envs.state import EnvState, checked, restored_generator
from slipgym.screen import obstacle
from slipgym.tasks import Task


class SlipEnv(gym.Env[Any, np.ndarray]):
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
        action_mode: What an action means: "grip_force", "grip_force_pitch", "grip_force_wrist" or
            "force_increment" (see docs/modes.md); None: the task's own.
        observation_mode: "flat", "sensor" (without the friction part) or "dict" (groups "policy" and
            "privileged").
        history: How many earlier observations come along with each.
        randomization: What is drawn per episode: "none", "train", "eval_ood", a file or a mapping
            (see docs/randomization.md).
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
        action_mode: str | None = None,
        observation_mode: str = "flat",
        history: int = 0,
        randomization: str | os.PathLike[str] | Mapping[str, Any] = "none",
        frame_skip: int = 1,
        render_mode: str | None = None,
        config: str | os.PathLike[str] | Mapping[str, Any] | None = None,
        **unknown: Any,
    ) -> None:
        refuse_unknown(unknown, _KEYWORDS)
        one_of("contact", contact, ("ellipsoid", "distributed"))
        action_mode = self.task.action_mode if action_mode is None else action_mode
        one_of("action_mode", action_mode, ACTION_MODES)
        if render_mode is not None:
            one_of("render_mode", render_mode, self.metadata["render_modes"])
        self.config = load(config, sensors, contact)
        self.randomization = load_randomization(randomization)
        self.material = one_of("material", material, ("random", *self.config.materials))
        self.render_mode = render_mode
        modes = [mode for mode in self.metadata["render_modes"] if mode != "human" or not obstacle()]
        self._frame_skip = whole("frame_skip", frame_skip, 1)
        rate = self.config.physics.control_rate / frame_skip
        self.metadata = {**self.metadata, "render_modes": modes, "render_fps": rate}
        self._actions = Actions(action_mode, self.config)
        self._loop = SlipLoop(self.config, self.task, estimator, self.randomization)
        self._commands = np.zeros((1, len(COMMANDS)))
        self._wrist = self._commands[0, 1:] if self._actions.moves_wrist else None
        self._observer = Observer(self._loop, friction_source, action_mode, observation_mode, history)
        self.columns, self.privileged_columns = self._observer.columns, self._observer.privileged
        self.action_columns = self._actions.columns
        self.action_space, self.observation_space = self._actions.space, self._observer.space
        self._terms = np.zeros(len(self.task.terms))
        self._arguments = {
            "friction_source": friction_source,
            "estimator": self._loop.estimator_choice,
            "contact": contact,
            "sensors": sensors,
            "material": material,
            "action_mode": action_mode,
            "observation_mode": observation_mode,
            "history": history,
            "randomization": self.randomization.model_dump(mode="json", exclude_unset=True),
            "frame_skip": frame_skip,
            "config": self.config.model_dump(mode="json"),
        }
        self._views = self._info_views()
        self._renderer: Any = None
        if render_mode is not None:
            from slipgym.rendering import Renderer

            self._renderer = Renderer(render_mode, self._loop)
        self._ready = False

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
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
        self._terms[:] = 0.0
        if self._renderer is not None:
            self._renderer.begin()
        self._ready = True
        drawn = {"drawn": dict(self._loop.drawn)} if self._loop.drawn else {}
        return self._observer.begin(), {**self._info(), **drawn}

    def step(self, action: np.ndarray) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Act for `frame_skip` slip-velocity samples.

        Args:
            action: Within [-1, 1], shape (m,); `action_columns` says what its components mean.

        Raises:
            ValueError: The action has the wrong shape or is not finite.
            RuntimeError: The environment is closed or needs a reset.
            FloatingPointError: The simulation left the finite numbers; the message names the first.
        """
        actions = self._actions.checked(action)
        if not self._ready:
            _ = self._loop.world.client
            raise RuntimeError("call reset() before step()")
        loop, episode, rng = self._loop, self._loop.episode, self.np_random
        self._terms[:] = 0.0
        dropped = finished = self._ready = False
        for _ in range(self._frame_skip):
            interpret(actions, self._actions.table, episode, self._commands)
            loop.sample(self._commands.item(0), rng, self._wrist)
            self._terms += episode["terms"][0, : len(self._terms)]
            dropped = episode["dropped"].item()
            finished = episode["step"].item() >= episode["steps"].item()
            if self._renderer is not None:
                self._renderer.keep()
            if dropped or finished:
                break
        self._ready = True
        reward = math.fsum(self._terms.tolist())
        return self._observer.next(), reward, dropped, finished and not dropped, self._info()

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
            friction=self._observer.friction.copy(),
            frames=self._observer.frames.copy(),
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
        self._observer.friction[:] = state.friction
        self._observer.frames[:] = state.frames
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
