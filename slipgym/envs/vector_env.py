"""`SlipVectorEnv`: thousands of environments in one process, on the planar engine."""

from __future__ import annotations

import inspect
import warnings
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any, Unpack

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space

from slipgym.config.base import plain
from slipgym.envs.arguments import VectorArguments, complete, one_of
from slipgym.envs.conventions import Conventions, documented, horizon, rebuilt
from slipgym.envs.observer import Observer
from slipgym.envs.planar_simulation import PlanarSimulation
from slipgym.envs.reset_options import Generators, RowOptions
from slipgym.envs.setup import Setup
from slipgym.envs.states import VectorState, checked
from slipgym.envs.vector_rendering import Pictures
from slipgym.tasks import TASKS, Task


@documented(
    VectorArguments, inspect.Parameter("task", inspect.Parameter.POSITIONAL_OR_KEYWORD, annotation=str)
)
class SlipVectorEnv(Conventions, gym.vector.VectorEnv[Any, np.ndarray, np.ndarray]):
    """A vector environment of a task on the planar engine; one compiled call steps all n environments.

    Environment i equals, bit for bit, the scalar environment with `engine="planar"` seeded with seed + i,
    for any number of environments and threads.

    Args:
        task: Name of the task, "LinearSlip" for example.
        {arguments}

    Raises:
        ValueError: The value of an argument is unknown or not allowed.
        TypeError: An argument is unknown.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array", "depth_array"], "render_fps": 120}  # noqa: RUF012

    def __init__(self, task: str, **arguments: Unpack[VectorArguments]) -> None:
        values = complete(VectorArguments, _without_scalar(plain(arguments)))
        self.task: Task = TASKS[one_of("task", task, TASKS)]
        num_envs, threads, frame_skip = values["num_envs"], values["threads"], values["frame_skip"]
        self.num_envs = num_envs
        setup = Setup(self.task, values, partial(PlanarSimulation, n=num_envs, threads=threads))
        assert isinstance(setup.simulation, PlanarSimulation)
        self._told = self.task.term_names, setup.simulation.estimating
        self.config, self.settings = setup.config, setup.settings
        self._frame_skip, self._material = frame_skip, setup.material
        self.simulation, self._actions, self._observer = setup.simulation, setup.actions, setup.observer
        self.columns, self.privileged_columns = self._observer.columns, self._observer.privileged
        self.action_columns = self._actions.columns
        self.single_action_space, self.single_observation_space = self._actions.space, self._observer.space
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.autoreset_mode = AutoresetMode(values["autoreset_mode"])
        rate = self.config.physics.control_rate / frame_skip
        self.metadata = {**self.metadata, "render_fps": rate, "autoreset_mode": self.autoreset_mode}
        self._limit: int | None = values["max_episode_steps"]
        own = horizon(self.task, self.settings, self.simulation.blank, frame_skip)
        self._horizon = self._limit if own is None or (self._limit or own) < own else own
        self._made_of = {
            "task": self.task.name,
            **setup.arguments,
            "num_envs": num_envs,
            "autoreset_mode": self.autoreset_mode.value,
            "max_episode_steps": self._horizon,
        }
        shown = "threads", "render_mode", "render_rows", "render_size", "max_episode_steps"
        self._shown = {name: values[name] for name in shown}
        self._generators = Generators(num_envs)
        self.render_mode = values["render_mode"]
        shown = values["render_rows"], values["render_size"]
        self._pictures = Pictures(self.simulation, self.render_mode, *shown)
        self._options = self.task.options.parse(None)
        self._ready = np.zeros(num_envs, dtype=bool)
        self._over = np.zeros(num_envs, dtype=bool)
        self._own = frozenset(vars(self))

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Start episodes, of all environments or of those of `options["reset_mask"]`.

        Args:
            seed: Seed of the first environment, where environment i gets seed + i; or a list with a seed for
                each.
            options: Episode parameters to fix in all environments; "rows": a list of further parameters for
                each environment (None or a mapping); "reset_mask": the environments to reset, (n,) bool.

        Raises:
            ValueError: An option or a seed is not allowed.
            TypeError: The mask is not an array of booleans.
            RuntimeError: The environment is closed.
        """
        self.simulation.check_open()
        asked = RowOptions(options, self.num_envs, self.task.options)
        self._generators.seed(plain(seed), asked.mask)
        rows = np.flatnonzero(asked.mask)
        self._ready[rows] = self._over[rows] = False
        self._begin(rows, asked)
        infos = self.simulation.infos.some(rows, *self._told)
        return self._observer.read(), {**infos, **self.simulation.drawn.some(rows)}

    def step(self, actions: np.ndarray) -> tuple[Any, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Act for `frame_skip` control steps in every environment.

        Args:
            actions: Within [-1, 1], (n, m).

        Returns:
            Observations, rewards, whether episodes terminated (dropped), whether they were truncated, infos.

        Raises:
            ValueError: The actions have the wrong shape or are not finite.
            RuntimeError: The environment is closed, or one of its environments needs a reset.
            FloatingPointError: A quantity is not finite; the message names the first one. All environments
                then need a reset.
        """
        chosen = self._actions.checked_batch(actions, self.num_envs)
        self.simulation.check_open()
        over = self._over
        begins = over if self.autoreset_mode is AutoresetMode.NEXT_STEP else np.zeros_like(over)
        active = self._ready & ~over
        if not (active | begins).all():
            waiting = np.flatnonzero(~(active | begins)).tolist()
            raise RuntimeError(f"call reset() before step(): environments {waiting[:8]} have no episode")
        rows = np.flatnonzero(begins)
        self._ready, self._over = np.zeros((2, self.num_envs), dtype=bool)
        try:
            returned = self._advance(chosen, active, rows)
        except BaseException:
            self._ready.fill(False)  # those that began, too
            raise
        self._ready.fill(True)
        return returned

    def _advance(
        self, chosen: np.ndarray, active: np.ndarray, rows: np.ndarray
    ) -> tuple[Any, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Step the active environments, begin episodes of some rows, and return what `step` returns."""
        simulation, table, buffers = self.simulation, self._actions.table, self._observer.buffers
        simulation.step(chosen, table, self._frame_skip, active, buffers, partial(self._begin, rows))
        self._observer.next(active)
        rewards, terminated, truncated = simulation.rewards, simulation.terminated, simulation.truncated
        if self._limit is not None:  # as Gymnasium's TimeLimit, whether or not the episode ends anyway
            last = (self._limit - 1) * self._frame_skip  # an end may cut the last step short
            truncated |= active & (simulation.episode["step"] > last)
        self._pictures.keep(active)
        over = terminated | truncated
        ended: dict[str, Any] = {}
        if self.autoreset_mode is AutoresetMode.SAME_STEP:
            rows = np.flatnonzero(over)
            last = simulation.infos.some(rows, *self._told)
            ended = _final(self._observer, last, rows, self.num_envs)
            self._begin(rows)
        else:
            self._over = over
        infos = simulation.hand_over_infos().every(*self._told)
        infos |= {**ended, **simulation.drawn.some(rows)}
        return self._observer.read(), rewards, terminated, truncated, infos

    def render(self) -> tuple[np.ndarray, ...] | None:
        """Return pictures of `render_rows`; None without a render mode.

        Raises:
            RuntimeError: The environment is closed or was never reset.
        """
        self.simulation.check_open()
        return self._pictures.render()

    def get_state(self) -> VectorState:
        """Return the complete state as plain data; the environments continue from it bit for bit.

        Raises:
            RuntimeError: The environment is closed.
        """
        simulation = self.simulation.get_state()
        frames, ready, over = self._observer.get_state(), self._ready.copy(), self._over.copy()
        return VectorState(self._made_of, self._generators.get_state(), simulation, frames, ready, over)

    def set_state(self, state: VectorState) -> None:
        """Restore a state, bit for bit; it may come from another environment or process.

        Args:
            state: From `get_state` of an environment made with the same arguments; threads and rendering may
                differ.

        Raises:
            TypeError: `state` is not a state.
            ValueError: The state belongs to an environment with other arguments or version, or is damaged;
                nothing changes.
            RuntimeError: This environment is closed.
        """
        checked(state, VectorState).check(self._made_of)
        self.simulation.check_open()
        generators, ready = self._generators.restored(state.generators), state.ready.copy()
        self.simulation.check_state(state.simulation, ready)
        self._ready = np.zeros(self.num_envs, dtype=bool)
        self.simulation.set_state(state.simulation, ready)
        self._generators = generators
        self._observer.set_state(state.frames, ready)
        self._pictures.begin(np.flatnonzero(ready))
        self._over = state.over.copy()
        self._ready = ready

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickling and copying make an independent environment in the same state, see `Conventions`."""
        state = None if self.simulation.closed else self.get_state()
        return rebuilt, (SlipVectorEnv, type(self), {**self._made_of, **self._shown}, state), self._kept()

    def close_extras(self, **_: Any) -> None:
        """End the threads."""
        self.simulation.close()

    def _begin(self, rows: np.ndarray, asked: RowOptions | None = None) -> None:
        """Start episodes; those whose options contradict each other, and the rows after them, do not."""
        groups = [(self._options, rows)] if asked is None else asked.groups(rows)
        for options, some in groups if rows.size else ():
            generators = [self._generators[i] for i in some.tolist()]
            try:
                self.simulation.reset_rows(some, generators, options, self._material)
            except ValueError as error:
                if asked is None or not (where := asked.place(options, some[0])):
                    raise
                raise ValueError(f"{where}{error}") from error
            self._observer.begin(some)
            self._pictures.begin(some)
            self._ready[some] = True


def _final(observer: Observer, infos: dict[str, Any], rows: np.ndarray, n: int) -> dict[str, Any]:
    """Infos that hold the last observations and infos of the rows (m,) whose episodes have finished."""
    if not rows.size:
        return {}
    last, over = np.full(n, None, dtype=object), np.zeros((2, n), dtype=bool)
    for i in rows.tolist():
        last[i] = observer.read(i)
    over[:, rows] = True
    return {"final_obs": last, "_final_obs": over[0], "final_info": infos, "_final_info": over[1]}


def _without_scalar(arguments: Mapping[str, Any]) -> dict[str, Any]:
    """Remove `engine`, which must be "planar" or "auto", and the former argument `infos`.

    A limit of -1 steps is none, as for `gymnasium.make`.

    Raises:
        ValueError: The engine is another one, or the value of `infos` was never allowed.
    """
    given = dict(arguments)
    engine = given.pop("engine", "planar")
    if engine not in ("planar", "auto"):
        raise ValueError(
            f"engine = {engine!r}: the batch runs on the planar engine alone; for PyBullet use "
            'gym.make_vec(..., vectorization_mode="async")'
        )
    if "infos" in given:
        one_of("infos", given.pop("infos"), ("all", "ends"))
        message = "infos is gone: infos of all environments are always returned"
        warnings.warn(message, DeprecationWarning, stacklevel=3)
    if given.get("max_episode_steps") == -1:
        del given["max_episode_steps"]
    return given


def __getattr__(name: str) -> partial[SlipVectorEnv]:
    """Return the class <task>VectorEnv of a registered task."""
    task = name.removesuffix("VectorEnv")
    if task not in TASKS or task == name:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return partial(SlipVectorEnv, task)


def __dir__() -> list[str]:
    return sorted({*globals(), *(f"{task}VectorEnv" for task in TASKS)})
