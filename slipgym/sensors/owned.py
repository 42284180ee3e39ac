"""Reads the sensors of grippers as labs own them: one at the wrist, the motor alone, or markers in the pads.

They begin with what sensors in the fingers read, with the noise of the preset: a wrist sees the sum of both,
a motor the normal force alone, and markers replace the forces along the pad. What they do not measure is 0 in
the readings, no column of the observation, and said to the estimator.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.sensors.force_torque import read_force_torque, resolve_at_cop
from slipgym.sensors.markers import press, seen_forces
from slipgym.sensors.measure import CONTACT_THRESHOLD
from slipgym.sensors.misalignment import about
from slipgym.sensors.noise import standard_normal
from slipgym.sensors.slip_velocity import read_slip, sample_slip

PLACES = ("fingers", "wrist", "motor")
"""Where forces are measured, as in `slipgym.config.sensors.SensorsConfig.place`."""
FINGERS, WRIST = 0, 1
_GAIN = 1 << 22
"""Number of `share` beyond those of other sensors."""
_BEFORE = 1 << 36
"""Index of the noise of the open gripper; noise after the grasp uses smaller ones."""
GRIPPER = np.dtype(
    [
        ("usual", "i8"),  # 1: `slipgym.sensors.measure` reads the sensors, and nothing here counts
        ("place", "i8"),  # number in PLACES
        ("interval", "i8"),  # control steps between two readings
        ("gain_error", "f8"),  # as in the configuration, like the next five
        ("friction", "f8"),
        ("backlash", "f8"),
        ("noise", "f8"),
        ("resolution", "f8"),
        ("opening_noise", "f8"),
        ("softness", "f8"),  # change of the opening over the force, of both pads together [m/N]
        # sampled by an episode
        ("key", "u8"),  # of the noise
        ("gain", "f8"),  # force read over the true one [-]
        # state
        ("steps", "i8"),  # control steps since reset
        ("force", "f8"),  # mean normal force of both fingers at the last reading [N]
        ("turned", "f8"),  # friction in the motor's load over its largest, -1 opening to 1 closing [-]
        ("opening", "f8"),  # as read [m]
    ]
)
"""A gripper: its motor, and how its sensors are read."""


@compiled
def start_gripper(gripper: Any, key: int) -> None:
    """Begin an episode of a GRIPPER record that is open, with the uint64 key of its noise."""
    gripper.key = key
    gripper.gain = 1.0 + about(key, _GAIN, gripper.gain_error)
    gripper.steps, gripper.force, gripper.turned, gripper.opening = 0, 0.0, 0.0, 0.0


@compiled
def motor_force(gripper: Any, number: int) -> float:
    """Normal force per finger as the motor's load shows it, with noise of this number [N].

    A motor that closes bears the friction of its transmission on top of the force on the object, one that
    opens so much less. In between, the friction turns over along a straight line.
    """
    value = gripper.gain * gripper.force * (1.0 + gripper.friction * gripper.turned)
    if gripper.noise > 0.0:
        value += gripper.noise * standard_normal(gripper.key, 2 * number)
    if gripper.resolution > 0.0:
        value = gripper.resolution * math.floor(value / gripper.resolution + 0.5)
    return value


@compiled
def turn_motor(gripper: Any, force: float) -> None:
    """Let the force on the object become `force` [N]; the friction follows its changes."""
    change = force - gripper.force
    step = change / gripper.backlash if gripper.backlash > 0.0 else 2.0 * np.sign(change)
    gripper.turned = min(max(gripper.turned + step, -1.0), 1.0)
    gripper.force = force


@compiled
def join(gripper: Any, number: int, wrenches: np.ndarray) -> None:
    """Replace the readings of both fingers (2, 4) by what wrist and motor see, half of it for each."""
    for a in (0, 1, 3):
        half = 0.5 * (wrenches[0, a] + wrenches[1, a]) if gripper.place == WRIST else 0.0
        wrenches[0, a] = wrenches[1, a] = half
    wrenches[0, 2] = wrenches[1, 2] = motor_force(gripper, number)


@compiled
def join_open(gripper: Any, number: int, wrenches: np.ndarray) -> None:
    """As `join`, for reading `number` of the open gripper before the grasp."""
    if gripper.place != FINGERS:
        held, gripper.force = gripper.force, 0.0
        join(gripper, _BEFORE + number, wrenches)
        gripper.force = held


@compiled
def measure_owned(state: Any, cells: Any, force_torque: np.ndarray, lo: int, hi: int) -> None:
    """Sample the sensors of rows lo to hi - 1, and read those that are due; the last readings stay otherwise.

    `state` is a `slipgym.envs.control_step.BatchState`, whose `wrenches` and `twists` are written, `cells` is
    that of `slipgym.world.plant.Plant`, `force_torque` FORCE_TORQUE (n, 2).
    """
    reading, cop = np.empty(6), np.empty(2)
    for i in range(lo, hi):
        gripper, wrenches, twists = state.grippers[i], state.wrenches[i], state.twists[i]
        due = gripper.steps % gripper.interval == 0
        threshold = CONTACT_THRESHOLD if gripper.place == FINGERS else np.inf
        for f in range(2):
            slip, sensor = state.slip_sensors[i, f], force_torque[i, f]
            sample_slip(slip)
            if due:
                read_force_torque(sensor, state.worlds[i].tick, reading)
                if state.markers.shape[0] > 0:
                    press(state.markers[i, f], state.pads[i, f], cells, i, f)
                    seen_forces(state.markers[i, f], sensor.mirror, reading)
                resolve_at_cop(sensor, reading, threshold, wrenches[f], cop)
                if gripper.place == FINGERS:
                    read_slip(slip, twists[f])
                    twists[f, 0] -= twists[f, 2] * cop[1]
                    twists[f, 1] += twists[f, 2] * cop[0]
        if due and gripper.place != FINGERS:
            turn_motor(gripper, 0.5 * (wrenches[0, 2] + wrenches[1, 2]))
            join(gripper, gripper.steps, wrenches)
            noise = gripper.opening_noise * standard_normal(gripper.key, 2 * gripper.steps + 1)
            gripper.opening = 2.0 * state.worlds[i].half_thickness - gripper.softness * gripper.force + noise
        gripper.steps += 1
