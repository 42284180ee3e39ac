"""Plays episodes of one environment, while changes arrive from another thread."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping
from queue import SimpleQueue
from typing import Any

import numpy as np

import policies
from policies.play.viewer import interventions
from policies.play.watch import Outcome, environment
from policies.stepping import own_arguments
from policies.task_names import own_policy
from slipgym.config.errors import unknown
from slipgym.config.load import load_randomization, merge, read_overrides
from slipgym.rendering.history import History
from slipgym.tasks import find

LIVE = ("grip_force", "mu_c", "mass")
"""Values [N per finger, -, kg] that act from the next control step on, and stay set in later episodes."""
NEXT_EPISODE = ("policy", "latency")
"""Values that begin with the next episode: a policy's name, the latency of the slip sensors [samples]."""
_HELD = {"mu_c": interventions.set_friction, "mass": interventions.set_mass}
"""How a value is set in an episode, in place of a change that the episode would make itself."""
_GRIPS = "grip_force", "force_increment", "ln_grip_force"
"""Components of an action that command the grip; each action mode has one."""
_LONGEST = 0.1  # [s] of simulation that one call makes up for


class Refused(ValueError):
    """A change is not allowed; the episode goes on without it."""


class Session:
    """An environment with the policy that acts in it, episode after episode.

    `submit`, `poke`, `refuse` and `request_restart` may be called from any thread; everything else belongs to
    the thread that calls `advance`. Arguments and errors are those of `open_viewer`.

    Attributes:
        env: The environment.
        info: Its last info.
        history: What the plots show of the episode.
        values: Values that were set, by the names in `LIVE` and `NEXT_EPISODE`.
        pending: Names of those that wait for the next episode.
        policy: Name of the policy that acts.
        seed: Of the episode.
        outcome: How the episode ended; None while it runs.
        keywords: Of the environment, in place of those that the policy has.
        failed: Whether an error ended the episode; `restart` begins the next one.
        finished: How the episodes so far ended, in their order.
    """

    def __init__(
        self,
        task: str,
        policy: str | os.PathLike[str] | None = None,
        seed: int = 0,
        options: Mapping[str, Any] | None = None,
        **keywords: Any,
    ) -> None:
        self.task = find(task)
        self.seed = seed - 1
        self.policy = os.fspath(policy or own_policy(task))
        self.values: dict[str, Any] = {}
        self.pending: set[str] = set()
        self.finished: list[Outcome] = []
        self.env: Any = None
        self.failed = False
        self._options, self.keywords = dict(options or {}), keywords
        self._changes: SimpleQueue[Callable[[], None]] = SimpleQueue()
        self._ratio = 1.0
        self._make()
        self.restart()

    def submit(self, name: str, value: Any) -> None:
        """Set a value of `LIVE` or `NEXT_EPISODE`; None gives it back to the episode.

        Raises:
            ValueError: There is no value of this name.
        """
        if name not in LIVE + NEXT_EPISODE:
            raise ValueError(unknown("value", name, LIVE + NEXT_EPISODE))
        self._changes.put(lambda: self._set(name, value))

    def poke(self, direction: str, impulse: float) -> None:
        """Push or turn the object from the next control step on, see `interventions.poke`."""
        self._changes.put(lambda: interventions.poke(self._episode, direction, impulse))

    def refuse(self, words: str) -> None:
        """Let the next `advance` raise `Refused` with a message."""
        self._changes.put(lambda: self._refused(words))

    def request_restart(self) -> None:
        """Begin the next episode before the next control step."""
        self._changes.put(self.restart)

    def advance(self, seconds: float) -> int:
        """Apply the changes and make the control steps of a stretch of simulated time, of at most 0.1 s.

        Returns:
            Number of steps; fewer than the time asks for if the episode ended.

        Raises:
            Refused: A change is not allowed; those after it wait for the next call.
            Exception: Whatever the policy or the environment raises; see `give_up`.
        """
        while not self._changes.empty():
            try:
                self._changes.get()()
            except (ValueError, OSError, ImportError) as error:
                raise Refused(str(error)) from error
        self._left = min(self._left + seconds, _LONGEST)
        steps, step_time = 0, 1.0 / self.env.metadata["render_fps"]
        while self.outcome is None and not self.failed and self._left >= step_time * (1.0 - 1e-9):
            self._left -= step_time
            self._step()
            steps += 1
        return steps

    def restart(self) -> None:
        """Begin the next episode, with all values that are set."""
        if self.pending:
            self._make()
        self.seed += 1
        options = dict(self._options)
        if "mass" in self.values:
            options["object_mass"] = self.values["mass"]
        if "mu_c" in self.values:
            options["mu_c"], options["mu_s"] = self.values["mu_c"], self._ratio * self.values["mu_c"]
        self._observation, self.info = self.env.reset(seed=self.seed, options=options)
        for name in self.values.keys() & _HELD.keys():
            _HELD[name](self._episode, self.values[name])
        self._memory, self.outcome, self._reward, self._left = None, None, 0.0, 0.0
        self._ratio = float(self._episode["mu_s"] / self._episode["mu_c"])
        self.history = History(self.env.simulation, 0, self.task.motion)
        self.failed = False

    def give_up(self) -> None:
        """End the episode after an error; the next one begins without the values that act at once."""
        self.failed = True
        for name in LIVE:
            self.values.pop(name, None)

    def close(self) -> None:
        """Close the environment."""
        self.env.close()

    @property
    def _episode(self) -> np.void:
        return self.env.simulation.episode[0]

    @staticmethod
    def _refused(words: str) -> None:
        raise Refused(words)

    def _set(self, name: str, value: Any) -> None:
        if value is None:
            if self.values.pop(name, None) is None:
                return
        else:
            if name == "policy":
                if not isinstance(value, str | os.PathLike):
                    raise ValueError(f"policy = {value!r} must be a name or a path")
            elif name in _HELD:
                _HELD[name](self._episode, value)
            elif name == "grip_force":
                interventions.checked(name, value)
            self.values[name] = value
        if name in NEXT_EPISODE:
            self.pending.add(name)

    def _step(self) -> None:
        action, self._memory = self._player.predict(self._observation, state=self._memory)
        if "grip_force" in self.values:
            action = np.array(action, dtype=np.float32)
            action[self._grip] = self._grip_action(self.values["grip_force"])
        self._observation, reward, terminated, truncated, self.info = self.env.step(action)
        self._reward += float(reward)
        self.history.keep()
        if terminated or truncated:
            self.outcome = Outcome.of(self.seed, self.info, self._reward)
            self.finished.append(self.outcome)

    def _grip_action(self, force: float) -> float:
        """Component of an action that commands a grip force per finger [N], or goes towards it."""
        column = self.env.action_columns[self._grip]
        value = force - float(self._episode["command"]) if column.name == "force_increment" else force
        value = math.log(force) if column.name == "ln_grip_force" else value
        return min(max(2.0 * (value - column.low) / (column.high - column.low) - 1.0, -1.0), 1.0)

    def _make(self) -> None:
        """Make policy and environment from the values that are set; on an error the old ones stay."""
        name = os.fspath(self.values.get("policy", self.policy))
        try:
            policy = policies.load(name)
            keywords = own_arguments(policy, self.task.id, self.keywords)
            if "latency" in self.values:
                given = keywords.get("config")
                overrides = {"sensors": {"slip": {"latency_samples": self.values["latency"]}}}
                keywords["config"] = merge({} if given is None else read_overrides(given)[1], overrides)
                drawn = load_randomization(keywords.get("randomization", "none")).of(self.task.key)
                ranges = drawn.model_dump(mode="json", exclude_defaults=True)
                keywords["randomization"] = {**ranges, "slip_latency": None}
            env = environment(self.task.id, name, policy, keywords)
        except Exception:
            for each in self.pending:
                self.values.pop(each, None)
            raise
        finally:
            self.pending.clear()
        if self.env is not None:
            self.env.close()
        self.env, self.policy, self._player = env, name, policy
        names = [column.name for column in env.action_columns]
        self._grip = next(names.index(name) for name in _GRIPS if name in names)
