"""Lets a policy command a real gripper from live estimates, and holds firmly when data stop."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

import policies
from estimator.estimate import ESTIMATE
from estimator.live import Live, Output
from estimator.live.live import shown
from estimator.sample import LARGEST
from policies.learned import LearnedPolicy
from slipgym.config.errors import unknown
from slipgym.envs import observation as layout
from slipgym.envs.actions import COMMANDS, COMPONENT, PLACES, Actions, interpret
from slipgym.envs.load_part import LOAD
from slipgym.envs.sensor_part import LAYOUTS, layout_of
from slipgym.sensors.markers import MARKERS
from slipgym.sensors.owned import GRIPPER
from slipgym.sensors.slip_velocity import SLIP_SENSOR
from slipgym.tasks import configure, find
from slipgym.tasks.episode import EPISODE
from slipgym.world.records import WORLD

AGAIN = 0.05
"""Time after which the firm command is repeated [s]."""


class PolicyPilot:
    """Turns the newest readings and estimates into the observation of an environment, and acts.

    One step of the policy follows when each finger has a new estimate. Until the first, and when a sensor or
    the estimates are silent for `timeout`, or the policy fails, the command is the firm grip; afterwards the
    policy begins anew.

    Args:
        policy: As `policies.load` takes it.
        live: The core that it acts on.
        task: For a controller of every task: whose observations it gets.
        columns: Observation columns that no sensor reads, by name; those of the wrist and `violated` are 0.
        firm: The firm grip [N]; None: the largest of the action.
        timeout: Longest silence [s].
        **parameters: Of the policy.

    Raises:
        FileNotFoundError: There is no such policy.
        ValueError: An argument is not valid, the policy acts at another rate, or it reads a column that is
            not given.
    """

    def __init__(
        self, policy: str, live: Live, task: str | None = None, columns: Mapping[str, Any] | None = None,
        firm: float | None = None, timeout: float = 0.1, **parameters: Any,
    ) -> None:  # fmt: skip
        self.policy = policies.load(policy, **parameters)
        self._live, self._timeout = live, timeout
        self._layout(task or getattr(self.policy, "task", None) or "Hold")
        gripper = self._config.gripper
        self._firm = gripper.force_max if firm is None else firm
        if not gripper.force_min <= self._firm <= gripper.force_limit:
            raise ValueError(f"firm = {firm!r} N: expected {gripper.force_min} to {gripper.force_limit}")
        if not 2.0 / self._rate <= timeout <= 10.0:
            raise ValueError(
                f"timeout = {timeout!r} s: expected {2.0 / self._rate:.3g} to 10 (--timeout), two steps or "
                f"more of the policy, which acts at {self._rate:g} Hz"
            )
        every = live.rates[1] / self._rate
        self._every = round(every)
        if self._every < 1 or abs(every - self._every) > 0.02:
            valid = ", ".join(f"{k * self._rate:g}" for k in (1, 2, 3, 4))
            raise ValueError(
                f"the policy acts at {self._rate:g} Hz: velocities must come at that rate or a multiple "
                f"({valid}, ... Hz), not at {live.rates[1]:g} Hz (--velocity-rate)"
            )
        self._episode = np.zeros(1, EPISODE)
        for name in ("force_min", "force_max", "pad_radius"):
            self._episode[name] = getattr(gripper, name)
        self._worlds, self._slip = np.zeros(1, WORLD), np.zeros((1, 2), SLIP_SENSOR)
        self._wrench, self._twist = np.zeros((1, 2, 4)), np.zeros((1, 2, 3))
        self._estimates, self._t = np.zeros(2, ESTIMATE), np.full(2, np.nan)
        self._given = {name: 0.0 if name.startswith("wrist") or name == "violated" else math.nan
                       for name in self._own}  # fmt: skip
        self.set_columns(columns or {})
        self._begin("no data yet")
        self._acted, self._said = -math.inf, -math.inf
        self._try()

    def _layout(self, task_name: str) -> None:
        """What the policy reads and gives."""
        policy = self.policy
        trained = policy.description.environment if isinstance(policy, LearnedPolicy) else None
        read = policy.names if isinstance(policy, LearnedPolicy) else None
        task = find(trained.id if trained else task_name)
        arguments = dict(trained.arguments) if trained else policies.modes(policy)
        preset = str(arguments.get("sensors") or "realistic")
        self._config, settings = configure(task, arguments.get("config"), preset)  # type: ignore[arg-type]
        mode = str(arguments.get("action_mode") or task.action_mode)
        observed = str(arguments.get("observation_mode") or ("flat" if trained else "deviations"))
        self._history = trained.history if trained else 0
        self._rate = trained.rate if trained else self._config.physics.control_rate
        loaded = bool(arguments.get("load_columns", False))
        source = "true" if read is None or "mu_c" in read else "none"
        self._columns = layout.columns(self._config, task, source, mode, observed, loaded)
        self._names = [column.name for column in self._columns]
        if (kind := layout_of(self._config)) != "fingers":
            own = [each.name for each in LAYOUTS[kind] if each not in layout.SENSORS]
            raise ValueError(
                f"the policy reads {', '.join(own[:6])}{', ...' * (len(own) > 6)}, of the sensors {kind!r}; "
                "live takes readings of sensors in the fingers alone"
            )
        if read is not None and tuple(self._names) != read:
            odd = sorted(set(read) ^ set(self._names)) or ["their order"]
            raise ValueError(
                "the policy was trained in another version of the environment's observation, which differs "
                f"in {', '.join(odd)}"
            )
        wrist = np.array(layout.wrist_part(task, mode), np.int64)
        sensors = len(layout.SENSORS)
        self._own = self._names[sensors : sensors + len(task.columns) + len(wrist)]
        low, high = (
            np.array([getattr(c, end) for c in self._columns], np.float32) for end in ("low", "high")
        )
        self._bounds = wrist, low, high, np.arange(len(LOAD) if loaded else 0)
        self._task_part = np.zeros((1, len(task.columns)))
        self._table = Actions(mode, self._config, settings.wrist_speed).table
        if trained:
            rows = [(PLACES.index(each.name), each.low, each.high) for each in trained.action]
            self._table = np.array(rows, COMPONENT)
        given = {PLACES[k] for k in self._table["command"]}
        self._commands = [name for name in COMMANDS if name == "grip_force" or name in given]

    def set_columns(self, values: Mapping[str, Any]) -> None:
        """Takes what no sensor reads: the observation's columns of task and wrist.

        Raises:
            ValueError: A name is unknown, or a value is no number.
        """
        for name, value in values.items():
            if name not in self._given:
                raise ValueError(unknown("observation column", name, self._given))
            number = isinstance(value, int | float) and not isinstance(value, bool)
            if not number or not abs(value) < LARGEST:
                raise ValueError(f"column {name} = {shown(value)}: expected a finite number")
        self._given.update(values)

    def _begin(self, why: str) -> None:
        """A new episode, in a firm grip."""
        self._why, self._state, self._frames, self._steps = why, None, [], 0
        self._new = set()
        self._given.update({name: 0.0 for name in self._commands if name in self._given})
        self._slip["measured_slip"] = 0.0
        self._episode["command"] = max(self._firm, float(self._episode["command"][0]))

    def _try(self) -> None:
        """Acts once on zeros, to refuse a policy that reads what nobody gives."""
        self._estimates["mu_s"], self._estimates["mu_c"], self._estimates["r"] = 0.5, 0.4, 0.01
        lacking = ", ".join(name for name, value in self._given.items() if math.isnan(value))
        try:
            commands = self._step()
        except ValueError as error:
            raise ValueError(f"{error}; give it, of the columns {lacking}") from error
        if not np.isfinite(commands).all():
            raise ValueError(f"the policy reads a column that nobody gives: {lacking}")
        self._state, self._frames = None, []
        self._estimates[:] = np.zeros((), ESTIMATE)

    def act(self, outputs: list[Output], now: float) -> dict[str, Any] | None:
        """The command after new estimates; None: none is due."""
        for output in outputs:
            self._take(output)
        if len(self._new) < self._live.fingers or self._live.silent(now, self._timeout):
            return None
        self._new.clear()
        self._steps += 1
        if (self._steps - 1) % self._every:
            return None
        try:
            commands = self._step()
        except Exception as error:  # whatever a policy of somebody else does, the object must not fall
            return self._hold(f"the policy failed: {error}", now)
        if not np.isfinite(commands).all():
            return self._hold("the policy gave no number", now)
        self._episode["last_command"], self._episode["command"] = self._episode["command"], commands[0]
        self._acted, self._why = now, ""
        command = self._command(outputs[-1].t, commands)
        self._given.update({name: value for name, value in command.items() if name in self._given})
        return command

    def watch(self, live: Live, now: float) -> dict[str, Any] | None:
        """The command that is due without new data; None: none is."""
        silent = live.silent(now, self._timeout)
        if not silent and now - self._acted <= self._timeout:
            return None
        if self._why and now - self._said < AGAIN:
            return None
        return self._hold(f"silent: {', '.join(silent)}" if silent else "no estimates", now)

    def _hold(self, why: str, now: float) -> dict[str, Any]:
        self._begin(why)
        self._said, self._acted = now, -math.inf
        return self._command(None, np.array([self._episode["command"][0], 0.0, 0.0, 0.0]))

    def _command(self, t: float | None, commands: np.ndarray) -> dict[str, Any]:
        status = f"firm: {self._why}" if self._why else "ok"
        values: dict[str, float] = dict(zip(COMMANDS, commands.tolist(), strict=True))
        return {"command": 1, "t": t, "status": status} | {name: values[name] for name in self._commands}

    def _take(self, output: Output) -> None:
        k = output.finger - 1
        rows = [k] if self._live.fingers == 2 else [0, 1]  # one finger stands for both
        self._wrench[0, rows], self._twist[0, rows] = output.wrench, output.twist
        self._estimates[rows] = np.array(tuple(output.estimate), ESTIMATE)
        apart = output.t - self._t[k]
        if apart < self._timeout:
            self._slip["measured_slip"][0, rows] += np.multiply(output.twist, apart)
        self._t[k] = output.t
        self._new.add(k)

    def _step(self) -> np.ndarray:
        """Grip force [N] and velocity of the wrist, (4,)."""
        wrist, low, high, load = self._bounds
        out = np.zeros((1, len(self._names)), np.float32)
        friction = np.zeros((1, len(layout.FRICTION) + len(layout.DEVIATIONS)))
        layout.combine(self._estimates, np.zeros((1, 2, 3)), friction)
        layout.observe(
            self._wrench, self._twist, self._slip, self._episode, np.zeros(1, GRIPPER),
            np.zeros((0, 2), MARKERS), self._task_part, self._worlds, wrist, friction, low, high, load, out,
            np.zeros(0, np.int64),
        )  # fmt: skip
        at = len(layout.SENSORS)
        given = np.array(list(self._given.values()))
        out[0, at : at + len(given)] = np.clip(given, low[at : at + len(given)], high[at : at + len(given)])
        self._frames = [*(self._frames or [out[0]] * (self._history + 1))[1:], out[0]]
        action, self._state = self.policy.predict(np.concatenate(self._frames), self._state)
        commands = np.full((1, len(COMMANDS)), np.nan)
        if np.isfinite(action).all():
            commands[:] = 0.0
            interpret(np.atleast_2d(np.asarray(action, np.float64)), self._table, self._episode, commands)
        return commands[0]
