"""Base of the controllers: columns by name, memory by row, newtons to actions."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar, TypeAlias

import numpy as np

from slipgym.config import Config, Overrides, TaskConfig, load
from slipgym.config.errors import unknown
from slipgym.envs import observation as layout
from slipgym.envs.actions import COMMANDS, PLACES, Actions
from slipgym.envs.load_part import LOAD
from slipgym.tasks import configure, find

State: TypeAlias = np.ndarray | tuple[np.ndarray, ...]
"""A policy's memory: one or several arrays, each with a leading batch axis."""


class ObservationIndex:
    """Places of the columns of an observation.

    Args:
        task_name: As `slipgym.tasks.find` takes it; None for the sensor part that all tasks share.
        config: The environment's configuration.
        action_mode: The environment's, None for the task's own; those that command the wrist observe it.

    Raises:
        ValueError: There is no such task.
    """

    def __init__(self, task_name: str | None, config: Config, action_mode: str | None = None) -> None:
        self.task_name, self.action_mode = task_name, action_mode
        columns = sensors = layout.sensor_columns(config)
        if task_name is not None:
            self.action_mode = action_mode or find(task_name).action_mode
            columns = layout.columns(config, find(task_name), "true", self.action_mode, "deviations")
        names = tuple(column.name for column in columns)
        self._at = {name: k for k, name in enumerate(names)}
        others = [
            {name: k for k, name in enumerate((*(each.name for each in readings), *names[len(sensors) :]))}
            for readings in layout.LAYOUTS.values()
        ]
        self._shortest = min(others, key=len)
        deviations, friction = len(layout.DEVIATION_COLUMNS), len(layout.FRICTION_COLUMNS)
        self._full = len(names) - deviations
        self._fits: dict[int, tuple[int, Mapping[str, int]]] = {}  # length -> without the load part, places
        kinds = [(at, 0) for at in others if len(at) != len(names)]
        for at, more in (*kinds, (self._at, 0), (self._at, len(LOAD))):
            for width in (len(at), len(at) - deviations, len(at) - deviations - friction):
                self._fits.setdefault(width + more, (width, at))

    def __getitem__(self, name: str) -> int:
        if name not in self._at:
            raise ValueError(unknown("observation column", name, self._at))
        return self._at[name]

    def fitted(self, observations: np.ndarray) -> tuple[np.ndarray, Mapping[str, int]]:
        """Observations (n, m) without the load part, and where each column is: the length shows the sensors.

        No two kinds of sensors give a task observations of the same length.

        Raises:
            ValueError: No observation of the task, or of its action mode, has this length.
        """
        width, full, longest = observations.shape[1], self._full, len(self._at)
        if self.task_name is None:
            if width < len(self._shortest):
                raise ValueError(
                    f"observation has {width} columns; every task has at least {len(self._shortest)}"
                )
            return observations, self._at if width >= longest else self._shortest
        if width not in self._fits:
            raise ValueError(
                f"observation has {width} columns; {self.task_name} has {full}, "
                f"{full - len(layout.FRICTION_COLUMNS)} without friction, or {longest} with deviations, "
                f"with action_mode={self.action_mode!r} and history=0"
            )
        kept, at = self._fits[width]
        return observations[:, :kept], at


_WHOLE = {
    "f_x": ("wrist_f_x", 0.5),
    "f_y": ("wrist_f_y", 0.5),
    "tau": ("wrist_tau", 0.0),  # the lever from wrist to pad makes noise of it, as large as what pads hold
    "f_n": ("motor_force", 1.0),
}
"""Column of a finger -> the gripper's, and the part of it that stands for one finger."""


class Columns:
    """A batch of observations whose columns are read by name.

    Args:
        observations: (n, m).
        index: Where each column is.
        needs_slip: Whether columns of the slip are errors where no sensor measures it; otherwise they are 0.

    Raises:
        ValueError: m does not fit the index.
    """

    def __init__(self, observations: np.ndarray, index: ObservationIndex, needs_slip: bool = True) -> None:
        self._observations, self._at = index.fitted(observations)
        self._needs_slip = needs_slip

    def __len__(self) -> int:
        return len(self._observations)

    def __getitem__(self, name: str) -> np.ndarray:
        """One column, (n,) float64.

        Raises:
            ValueError: The task has no such column, or the environment leaves the friction part out.
        """
        at = self._at.get(name)
        if at is None:
            return self._unmeasured(name)
        if at >= self._observations.shape[1]:
            raise ValueError(
                f"the policy needs the column {name!r}, which friction_source='none' and "
                "observation_mode='sensor' leave out, as estimator=None does with 'estimated'; "
                "choose friction_source 'estimated', 'true' or 'nominal' and observation_mode 'flat'"
            )
        return self._observations[:, at].astype(np.float64)

    def __contains__(self, name: str) -> bool:
        """Whether the environment shows a column of the task."""
        return self._at.get(name, np.inf) < self._observations.shape[1]

    def _unmeasured(self, name: str) -> np.ndarray:
        """A column that these sensors do not have: from those of wrist and motor, or 0, (n,) float64.

        Raises:
            ValueError: Nothing stands for it, or the task has no such column.
        """
        stem = name.rpartition("_")[0]
        whole, part = _WHOLE.get(stem, ("", 0.0))
        if whole in self._at:
            return part * self[whole]
        slip = stem in ("v_x", "v_y", "omega", "measured_slip")
        if not slip and stem not in _WHOLE:
            raise ValueError(unknown("observation column", name, self._at))
        if slip and not self._needs_slip:
            return np.zeros(len(self))
        what = "the slip" if slip else "forces along the pad"
        raise ValueError(
            f"the policy needs {what} ({name!r}), which these sensors do not measure; make the environment "
            "with sensors='realistic', 'lab', 'ideal' or 'markers'"
        )


class ForcePolicy(ABC):
    """A controller that computes a grip force from the present observation and its memory.

    Subclasses name their task and implement `control`, and `initial_state` if they have a memory. One that
    commands the wrist as well, or steps of force, names the action mode of the environments it acts in. The
    object itself never changes: all memory travels in the state, so one policy serves many episodes.

    Args:
        config: Overrides of the environment's configuration: a mapping or the path of a YAML file.

    Raises:
        ValueError: The configuration is not valid.
    """

    task: ClassVar[str | None] = None
    """Task whose observations it reads; None for one that runs in every task."""
    action_mode: ClassVar[str] = "grip_force"
    """Action mode of the environments it acts in, one of `slipgym.envs.actions.ACTION_MODES`."""
    acts_on_friction: ClassVar[bool] = False
    """Whether it cannot act without the friction part of the observation."""
    needs_slip: ClassVar[bool] = True
    """Whether it cannot act without a sensor of slip."""
    without_friction: ClassVar[Mapping[str, Any]] = {}
    """Arguments of the controller without friction information (`policies.controllers.no_friction_info`)."""

    def __init__(self, config: Overrides | None = None) -> None:
        self.settings: TaskConfig | None = None
        """The task's settings; None without a task."""
        if self.task is None:
            self.config = load(config)
        else:
            self.config, self.settings = configure(find(self.task), config)
        speed = None if self.settings is None else self.settings.wrist_speed
        self.index = ObservationIndex(self.task, self.config, self.action_mode)
        self._components = Actions(self.action_mode, self.config, speed).table

    @abstractmethod
    def control(self, columns: Columns, state: State) -> tuple[np.ndarray, State]:
        """Grip force per finger for each row, and the wrist's velocity where the policy commands it.

        Args:
            columns: n observations.
            state: Memory of n rows; must not be changed in place.

        Returns:
            Force (n,) [N], or force and wrist velocity along x, along z and in pitch (n, 4) [N, m/s, m/s,
            rad/s], or these and a guess of friction as `slipgym.envs.actions.GUESS` (n, 10); the caller clips
            them to the action's range. And the new memory.
        """

    def initial_state(self, n: int) -> State:
        """Memory of n rows at the start of an episode; by default there is none, (n, 0)."""
        return np.zeros((n, 0))

    def predict(
        self,
        observation: np.ndarray,
        state: State | None = None,
        episode_start: np.ndarray | None = None,
        deterministic: bool = True,
    ) -> tuple[np.ndarray, State]:
        """Action for an observation (m,) or for a batch of them (n, m); arguments as in `policies.Policy`.

        `deterministic` is without effect: controllers do not explore.

        Returns:
            Action (m,) or (n, m), float32 within [-1, 1], m = 1 unless the policy commands the wrist, and
            the memory, whose arrays always have a leading axis of n (of 1 for a single observation).

        Raises:
            ValueError: The observation, the memory or `episode_start` does not fit.
        """
        if isinstance(observation, Mapping):
            raise ValueError(
                f"observation has the groups {', '.join(observation)}; the policy reads one array: pass the "
                "group 'policy', or make the environment with observation_mode='flat'"
            )
        observations = np.asarray(observation)
        if observations.ndim not in (1, 2):
            raise ValueError(f"observation must have shape (m,) or (n, m), got {observations.shape}")
        columns = Columns(np.atleast_2d(observations), self.index, self.needs_slip)
        returned = self.control(columns, self._memory(state, episode_start, len(columns)))
        pair = isinstance(returned, tuple) and len(returned) == 2
        if not pair or np.shape(returned[0])[:1] != (len(columns),) or np.iscomplexobj(returned[0]):
            raise ValueError(
                f"{type(self).__name__}.control must return the commands of {len(columns)} rows and the "
                f"memory, real numbers, got {returned!r:.80}"
            )
        commands, state = returned
        actions = self._action(np.asarray(commands), columns)
        return (actions if observations.ndim == 2 else actions[0]), state

    def _memory(self, state: State | None, episode_start: np.ndarray | None, n: int) -> State:
        """The memory to act on: fresh where an episode begins."""
        fresh = self.initial_state(n)
        if state is None:
            return fresh
        old, new = _arrays(state), _arrays(fresh)
        if [a.shape for a in old] != [a.shape for a in new]:
            raise ValueError(
                f"state has shapes {[a.shape for a in old]}, {n} observations need {[a.shape for a in new]}"
            )
        if episode_start is None:
            return state
        rows = np.atleast_1d(np.asarray(episode_start, dtype=bool))
        if rows.shape != (n,):
            raise ValueError(f"episode_start must have shape ({n},), got {rows.shape}")
        merged = tuple(
            np.where(rows.reshape(-1, *[1] * (a.ndim - 1)), b, a) for a, b in zip(old, new, strict=True)
        )
        return merged if isinstance(state, tuple) else merged[0]

    def _action(self, commands: np.ndarray, columns: Columns) -> np.ndarray:
        """What `control` returned to actions (n, m), clipped to [-1, 1]."""
        n, table, own = len(columns), self._components, len(COMMANDS)
        given = commands.reshape(n, -1)
        wanted = np.zeros((n, len(PLACES)))
        wanted[:, : min(given.shape[1], own)] = given[:, :own]
        wanted[:, own + 1 :][:, : max(given.shape[1] - own, 0)] = given[:, own:]
        if own in table["command"]:
            wanted[:, own] = given[:, 0] - columns["commanded_force"]
        wanted[:, -1] = np.log(np.maximum(given[:, 0], 1e-6))  # ln_grip_force
        low, high = table["low"], table["high"]
        scaled = 2.0 * (wanted[:, table["command"]] - low) / (high - low) - 1.0
        return np.clip(scaled, -1.0, 1.0).astype(np.float32)


def _arrays(state: State) -> tuple[np.ndarray, ...]:
    return state if isinstance(state, tuple) else (state,)
