"""`SlipEnv`, the base class of the tasks' environments."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Unpack

import gymnasium as gym
import numpy as np

from slipgym.config.base import plain
from slipgym.envs.arguments import ScalarArguments, complete
from slipgym.envs.conventions import Conventions, documented, horizon, rebuilt
from slipgym.envs.engines import resolved, simulation_of
from slipgym.envs.infos import info_reader
from slipgym.envs.setup import Setup
from slipgym.envs.states import EnvState, checked, restored_generator
from slipgym.screen import obstacle
from slipgym.tasks import Task

if TYPE_CHECKING:
    from slipgym.rendering.discrepancy import Discrepancy


@documented(ScalarArguments)
class SlipEnv(Conventions, gym.Env[Any, np.ndarray]):
    """An environment with a box between the two pads of a gripper; one step is `frame_skip` control steps.

    `slipgym.envs.environment` makes a subclass for each `Task`, whose docstring describes spaces and rewards.

    Args:
        {arguments}

    Raises:
        ValueError: The value of an argument is unknown or not allowed.
        TypeError: An argument is unknown.
        RuntimeError: A window cannot open here; `metadata["render_modes"]` then lacks "human".
        ModuleNotFoundError: PyBullet is asked for and not installed.

    Attributes:
        engine: "bullet" or "planar".
    """

    task: ClassVar[Task]
    metadata: dict[str, Any] = {  # noqa: RUF012
        "render_modes": ["human", "rgb_array", "depth_array"],
        "render_fps": 120,
    }

    def __init__(self, **arguments: Unpack[ScalarArguments]) -> None:
        values = complete(ScalarArguments, arguments)
        self.engine = resolved(values["engine"])
        render_mode, frame_skip = values["render_mode"], values["frame_skip"]
        self._shown = {name: values[name] for name in ("render_mode", "render_size")}
        setup = Setup(self.task, values, simulation_of(self.engine))
        self.config, self.settings = setup.config, setup.settings
        self.randomization, self.material = setup.randomization, setup.material
        self.render_mode, self._frame_skip = render_mode, frame_skip
        modes = [mode for mode in self.metadata["render_modes"] if mode != "human" or not obstacle()]
        rate = self.config.physics.control_rate / frame_skip
        self.metadata = {**self.metadata, "render_modes": modes, "render_fps": rate}
        self.simulation, self._actions, self._observer = setup.simulation, setup.actions, setup.observer
        self.columns, self.privileged_columns = self._observer.columns, self._observer.privileged
        self.action_columns = self._actions.columns
        self.action_space, self.observation_space = self._actions.space, self._observer.space
        self._arguments = {**setup.arguments, "engine": self.engine}
        self._report = info_reader(self.simulation.infos, self.task.term_names, self.simulation.estimating)
        self._renderer: Any = None
        if render_mode is not None:
            from slipgym.rendering import Renderer

            self._renderer = Renderer(render_mode, self.simulation, size=values["render_size"])
        self._ready = False
        self._horizon = horizon(self.task, self.settings, self.simulation.blank, frame_skip)
        self._own = frozenset(vars(self))

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Start an episode.

        A reset that raises leaves the generator as it was. After an unknown option or a value that is not
        allowed the episode under way goes on; after any other exception the environment needs a reset.

        Args:
            seed: Seed of the environment's generator.
            options: Episode parameters to fix; the task's `Options` lists them.

        Raises:
            ValueError: An option is unknown or its value is not allowed.
            RuntimeError: The environment is closed.
        """
        asked = self.task.options.parse(options)
        self.simulation.check_open()
        generator, its_seed = self._np_random, self._np_random_seed
        state = {} if generator is None else generator.bit_generator.state
        try:
            super().reset(seed=plain(seed))
            self._ready = False
            self.simulation.reset(asked, self.material, self.np_random)
            if self._renderer is not None:
                self._renderer.begin()
            self._observer.begin(_FIRST)
            drawn, (info, *_) = self.simulation.drawn.one(0), self._report()
            observation = self._observer.first()
        except BaseException:
            if generator is not None:
                generator.bit_generator.state = state
            self._np_random, self._np_random_seed = generator, its_seed
            raise
        self._ready = True
        return observation, {**info, "drawn": drawn} if drawn else info

    def step(self, action: np.ndarray) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Act for `frame_skip` control steps.

        Args:
            action: Within [-1, 1], shape (m,); `action_columns` describes its components.

        Raises:
            ValueError: The action has the wrong shape or is not finite.
            RuntimeError: The environment is closed or needs a reset.
            FloatingPointError: A quantity is not finite; the message names the first one.
        """
        actions = self._actions.checked(action)
        if not self._ready:
            self.simulation.check_open()
            raise RuntimeError("call reset() before step()")
        simulation, observer = self.simulation, self._observer
        self._ready = False
        if self._renderer is None:
            simulation.step(actions, self._actions.table, self._frame_skip, _ONE, observer.buffers)
        else:
            self._step_in_pictures(actions)
        if observer.history or observer.privileged:
            observer.next(_ONE)
        info, reward, terminated, timed_out = self._report()
        observation = observer.first()
        self._ready = True
        return observation, reward, terminated, timed_out and not terminated, info

    def _step_in_pictures(self, actions: np.ndarray) -> None:
        """`Simulation.step` with every control step in the pictures' strip."""
        simulation, total = self.simulation, np.zeros(len(self.task.term_names))
        for _ in range(self._frame_skip):
            simulation.step(actions, self._actions.table, 1, _ONE, self._observer.buffers)
            total += simulation.infos.terms[0]
            self._renderer.keep()
            if simulation.over:
                break
        simulation.infos.terms[0] = total

    def render(self) -> np.ndarray | None:
        """Render the environment as the render mode asks; without a render mode, do nothing.

        Returns:
            "rgb_array": picture (480, 720, 3) uint8; "depth_array": distances (480, 448) float32 [m],
            infinite for the background; both of the argument `render_size` if it is given. "human": None,
            the picture is shown in a window.

        Raises:
            RuntimeError: The environment is closed or was never reset.
        """
        self.simulation.check_open()
        if self._renderer is None:
            return None
        self._check_object()
        return self._renderer.render()

    def discrepancies(self) -> list[Discrepancy]:
        """Return the estimates of friction that are off, and why, in the words of the picture.

        Returns:
            One for each; empty without a render mode, which keeps the episode's history.

        Raises:
            RuntimeError: The environment is closed or was never reset.
        """
        self._check_object()
        return [] if self._renderer is None else self._renderer.discrepancies()

    def get_state(self) -> EnvState:
        """Return the complete state as plain data; an environment continues from it bit for bit.

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
        """Restore a state, bit for bit; it may come from another environment or process.

        Args:
            state: From `get_state` of an environment made with the same arguments.

        Raises:
            TypeError: `state` is not a state.
            ValueError: The state belongs to an environment with other arguments or version, or is damaged;
                nothing changes.
            RuntimeError: This environment is closed.
        """
        checked(state, EnvState).check({"task": self.task.name, **self._arguments})
        self.simulation.check_open()
        generator = restored_generator(state.generator)
        if state.simulation is not None:
            self.simulation.check_state(state.simulation, _ONE)
        self._ready = False
        if state.simulation is not None:
            self.simulation.set_state(state.simulation, _ONE)
            if self._renderer is not None:
                self._renderer.begin()
            self._observer.set_state(state.frames, _ONE)
        self._np_random, self._np_random_seed = generator, state.seed
        self._ready = state.simulation is not None

    def _check_object(self) -> None:
        self.simulation.check_open()
        if self.simulation.boxes[0] is None:
            raise RuntimeError("call reset() first: there is no object yet")

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickling and copying make an independent environment in the same state, see `Conventions`."""
        state = None if self.simulation.closed else self.get_state()
        arguments = {**self._arguments, **self._shown}
        return rebuilt, (SlipEnv, type(self), arguments, state), self._kept()

    def close(self) -> None:
        """Release the physics client; closing twice is harmless."""
        self.simulation.close()
        if self._renderer is not None:
            self._renderer.close()
        self._ready = False


_ONE = np.ones(1, dtype=bool)
_FIRST = np.zeros(1, dtype=np.int64)
