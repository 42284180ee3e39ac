"""Computes the observation: sensor part, task part, wrist part, friction part."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.config import Config
from slipgym.envs.actions import ACTION_MODES
from slipgym.envs.estimates import merged_mu_c, merged_mu_s, weighted_mean
from slipgym.envs.load_part import LOAD, write_load
from slipgym.envs.readings import Reading, choice_reader, row_writer
from slipgym.envs.sensor_part import LAYOUTS as LAYOUTS
from slipgym.envs.sensor_part import SENSORS, read_owned, sensor_readings
from slipgym.tasks.task import Column, Task

WRIST = (
    Reading("wrist_velocity_x", (-2.0, 2.0), "m/s", "commanded wrist velocity along world x",
            "worlds[i].wrist_velocity[0]"),
    Reading("wrist_velocity_z", (-2.0, 2.0), "m/s", "commanded wrist velocity along world z",
            "worlds[i].wrist_velocity[1]"),
    Reading("wrist_pitch_rate", (-10.0, 10.0), "rad/s", "commanded wrist pitch rate",
            "worlds[i].wrist_velocity[2]"),
    Reading("wrist_pitch", (-10.0, 10.0), "rad", "pitch of the wrist, 0 when level", "worlds[i].wrist[2]"),
)  # fmt: skip
"""Wrist part; an environment has those rows that its agent commands, see `wrist_part`."""


def _mean(value: str, name: str) -> str:
    weights = f"first.confidence_{name}, second.confidence_{name}"
    return f"weighted_mean(first.{value}, second.{value}, {weights})"


def _confidence(name: str) -> Reading:
    full, ends = f"confidence_{name}", (0.0, 1.0)
    return Reading(full, ends, "-", f"confidence of {name}, 0 to 1", f"max(first.{full}, second.{full})")


FRICTION = (
    Reading("mu_s", (0.0, 10.0), "-", "static friction", "merged_mu_s(first, second)"),
    Reading("mu_c", (0.0, 10.0), "-", "Coulomb friction", "merged_mu_c(first, second)"),
    Reading("r", (0.0, 1.0), "m", "radius of the equivalent rim contact", _mean("r", "r")),
    *map(_confidence, ("mu_s", "mu_c", "r")),
)
"""Friction part, computed from the estimates of the first and the second finger."""
DEVIATIONS = (
    Reading("sd_mu_s", (0.0, 10.0), "-", "standard deviation of mu_s that the estimator states",
            _mean("sd_mu_s", "mu_s")),
    Reading("sd_mu_c", (0.0, 10.0), "-", "standard deviation of mu_c", _mean("sd_mu_c", "mu_c")),
    Reading("sd_r", (0.0, 1.0), "m", "standard deviation of r", _mean("sd_r", "r")),
    Reading("sd_lever", (0.0, 10.0), "m",
            "standard deviation of mu_c r, the torque per normal force of a spin",
            "0.5 * (first.sd_lever + second.sd_lever)"),
    Reading("spread_mu_c", (0.0, 10.0), "-", "half the difference of the fingers' mu_c",
            "0.5 * abs(first.mu_c - second.mu_c)"),
)  # fmt: skip
"""Follow the friction part where the observation mode shows deviations; both fingers err alike."""
FRICTION_COLUMNS = tuple(reading.column() for reading in FRICTION)
DEVIATION_COLUMNS = tuple(reading.column() for reading in DEVIATIONS)


class ObservationBuffers(NamedTuple):
    """Settings and output of `observe`; its other arguments are the simulation's state."""

    wrist: np.ndarray
    """Rows of `WRIST` in the wrist part, (w,)."""
    friction: np.ndarray
    """Values of the friction part and the deviations, (n, 11): a constant array, or a view of the
    simulation's array, which changes with every step."""
    low: np.ndarray
    """Lower bounds, (m,) float32."""
    high: np.ndarray
    """Upper bounds, (m,) float32."""
    load: np.ndarray
    """Rows of `LOAD` in the load part, (l,): all or none."""
    out: np.ndarray
    """The observations, (n, m) float32."""
    sensors: np.ndarray
    """Rows of `slipgym.envs.sensor_part.OWNED` in the sensor part; none: `SENSORS`, (k,)."""


def wrist_part(task: Task, action_mode: str) -> tuple[int, ...]:
    """Rows of `WRIST` for an agent that commands the wrist, without those that the task's part holds."""
    commanded = set(ACTION_MODES[action_mode])
    if commanded & {reading.name for reading in WRIST}:
        commanded.add("wrist_pitch")
    needed = commanded - {column.name for column in task.columns}
    return tuple(k for k, reading in enumerate(WRIST) if reading.name in needed)


def sensor_columns(config: Config) -> tuple[Column, ...]:
    """The sensor part, with the limits of a configuration: what its sensors measure."""
    return tuple(reading.column(config) for reading in sensor_readings(config))


def columns(
    config: Config,
    task: Task,
    friction_source: str,
    action_mode: str = "grip_force",
    observation_mode: str = "flat",
    load_columns: bool = False,
) -> tuple[Column, ...]:
    """All columns of an observation, or of its group "policy", in order."""
    no_friction = friction_source == "none" or observation_mode == "sensor"
    return (
        *sensor_columns(config),
        *task.columns,
        *(WRIST[k].column(config) for k in wrist_part(task, action_mode)),
        *(() if no_friction else FRICTION_COLUMNS),
        *(DEVIATION_COLUMNS if observation_mode.startswith("deviations") and not no_friction else ()),
        *((reading.column(config) for reading in LOAD) if load_columns else ()),
    )


_write_sensors = row_writer(
    "_write_sensors",
    [reading.read for reading in SENSORS],
    ("wrenches", "twists", "slip_sensors", "episodes"),
    __file__,
    "Write `SENSORS` of environment i.",
)
_read_wrist = choice_reader(
    "_read_wrist", [reading.read for reading in WRIST], ("worlds",), __file__, "Row k of `WRIST`."
)
_write_friction = row_writer(
    "_write_friction",
    [reading.read for reading in (*FRICTION, *DEVIATIONS)],
    ("estimates",),
    __file__,
    "Write `FRICTION` and `DEVIATIONS` of environment i.",
    before=("first, second = estimates[2 * i], estimates[2 * i + 1]",),
    functions={"weighted_mean": weighted_mean, "merged_mu_s": merged_mu_s, "merged_mu_c": merged_mu_c},
)
_SENSORS = len(SENSORS)


@compiled
def combine(estimates, per_finger, friction):
    """Merge both fingers' estimates, each weighted by its confidence.

    Args:
        estimates: ESTIMATE (2 n,), finger by finger.
        per_finger: Output (n, 2, 3): mu_s, mu_c, r of either finger.
        friction: Output (n, 11): mu_s, mu_c, r, the higher confidence in each, and their standard deviations.
    """
    for i in range(friction.shape[0]):
        for f in range(2):
            finger = estimates[2 * i + f]
            per_finger[i, f, 0], per_finger[i, f, 1], per_finger[i, f, 2] = finger.mu_s, finger.mu_c, finger.r
        _write_friction(friction[i], i, estimates)


@compiled
def guess(friction, episodes):
    """Take the merged estimates as the guess of friction where the agent states none.

    Args:
        friction: Output of `combine`, (n, 11).
        episodes: EPISODE (n,); `guess` is written.
    """
    deviations = len(FRICTION_COLUMNS)
    for i in range(episodes.shape[0]):
        episode = episodes[i]
        if not episode.guesses:
            for k in range(3):
                episode.guess[k] = friction[i, k]
                episode.guess[3 + k] = friction[i, deviations + k] / max(friction[i, k], 1e-9)


@compiled
def observe(
    wrenches, twists, slip_sensors, episodes, grippers, markers, task_part, worlds, wrist, friction, low,
    high, load, out, sensors,
):  # fmt: skip
    """Write the observation, clipped to its bounds.

    The first eight arguments are arrays of a `slipgym.envs.control_step.BatchState`, or some of their rows,
    the others fields of `ObservationBuffers`. Values of `friction` beyond the width of `out` are left out.
    """
    for i in range(out.shape[0]):
        at = _SENSORS
        if sensors.shape[0] == 0:
            _write_sensors(out[i], i, wrenches, twists, slip_sensors, episodes)
        else:
            at = sensors.shape[0]
            for k in range(at):
                row = sensors[k]
                out[i, k] = read_owned(row, i, wrenches, twists, slip_sensors, episodes, grippers, markers)
        for k in range(task_part.shape[1]):
            out[i, at + k] = task_part[i, k]
        at += task_part.shape[1]
        for k in range(wrist.shape[0]):
            out[i, at + k] = _read_wrist(wrist[k], i, worlds)
        at += wrist.shape[0]
        end = out.shape[1] - load.shape[0]
        for k in range(end - at):
            out[i, at + k] = friction[i, k]
        if load.shape[0] > 0:
            write_load(out[i, end:], i, wrenches, episodes)
        for k in range(out.shape[1]):
            out[i, k] = min(max(out[i, k], low[k]), high[k])
