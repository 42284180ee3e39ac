"""Thousands of environments in one process: the planar engine behind Gymnasium's vector interface."""

from __future__ import annotations

import inspect
import os
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space

from slipgym.config import Config, Randomization, TaskConfig
from slipgym.envs.choices import DEFAULT_ESTIMATOR, autoreset, one_of, whole
from slipgym.envs.information import Information, final
from slipgym.envs.pictures import Pictures
from slipgym.envs.planar_simulation import PlanarSimulation
from slipgym.envs.seeds import Generators
from slipgym.envs.setup import Setup
from slipgym.envs.state import VectorState, checked
from slipgym.envs.vector_options import RowOptions, refuse_scalar
from slipgym.tasks import TASKS, Task
from slipgym.tasks.options import EpisodeOptions


class SlipVectorEnv(gym.vector.VectorEnv[Any, np.ndarray, np.ndarray]):
    """n environments of a task without PyBullet, stepped by one compiled call.

    Environment i is, bit for bit, the scalar environment with `engine="planar"` seeded with seed + i,
    whatever the number of environments and threads.

    Args:
        task: Name of the task, "LinearSlip" for example.
        num_envs: Environments.
        friction_source: As of the scalar environment, like all up to `frame_skip` and `config`.
        estimator: See there.
        contact: See there.
        sensors: See there.
        material: See there.
        action_mode: See there.
        observation_mode: See there.
        history: See there.
        randomization: See there.
        frame_skip: See there.
        autoreset_mode: What happens when an episode ends: "NextStep", "SameStep" or "Disabled" (then
            `reset(options={"reset_mask": ...})` is up to the caller).
        threads: Threads that share the environments; None: as many as processors, if there is work for them.
        render_mode: None, "rgb_array" or "depth_array".
        render_rows: Environments that `render` shows.
        infos: Of which environments a step tells: "all", or "ends": those whose episode ends or begins in it.
        config: See the scalar environment.

    Raises:
        ValueError: The value of an argument is unknown or not allowed.
        TypeError: An argument is unknown.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array", "depth_array"], "render_fps": 120}  # noqa: RUF012

    def __init__(
        self,
        task: str,
        num_envs: int = 1,
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
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
        threads: int | None = None,
        render_mode: str | None = None,
        render_rows: Sequence[int] = (0,),
        infos: str = "all",
        config: str | os.PathLike[str] | Mapping[str, Any] | None = None,
        **others: Any,
    ) -> None:
        refuse_scalar(others, inspect.signature(SlipVectorEnv.__init__).parameters)
        self.task: Task = TASKS[one_of("task", task, TASKS)]
        self.num_envs = whole("num_envs", num_envs, 1)

        def make_simulation(
            config: Config, settings: TaskConfig, task: Task, estimator: Any, randomization: Randomization
        ) -> PlanarSimulation:
            return PlanarSimulation(config, settings, task, estimator, randomization, num_envs, threads)

        setup = Setup(
            self.task,
            make_simulation,
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
        assert isinstance(setup.simulation, PlanarSimulation)
        self.config, self.settings = setup.config, setup.settings
        self._frame_skip, self._material = setup.frame_skip, setup.material
        self.simulation, self._actions, self._observer = setup.simulation, setup.actions, setup.observer
        self.columns, self.privileged_columns = self._observer.columns, self._observer.privileged
        self.action_columns = self._actions.columns
        self.single_action_space, self.single_observation_space = self._actions.space, self._observer.space
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.autoreset_mode = autoreset(autoreset_mode)
        rate = self.config.physics.control_rate / frame_skip
        self.metadata = {**self.metadata, "render_fps": rate, "autoreset_mode": self.autoreset_mode}
        self._made_of = {
            "task": self.task.name,
            **setup.arguments,
            "num_envs": num_envs,
            "autoreset_mode": self.autoreset_mode.value,
        }
        self._shown = {
            "threads": threads,
            "infos": infos,
            "render_mode": render_mode,
            "render_rows": render_rows,
        }
        self._information = Information(self.simulation)
        self.simulation.tells_all = one_of("infos", infos, ("all", "ends")) == "all"
        self._generators = Generators(num_envs)
        self.render_mode = render_mode
        self._pictures = Pictures(self.simulation, render_mode, render_rows)
        self._options = self.task.options.parse(None)
        self._ready = np.zeros(num_envs, dtype=bool)
        self._over = np.zeros(num_envs, dtype=bool)

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Start episodes, of all environments or of those of `options["reset_mask"]`.

        Args:
            seed: Of the first environment, the others count up from it; or one for each.
            options: Episode parameters to fix in all, "rows": a list with more for each environment (None or
                a mapping), "reset_mask": which to reset, (n,) bool.

        Raises:
            ValueError: An option or a seed is not allowed.
            TypeError: The mask is no array of booleans.
            RuntimeError: The environment is closed.
        """
        self.simulation.check_open()
        asked = RowOptions(options, self.num_envs, self.task.options)
        self._generators.seed(seed, asked.mask)
        rows = np.flatnonzero(asked.mask)
        self._ready[rows] = self._over[rows] = False
        self._begin(rows, asked)
        self._observer.again()
        infos = self._information.some(rows)
        return self._observer.read(), self._add_drawn(infos, rows)

    def step(self, actions: np.ndarray) -> tuple[Any, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Act for `frame_skip` slip-velocity samples in every environment.

        Args:
            actions: Within [-1, 1], (n, m).

        Returns:
            Observations, rewards, whether episodes terminated (dropped), whether they were truncated, infos.

        Raises:
            ValueError: The actions have the wrong shape or are not finite.
            RuntimeError: The environment is closed, or one of its environments needs a reset.
            FloatingPointError: A simulation left the finite numbers; the message names the first. All
                environments then need a reset.
        """
        chosen = self._actions.checked_batch(actions, self.num_envs)
        self.simulation.check_open()
        over = self._over
        begins = over if self.autoreset_mode is AutoresetMode.NEXT_STEP else np.zeros_like(over)
        active = self._ready & ~over
        if not (active | begins).all():
            waiting = np.flatnonzero(~(active | begins)).tolist()
            raise RuntimeError(f"call reset() before step(): environments {waiting[:8]} have no episode")
        simulation, rows = self.simulation, np.flatnonzero(begins)
        self._ready, self._over = np.zeros((2, self.num_envs), dtype=bool)
        table, sight, meanwhile = self._actions.table, self._observer.sight, partial(self._begin, rows)
        try:
            simulation.step(chosen, table, self._frame_skip, active, sight, meanwhile)
        except BaseException:
            self._ready.fill(False)  # those that began, too
            raise
        self._ready.fill(True)
        self._observer.next(active)
        rewards, terminated, truncated = simulation.rewards, simulation.terminated, simulation.truncated
        self._pictures.keep(active)
        over = terminated | truncated
        ended: dict[str, Any] = {}
        if self.autoreset_mode is AutoresetMode.SAME_STEP:
            rows = np.flatnonzero(over)
            ended = final(self._observer.present(), self._information.some(rows), rows, self.num_envs)
            self._begin(rows)
        else:
            self._over = over
        if simulation.tells_all:
            infos = self._information.every()
        else:
            infos = self._information.some(np.flatnonzero(over | begins))
        infos = self._add_drawn({**infos, **ended}, rows)
        return self._observer.read(), rewards, terminated, truncated, infos

    def render(self) -> tuple[np.ndarray, ...] | None:
        """Pictures of `render_rows`; None without a render mode.

        Raises:
            RuntimeError: The environment is closed or was never reset.
        """
        self.simulation.check_open()
        return self._pictures.render()

    def get_state(self) -> VectorState:
        """Everything that decides what the environments do next, as plain data.

        Raises:
            RuntimeError: The environment is closed.
        """
        simulation = self.simulation.get_state()
        frames, ready, over = self._observer.get_state(), self._ready.copy(), self._over.copy()
        return VectorState(self._made_of, self._generators.get_state(), simulation, frames, ready, over)

    def set_state(self, state: VectorState) -> None:
        """Go on from a state, bit for bit, also from that of another environment or process.

        Args:
            state: From `get_state` of an environment made with the same arguments; threads and rendering may
                differ.

        Raises:
            TypeError: It is no state.
            ValueError: It is of another kind of environment.
            RuntimeError: This environment is closed.
        """
        checked(state, VectorState).check(self._made_of)
        self.simulation.set_state(state.simulation)
        self._generators.set_state(state.generators)
        self._observer.set_state(state.frames)
        self._ready[:], self._over[:] = state.ready, state.over
        for i in np.flatnonzero(state.ready).tolist():
            self._pictures.begin(i)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickling and copying make a new environment with threads of its own, in the same state."""
        state = None if self.simulation.closed else self.get_state()
        return _rebuild, ({**self._made_of, **self._shown}, state, self.spec)

    def close_extras(self, **_: Any) -> None:
        """End the threads."""
        self.simulation.close()

    def _begin(self, rows: np.ndarray, asked: RowOptions | None = None) -> None:
        """Start episodes; environments before the first whose options contradict each other have started."""
        if asked is not None:
            for i in rows.tolist():
                self._begin_together(np.array([i]), asked.of(i))
        elif rows.size:
            self._begin_together(rows, self._options)

    def _begin_together(self, rows: np.ndarray, options: EpisodeOptions) -> None:
        self.simulation.reset_rows([(i, options, self._generators[i]) for i in rows.tolist()], self._material)
        self._observer.begin(rows)
        for i in rows.tolist():
            self._pictures.begin(i)
        self._ready[rows] = True

    def _add_drawn(self, infos: dict[str, Any], rows: np.ndarray) -> dict[str, Any]:
        """Infos with what the randomization drew for episodes that begin."""
        for i in rows.tolist():
            if drawn := self.simulation.drawn[i]:
                infos = self._add_info(infos, {"drawn": drawn}, i)
        return infos


def _rebuild(arguments: Mapping[str, Any], state: VectorState | None, spec: Any) -> SlipVectorEnv:
    env = SlipVectorEnv(**arguments)
    env.spec = spec
    if state is None:
        env.close()
    else:
        env.set_state(state)
    return env


def __getattr__(name: str) -> partial[SlipVectorEnv]:
    """<task>VectorEnv, for every task there is."""
    task = name.removesuffix("VectorEnv")
    if task not in TASKS or task == name:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return partial(SlipVectorEnv, task)
