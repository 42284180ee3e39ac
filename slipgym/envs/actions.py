"""Actions: their components, their space, and the commands that they are turned into."""

from __future__ import annotations

import math
from typing import Any

import gymnasium as gym
import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.config import Config
from slipgym.tasks.task import Column

COMMANDS = ("grip_force", "wrist_velocity_x", "wrist_velocity_z", "wrist_pitch_rate")
"""Commands to gripper and wrist in a control step."""
_INCREMENT = len(COMMANDS)
GUESS = ("ln_mu_s", "ln_mu_c", "ln_r", "ln_sd_mu_s", "ln_sd_mu_c", "ln_sd_r")
"""What an agent states about friction: logarithms of `mu_s`, `mu_c`, `r` and of their relative deviations."""
_LINEAR = {
    "grip_force": COMMANDS[:1],
    "grip_force_pitch": ("grip_force", "wrist_pitch_rate"),
    "grip_force_translation": COMMANDS[:3],
    "grip_force_wrist": COMMANDS,
    "grip_force_wrist_guess": (*COMMANDS, *GUESS),
}
LOGARITHMIC = "log_"
"""Begins the name of a mode that has `ln_grip_force` in place of `grip_force`."""
ACTION_MODES = {
    **_LINEAR,
    "force_increment": ("force_increment",),
    **{LOGARITHMIC + mode: ("ln_grip_force", *names[1:]) for mode, names in _LINEAR.items()},
}
"""Mode -> names of an action's components, in order."""

PLACES = (*COMMANDS, "force_increment", *GUESS, "ln_grip_force")
"""Components by their place in `COMPONENT.command`."""
_LOGARITHM = len(PLACES) - 1
GUESSED_FRICTION, GUESSED_DEVIATION = (0.05, 2.0), (0.01, 1.0)
"""Ranges of a guess: friction coefficients and relative standard deviations."""
GUESSED_RADIUS = 0.1
"""Smallest radius of a guess over that of the pads."""

COMPONENT = np.dtype(
    [
        ("command", "i8"),  # place in PLACES
        ("low", "f8"),  # what -1 stands for [N, m/s, rad/s, or a logarithm]
        ("high", "f8"),  # what +1 stands for
    ]
)
"""One component of an action."""


def components(mode: str, config: Config, wrist_speed: float | None = None) -> tuple[Column, ...]:
    """Components of an action: their names and the values of -1 and +1.

    Args:
        mode: One of `ACTION_MODES`.
        config: The environment's configuration.
        wrist_speed: The task's own largest speed of the wrist; None: the gripper's [m/s].
    """
    gripper = config.gripper
    speed = gripper.wrist_speed_max if wrist_speed is None else wrist_speed
    rate, step = gripper.wrist_pitch_rate_max, gripper.force_step
    least, most = math.log(gripper.force_min), math.log(gripper.force_max)
    table = (
        Column("grip_force", gripper.force_min, gripper.force_max, "N", "grip force of either finger"),
        Column("wrist_velocity_x", -speed, speed, "m/s", "wrist velocity along world x"),
        Column("wrist_velocity_z", -speed, speed, "m/s", "wrist velocity along world z"),
        Column("wrist_pitch_rate", -rate, rate, "rad/s", "pitch rate of the wrist"),
        Column("force_increment", -step, step, "N", "change of the commanded grip force per control step"),
        Column("ln_grip_force", least, most, "-", "logarithm of the grip force of either finger in newtons"),
    )
    rows = {column.name: column for column in (*table, *_guess(gripper.pad_radius))}
    return tuple(rows[name] for name in ACTION_MODES[mode])


def _guess(pad_radius: float) -> tuple[Column, ...]:
    """Components of a guess of friction, on pads of a radius [m]."""
    rows = (
        ("mu_s", "static friction", GUESSED_FRICTION),
        ("mu_c", "Coulomb friction", GUESSED_FRICTION),
        ("r", "contact radius in metres", (GUESSED_RADIUS * pad_radius, pad_radius)),
    )
    named = [(f"ln_{name}", f"the {meaning}", ends) for name, meaning, ends in rows]
    for name, *_ in rows:
        named.append((f"ln_sd_{name}", f"the relative standard deviation of {name}", GUESSED_DEVIATION))
    return tuple(
        Column(name, math.log(low), math.log(high), "-", f"logarithm of {what}, as guessed")
        for name, what, (low, high) in named
    )


class Actions:
    """The action space of a mode, and its `components` as the table from which actions are interpreted.

    Attributes:
        columns: Components of an action, with the range that [-1, 1] stands for.
        table: The same as COMPONENT (m,), for `interpret`.
        space: Box(-1, 1, (m,), float32).
    """

    def __init__(self, mode: str, config: Config, wrist_speed: float | None = None) -> None:
        self.mode = mode
        self.columns = components(mode, config, wrist_speed)
        rows = [(PLACES.index(column.name), column.low, column.high) for column in self.columns]
        self.table = np.array(rows, COMPONENT)
        self._shape = (len(rows),)
        self._batch = np.zeros((1, len(rows)))
        self.space = gym.spaces.Box(-1.0, 1.0, self._shape, dtype=np.float32)

    def checked(self, action: Any) -> np.ndarray:
        """An action as a batch of one, (1, m) float64: always the same array, which the next call overwrites.

        Raises:
            ValueError: It is not numeric, has the wrong shape or is not finite; the message names the
                component.
        """
        usual = type(action) is np.ndarray and action.dtype.kind == "f"  # without another call
        array = action if usual else _real(action, "action")
        if array.shape != self._shape:
            raise self._misshapen("action", self._shape, f"{array.shape}: {action!r}")
        batch = self._batch
        for k, value in enumerate(array.tolist()):
            batch[0, k] = value
            if not math.isfinite(value):
                raise self._not_finite(f"action[{k}]", k, float(value))
        return batch

    def checked_batch(self, actions: Any, n: int) -> np.ndarray:
        """Actions of n environments, (n, m) float64.

        Raises:
            ValueError: They are not numeric, have the wrong shape or are not finite; the message names the
                first.
        """
        array = np.ascontiguousarray(numbers(actions, "actions"))
        if array.shape != (n, *self._shape):
            raise self._misshapen("actions", (n, *self._shape), array.shape)
        if not np.isfinite(array).all():
            i, k = np.argwhere(~np.isfinite(array))[0].tolist()
            raise self._not_finite(f"actions[{i}, {k}]", k, array[i, k])
        return array

    def _misshapen(self, name: str, shape: tuple[int, ...], got: object) -> ValueError:
        meaning = ", ".join(column.name for column in self.columns)
        return ValueError(
            f"{name} must have shape {shape} in action_mode {self.mode!r} ({meaning}), got {got}"
        )

    def _not_finite(self, place: str, k: int, value: object) -> ValueError:
        return ValueError(f"{place} ({self.columns[k].name}) = {value} must be finite, within [-1, 1]")


def numbers(given: Any, name: str) -> np.ndarray:
    """Real numbers as an array of float64.

    Args:
        given: An array, a number or nested sequences of numbers.
        name: Its name, for messages.

    Raises:
        ValueError: It is something else: complex, text, a time, masked, an integer beyond 64 bits.
    """
    return _real(given, name).astype(np.float64, order="C", copy=False)


def _real(given: Any, name: str) -> np.ndarray:
    """`numbers` of any real type."""
    array = given
    if type(given) is not np.ndarray:
        try:
            array = np.asarray(given)
        except (TypeError, ValueError, OverflowError) as error:
            raise ValueError(f"{name} must be an array of numbers, within [-1, 1]") from error
        if isinstance(given, np.ma.MaskedArray):
            raise ValueError(f"{name} must be an array without a mask; fill the masked values in")
    if array.dtype.kind not in "fiub":
        raise ValueError(
            f"{name} = {given!r:.80} must be an array of numbers, within [-1, 1], not of {array.dtype}"
        )
    return array


@compiled
def interpret(actions, components, episodes, commands):
    """Turn actions into the commands of the coming control step.

    Args:
        actions: (n, m); values outside [-1, 1] are clipped.
        components: COMPONENT (m,).
        episodes: EPISODE (n,), for the force commanded last and the gripper's range; a guess of friction is
            written to `guess`.
        commands: Output (n, 4), see `COMMANDS` [N, m/s, m/s, rad/s]; other columns are unchanged.
    """
    for i in range(actions.shape[0]):
        episode = episodes[i]
        for k in range(actions.shape[1]):
            component = components[k]
            fraction = 0.5 * (1.0 + min(max(actions[i, k], -1.0), 1.0))
            value = component.low + fraction * (component.high - component.low)
            if component.command == _INCREMENT or component.command == _LOGARITHM:
                force = episode.command + value if component.command == _INCREMENT else math.exp(value)
                commands[i, 0] = min(max(force, episode.force_min), episode.force_max)
            elif component.command > _INCREMENT:
                episode.guesses = True
                episode.guess[component.command - _INCREMENT - 1] = math.exp(value)
            else:
                commands[i, component.command] = value
