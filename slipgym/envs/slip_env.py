"""The environment that every task runs in."""

from __future__ import annotations

import inspect
import os
from collections.abc import Mapping
from functools import partial
from typing import Any, ClassVar

import gymnasium as gym
import numpy as np

from slipgym.envs.choices import DEFAULT_ESTIMATOR, one_of, refuse_unknown
from slipgym.envs.engines import make_simulation
from slipgym.envs.information import Information
from slipgym.envs.observer import first
from slipgym.envs.setup import Setup
from slipgym.envs.state import EnvState, checked, restored_generator
from slipgym.screen import obstacle
from slipgym.tasks import Task


class SlipEnv(gym.Env[Any, np.ndarray]):
    """A box between the two pads of a gripper; one step is `frame_skip` slip-velocity samples.

    The tasks' environments are subclasses that name a `Task`, made by `slipgym.envs.environment`; their
    docstrings describe spaces and rewards.

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
        engine: What moves the bodies: "bullet", or "planar" for friction and the planar equations of motion
            alone (see docs/batch.md).
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
        engine: str = "bullet",
        frame_skip: int = 1,
        render_mode: str | None = None,
        config: str | os.PathLike[str] | Mapping[str, Any] | None = None,
        **unknown: Any,
    ) -> None:
        refuse_unknown(unknown, _KEYWORDS)
        if render_mode is not None:
            one_of("render_mode", render_mode, self.metadata["render_modes"])
        setup = Setup(
            self.task,
            partial(make_simulation, engine),
            friction_source,
            estimator,
            contact,
            sensors,
            material,
            action_mode,
            observation_mode,
            history,
            randomization,
            frame_skip,
            config,
        )
        self.config, self.settings = setup.config, setup.settings
        self.randomization, self.material = setup.randomization, setup.material
        self.render_mode, self._frame_skip = render_mode, setup.frame_skip
        modes = [mode for mode in self.metadata["render_modes"] if mode != "human" or not obstacle()]
        rate = self.config.physics.control_rate / frame_skip
        self.metadata = {**self.metadata, "render_modes": modes, "render_fps": rate}
        self.simulation, self._actions, self._observer = setup.simulation, setup.actions, setup.observer
        self.columns, self.privileged_columns = self._observer.columns, self._observer.privileged
        self.action_columns = self._actions.columns
        self.action_space, self.observation_space = self._actions.space, self._observer.space
        self._information = Information(self.simulation)
        self._arguments = {**setup.arguments, "engine": engine}
        self._renderer: Any = None
        if render_mode is not None:
            from slipgym.rendering import Renderer

            self._renderer = Renderer(render_mode, self.simulation)
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
        self.simulation.reset(self.task.options.parse(options), self.material, self.np_random)
        if self._renderer is not None:
            self._renderer.begin()
        self._ready = True
        drawn = self.simulation.drawn[0]
        self._observer.begin(_FIRST)
        return first(self._observer.read()), {
            **self._information.one(0),
            **({"drawn": dict(drawn)} if drawn else {}),
        }

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
            self.simulation.check_open()
            raise RuntimeError("call reset() before step()")
        simulation, episode, observer = self.simulation, self.simulation.episode, self._observer
        total = np.zeros(len(self.task.term_names))
        dropped = finished = self._ready = False
        # a picture's strip shows every sample
        at_once = self._frame_skip if self._renderer is None else 1
        for _ in range(0, self._frame_skip, at_once):
            simulation.step(actions, self._actions.table, at_once, _ONE, observer.sight)
            total += simulation.told.terms[0]
            dropped = episode["dropped"].item()
            finished = episode["step"].item() >= episode["steps"].item()
            if self._renderer is not None:
                self._renderer.keep()
            if dropped or finished:
                break
        simulation.told.terms[0] = total
        observer.next(_ONE)
        self._ready = True
        reward, info = sum(total.tolist()), self._information.one(0)
        return first(observer.read()), reward, dropped, finished and not dropped, info

    def render(self) -> np.ndarray | None:
        """What the render mode asks for; None without one.

        Returns:
            "rgb_array": picture (480, 720, 3) uint8; "depth_array": distances (480, 448) float32 [m],
            infinite where nothing is; "human": None, the picture is in the window.

        Raises:
            RuntimeError: The environment is closed or was never reset.
        """
        self.simulation.check_open()
        if self._renderer is None:
            return None
        if self.simulation.boxes[0] is None:
            raise RuntimeError("call reset() first: there is no object yet")
        return self._renderer.render()

    def get_state(self) -> EnvState:
        """Everything that decides what the environment does next, as plain data.

        Raises:
            RuntimeError: The environment is closed.
        """
        self.simulation.check_open()
        return EnvState(
            made_of={"task": self.task.name, **self._arguments},
            generator=self.np_random.bit_generator.state,
            seed=self._np_random_seed,
            simulation=self.simulation.get_state() if self._ready else None,
            frames=self._observer.get_state(),
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
        checked(state, EnvState).check({"task": self.task.name, **self._arguments})
        self.simulation.check_open()
        self._np_random = restored_generator(state.generator)
        self._np_random_seed = state.seed
        if state.simulation is not None:
            self.simulation.set_state(state.simulation)
            if self._renderer is not None:
                self._renderer.begin()
        self._observer.set_state(state.frames)
        self._ready = state.simulation is not None

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickling and copying make a new environment with a world of its own, in the same state."""
        state = None if self.simulation.closed else self.get_state()
        arguments = {**self._arguments, "render_mode": self.render_mode}
        return _rebuild, (type(self), arguments, state, self.spec)

    def close(self) -> None:
        """Release the physics client; closing twice is harmless."""
        self.simulation.close()
        if self._renderer is not None:
            self._renderer.close()
        self._ready = False


def _rebuild(kind: type[SlipEnv], arguments: Mapping[str, Any], state: EnvState | None, spec: Any) -> SlipEnv:
    env = kind(**arguments)
    env.spec = spec
    if state is None:
        env.close()
    else:
        env.set_state(state)
    return env


_ONE = np.ones(1, dtype=bool)
_FIRST = np.zeros(1, dtype=np.int64)
_KEYWORDS = [
    name
    for name, parameter in inspect.signature(SlipEnv.__init__).parameters.items()
    if parameter.kind is parameter.POSITIONAL_OR_KEYWORD and name != "self"
]
