"""The observation: sensor part, task part, wrist part, friction part."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.config import Config
from slipgym.envs.actions import ACTION_MODES
from slipgym.tasks.task import Column, Task

OBSERVATION_MODES = ("flat", "sensor", "dict")
FRICTION_SOURCES = ("estimated", "true", "nominal", "none")
FRICTION_COLUMNS = (
    Column("mu_s", 0.0, 10.0, "-", "static friction"),
    Column("mu_c", 0.0, 10.0, "-", "Coulomb friction"),
    Column("r", 0.0, 1.0, "m", "radius of the equivalent rim contact"),
    Column("confidence_mu_s", 0.0, 1.0, "-", "how much data stands behind mu_s"),
    Column("confidence_mu_c", 0.0, 1.0, "-", "how much data stands behind mu_c"),
    Column("confidence_r", 0.0, 1.0, "-", "how much data stands behind r"),
)
WRIST_COLUMNS = (
    Column("wrist_velocity_x", -2.0, 2.0, "m/s", "commanded wrist velocity along world x"),
    Column("wrist_velocity_z", -2.0, 2.0, "m/s", "commanded wrist velocity along world z"),
    Column("wrist_pitch_rate", -10.0, 10.0, "rad/s", "commanded wrist pitch rate"),
    Column("wrist_pitch", -10.0, 10.0, "rad", "pitch of the wrist against level"),
)


class Sight(NamedTuple):
    """Of an observation, what does not come from the loop, and where it goes: arguments of `observe`."""

    wrist: np.ndarray
    """Which of `WRIST_COLUMNS` make the wrist part, (w,)."""
    friction: np.ndarray
    """What the friction part holds, (n, 6)."""
    low: np.ndarray
    """Lower bounds, (m,) float32."""
    high: np.ndarray
    """Upper bounds, (m,) float32."""
    out: np.ndarray
    """The observations, (n, m) float32."""


def sensor_columns(config: Config) -> tuple[Column, ...]:
    """Sensor part: both fingers' wrench and twist, measured travel, commanded force."""
    ft, speed = config.sensors.force_torque, config.sensors.slip.speed_max
    spin = 2.0 * speed / config.sensors.slip.chip_radius
    fingers = []
    for f in (1, 2):
        fingers += [
            Column(f"f_x_{f}", -ft.force_range, ft.force_range, "N", f"tangential force on finger {f}"),
            Column(f"f_y_{f}", -ft.force_range, ft.force_range, "N", f"tangential force on finger {f}"),
            Column(f"f_n_{f}", -ft.normal_range, ft.normal_range, "N", f"normal force of finger {f}"),
            Column(f"tau_{f}", -ft.torque_range, ft.torque_range, "N m", f"torque at finger {f}'s CoP"),
            Column(f"v_x_{f}", -2 * speed, 2 * speed, "m/s", f"slip velocity at finger {f}'s CoP"),
            Column(f"v_y_{f}", -2 * speed, 2 * speed, "m/s", f"slip velocity at finger {f}'s CoP"),
            Column(f"omega_{f}", -spin, spin, "rad/s", f"slip rate about the grip axis at finger {f}"),
        ]
    return (
        *fingers,
        Column(
            "measured_slip_x", -1.0, 1.0, "m", "slip displacement, summed from the counts of both fingers"
        ),
        Column("measured_slip_y", -1.0, 1.0, "m", "the same along the pads' y axis"),
        Column("measured_slip_theta", -10.0, 10.0, "rad", "the same about the grip axis"),
        Column(
            "commanded_force", 0.0, config.gripper.force_limit, "N", "grip force commanded in the last step"
        ),
    )


def wrist_columns(task: Task, action_mode: str) -> tuple[Column, ...]:
    """Wrist part: what an agent that commands the wrist needs and the task's part does not hold."""
    commanded = set(ACTION_MODES[action_mode])
    if commanded & {column.name for column in WRIST_COLUMNS}:
        commanded.add("wrist_pitch")
    needed = commanded - {column.name for column in task.columns}
    return tuple(column for column in WRIST_COLUMNS if column.name in needed)


def columns(
    config: Config,
    task: Task,
    friction_source: str,
    action_mode: str = "grip_force",
    observation_mode: str = "flat",
) -> tuple[Column, ...]:
    """All columns of an observation, or of its group "policy", in order."""
    bare = friction_source == "none" or observation_mode == "sensor"
    friction = () if bare else FRICTION_COLUMNS
    return (*sensor_columns(config), *task.columns, *wrist_columns(task, action_mode), *friction)


@compiled
def combine(estimates, per_finger, friction):
    """Merge both fingers' estimates, each weighted by its support.

    Args:
        estimates: ESTIMATE (2 n,), finger by finger.
        per_finger: Output (n, 2, 3): mu_s, mu_c, r of either finger.
        friction: Output (n, 6): mu_s, mu_c, r and their supports (the better finger's).
    """
    for i in range(friction.shape[0]):
        a, b = estimates[2 * i], estimates[2 * i + 1]
        for f in range(2):
            finger = estimates[2 * i + f]
            per_finger[i, f, 0], per_finger[i, f, 1], per_finger[i, f, 2] = finger.mu_s, finger.mu_c, finger.r
        friction[i, 0] = weigh(a.mu_s, b.mu_s, a.confidence_mu_s, b.confidence_mu_s)
        friction[i, 1] = weigh(a.mu_c, b.mu_c, a.confidence_mu_c, b.confidence_mu_c)
        friction[i, 0] = max(friction[i, 0], friction[i, 1])  # their weights differ: the means may cross
        friction[i, 2] = weigh(a.r, b.r, a.confidence_r, b.confidence_r)
        friction[i, 3] = max(a.confidence_mu_s, b.confidence_mu_s)
        friction[i, 4] = max(a.confidence_mu_c, b.confidence_mu_c)
        friction[i, 5] = max(a.confidence_r, b.confidence_r)


@compiled
def weigh(a, b, support_a, support_b):
    """Mean of two values weighted by their support; plain if neither has any."""
    total = support_a + support_b
    return (a * support_a + b * support_b) / total if total > 0.0 else 0.5 * (a + b)


@compiled
def observe(wrenches, twists, slip_sensors, episodes, task_part, worlds, wrist, friction, low, high, out):
    """Write the observation, clipped to its bounds.

    Args:
        wrenches: As from `measure`, (n, 2, 4).
        twists: As from `measure`, (n, 2, 3).
        slip_sensors: SLIP_SENSOR (n, 2), for the travel.
        episodes: EPISODE (n,), for the command.
        task_part: (n, k).
        worlds: WORLD (n,), for the wrist.
        wrist: Which of `WRIST_COLUMNS` (w,) make the wrist part.
        friction: (n, 6); used as far as `out` has room for it.
        low: Lower bounds (m,).
        high: Upper bounds (m,).
        out: Output (n, m), float32.
    """
    for i in range(out.shape[0]):
        at = 0
        for f in range(2):
            for k in range(4):
                out[i, at + k] = wrenches[i, f, k]
            for k in range(3):
                out[i, at + 4 + k] = twists[i, f, k]
            at += 7
        for k in range(3):
            out[i, at + k] = 0.5 * (slip_sensors[i, 0].measured_slip[k] + slip_sensors[i, 1].measured_slip[k])
        out[i, at + 3] = episodes[i].command
        at += 4
        for k in range(task_part.shape[1]):
            out[i, at + k] = task_part[i, k]
        at += task_part.shape[1]
        for k in range(wrist.shape[0]):
            which = wrist[k]
            out[i, at + k] = worlds[i].wrist_velocity[which] if which < 3 else worlds[i].wrist[2]
        at += wrist.shape[0]
        for k in range(out.shape[1] - at):
            out[i, at + k] = friction[i, k]
        for k in range(out.shape[1]):
            out[i, k] = min(max(out[i, k], low[k]), high[k])


@compiled
def observe_some(
    rows, wrenches, twists, slip_sensors, episodes, task_part, worlds, wrist, friction, low, high, out
):
    """`observe` for some environments, rows (m,)."""
    for i in rows:
        row = slice(i, i + 1)
        observe(
            wrenches[row], twists[row], slip_sensors[row], episodes[row], task_part[row], worlds[row],
            wrist, friction[row], low, high, out[row],
        )  # fmt: skip
