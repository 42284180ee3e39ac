"""Slip-velocity sensor of a finger: optical mouse chips and least squares.

Each chip counts the displacement of the object's surface under it along two axes. Once per
sample the counts of the averaging window, divided by its length, give the slip twist
(v_x, v_y, omega) at the pad centre by least squares over all axes (gripper paper,
arXiv 2410.19660). No count, no velocity: the twist is then exactly 0.
"""

from __future__ import annotations

import math

import numpy as np

from slipgym.compiled import compiled
from slipgym.sensors.noise import standard_normal

HISTORY = 32
CHIPS_MAX = 4
AXES = 2 * CHIPS_MAX  # rows of absent chips are zero

SLIP_SENSOR = np.dtype(
    [
        ("mirror", "f8"),  # +1 finger 1, -1 finger 2
        ("sample_time", "f8"),  # [s]
        ("count", "f8"),  # displacement of one count [m], 0 = continuous
        ("noise", "f8"),  # standard deviation per axis and sample [m]
        ("range", "f8"),  # largest displacement per axis and sample [m]
        ("window", "i8"),  # samples averaged
        ("delay", "i8"),  # latency in samples
        ("lever", "f8", (AXES, 3)),  # slip displacement -> displacement along the axes
        ("solve", "f8", (3, AXES)),  # its least-squares inverse
        ("key", "u8"),  # of the noise
        ("moved", "f8", 3),  # slip displacement since the last sample, pad frame [m, m, rad]
        ("carry", "f8", AXES),  # displacement not yet counted [m]
        ("counted", "f8", (HISTORY, AXES)),  # counted displacement per sample [m]
        ("taken", "i8"),  # samples since reset
        ("travel", "f8", 3),  # delivered slip displacement since reset
    ]
)


def chip_levers(radius: float, chips: int) -> np.ndarray:
    """Matrix from slip displacement (x, y, theta), in the finger's frame, to the chips' axes.

    Args:
        radius: Distance of the chips from the pad centre [m].
        chips: Number of chips, evenly spaced, the first straight up.

    Returns:
        Array (AXES, 3) [1, 1, m].
    """
    levers = np.zeros((AXES, 3))
    for i in range(chips):
        angle = math.pi / 2 + 2 * math.pi * i / chips
        levers[2 * i] = 1.0, 0.0, -radius * math.sin(angle)
        levers[2 * i + 1] = 0.0, 1.0, radius * math.cos(angle)
    return levers


@compiled
def accumulate_slip(sensor, motion):
    """Add a slip displacement (x, y, theta) at the pad centre to what the chips have seen."""
    for k in range(3):
        sensor.moved[k] += motion[k]


@compiled
def sample_slip(sensor):
    """Close one sample: count what has been seen since the last.

    Counting truncates towards zero and keeps the rest, so a surface that trembles by less
    than one count gives none.
    """
    row = sensor.taken % HISTORY
    x, y, theta = sensor.moved[0], sensor.moved[1], sensor.mirror * sensor.moved[2]
    sensor.moved[:] = 0.0
    for a in range(AXES):
        lever = sensor.lever[a]
        seen = sensor.carry[a] + lever[0] * x + lever[1] * y + lever[2] * theta
        if sensor.noise > 0.0:
            seen += sensor.noise * standard_normal(sensor.key, AXES * sensor.taken + a)
        seen = min(max(seen, -sensor.range), sensor.range)
        counted = sensor.count * math.trunc(seen / sensor.count) if sensor.count > 0.0 else seen
        sensor.carry[a] = seen - counted
        sensor.counted[row, a] = counted
    sensor.taken += 1


@compiled
def read_slip(sensor, twist):
    """Slip twist (v_x, v_y, omega) at the pad centre, in the pad frame, as delivered now.

    Returns the window average that is `delay` samples old and adds the newest delivered
    sample to the travel.
    """
    twist[:] = 0.0
    newest = sensor.taken - 1 - sensor.delay
    for a in range(3):
        sign = sensor.mirror if a == 2 else 1.0
        step = 0.0
        for k in range(sensor.window):
            number = newest - k
            if number >= 0:
                moved = 0.0
                for b in range(AXES):
                    moved += sign * sensor.solve[a, b] * sensor.counted[number % HISTORY, b]
                twist[a] += moved / (sensor.window * sensor.sample_time)
                if k == 0:
                    step = moved
        sensor.travel[a] += step
