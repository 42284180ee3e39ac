"""Simulates the slip-velocity sensor of a finger: optical mouse chips and least squares.

Each chip counts the displacement of the object's surface under it along two axes. Once per
control step the counts of the averaging window, divided by its length, give the slip twist
(v_x, v_y, omega) at the pad centre by least squares over all axes (gripper paper,
arXiv 2410.19660). No count, no velocity: the twist is then exactly 0. A chip that counts nothing
while the others count is left out; two chips determine the twist.

Chips that counted nothing for a while look at the surface less often (rest mode). What moves in between is
counted late, at the next look, and what exceeds the range of a sample is lost.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.contact.fields import joined
from slipgym.contact.records import Vector
from slipgym.sensors.misalignment import share
from slipgym.sensors.noise import standard_normal

HISTORY = 16
CHIPS_MAX = 4
AXES = 2 * CHIPS_MAX  # x and y of the first chip, of the second, ...
LOST_AFTER = 20
"""Counts of each other chip after which a chip that counted nothing is left out."""

SLIP_SENSOR_FIXED = np.dtype(
    [
        ("mirror", "f8"),  # +1 finger 1, -1 finger 2
        ("sample_time", "f8"),  # [s]
        ("count", "f8"),  # displacement of one count [m], 0 = continuous
        ("range", "f8"),  # largest displacement per axis and sample [m]
        ("window", "i8"),  # samples averaged
        ("delay_spread", "i8"),  # what an episode may add to the latency, in samples
        ("own_delay", "i8"),  # 1 if it samples that by itself, 0 if it shares finger 1's
        ("jitter", "f8"),  # probability that a reading is a sample older [-]
        ("dropout", "f8"),  # probability that a reading is the last one again [-]
        ("scale_spread", "f8"),  # largest relative error of an episode's counts [-]
        ("rest_after", "i8"),  # samples without a count before the chips rest
        ("rest_most", "i8"),  # largest number of samples from one look of resting chips to the next
        ("chip_failure", "f8"),  # probability that one chip counts nothing in an episode [-]
        ("chips", "i8"),  # how many
        ("at", "f8", (CHIPS_MAX, 2)),  # where, from the pad centre, in the finger's frame [m]
        ("spread", "f8"),  # sum of their squared distances from it [m^2]
    ]
)
"""What the configuration fixes for all episodes."""
SLIP_SENSOR_EPISODE = np.dtype(
    [
        ("noise", "f8"),  # standard deviation per axis and sample [m]
        ("least_delay", "i8"),  # smallest latency of an episode in samples
        ("delay", "i8"),  # latency in samples
        ("scale", "f8"),  # counted over true motion [-]
        ("failed", "i8"),  # chip that counts nothing; -1 for none
        ("rest_samples", "i8"),  # from one look of resting chips to the next; 0 or 1: they never rest
        ("rest_phase", "i8"),  # number of the first of them, counting from 0
        ("still", "i8"),  # samples since the chips last counted
        ("delivered", "i8"),  # newest sample delivered, counting from 0
        ("last", "f8", 3),  # reading
        ("key", "u8"),  # of the noise
        ("moved", "f8", 3),  # slip displacement since the last sample, pad frame [m, m, rad]
        ("carry", "f8", AXES),  # displacement not yet counted [m]
        ("counted", "f8", AXES),  # displacement counted in the newest sample [m]
        ("travel", "f8", CHIPS_MAX),  # distance that each chip counted since reset, sum over both axes [m]
        ("taken", "i8"),  # samples since reset
        ("measured_slip", "f8", 3),  # delivered slip displacement since reset
        ("history", "f8", (HISTORY, 3)),  # slip displacement counted in the newest samples, in turn
    ]
)
"""What an episode samples, and state."""
SLIP_SENSOR = joined(SLIP_SENSOR_FIXED, SLIP_SENSOR_EPISODE)


def chip_positions(radius: float, chips: int) -> np.ndarray:
    """Positions (CHIPS_MAX, 2) of 2 or more chips from the pad centre, their mean, in the finger's frame [m].

    They are evenly spaced on a circle, the first straight up; rows of absent chips are zero.
    """
    positions = np.zeros((CHIPS_MAX, 2))
    angles = math.pi / 2 + 2 * math.pi * np.arange(chips) / chips
    positions[:chips, 0], positions[:chips, 1] = radius * np.cos(angles), radius * np.sin(angles)
    return positions


@compiled
def accumulate_slip(sensor: Any, motion: Vector | np.ndarray) -> None:
    """Add a slip displacement (x, y, theta) at the pad centre to the displacement not yet counted."""
    for k in range(3):
        sensor.moved[k] += motion[k]


@compiled
def sample_slip(sensor: Any) -> None:
    """Take a sample: count the displacement since the last one.

    Counting truncates towards zero and keeps the remainder, so a surface that vibrates by less
    than one count gives none.
    """
    row = sensor.history[sensor.taken % HISTORY]
    if resting(sensor):
        row[0], row[1], row[2] = 0.0, 0.0, 0.0
        sensor.taken += 1
        return
    scale = sensor.scale
    x, y, theta = scale * sensor.moved[0], scale * sensor.moved[1], scale * sensor.mirror * sensor.moved[2]
    sensor.moved[:] = 0.0
    sensor.still += 1
    for a in range(2 * sensor.chips):
        at = sensor.at[a // 2]
        seen = sensor.carry[a] + (x - theta * at[1] if a % 2 == 0 else y + theta * at[0])
        if sensor.noise > 0.0:
            seen += sensor.noise * standard_normal(sensor.key, AXES * sensor.taken + a)
        seen = min(max(seen, -sensor.range), sensor.range) if a // 2 != sensor.failed else 0.0
        counted = sensor.count * math.trunc(seen / sensor.count) if sensor.count > 0.0 else seen
        sensor.carry[a] = seen - counted
        sensor.counted[a] = counted
        sensor.travel[a // 2] += abs(counted)
        if counted != 0.0:
            sensor.still = 0
    row[0], row[1], row[2] = displacement(sensor)
    sensor.taken += 1


@compiled
def resting(sensor: Any) -> bool:
    """Whether the chips do not look at the surface in the sample that is due."""
    if sensor.rest_samples <= 1 or sensor.still < sensor.rest_after:
        return False
    return sensor.taken % sensor.rest_samples != sensor.rest_phase


@compiled
def read_slip(sensor: Any, twist: np.ndarray) -> None:
    """Slip twist (v_x, v_y, omega) at the pad centre, in the pad frame, as delivered now.

    Returns the window average that is `delay` samples old, or one more by `jitter`, and adds the samples that
    are delivered for the first time to the measured slip.
    """
    if sensor.dropout > 0.0 and share(sensor.key, 2 * sensor.taken) < sensor.dropout:
        for a in range(3):
            twist[a] = sensor.last[a]
        return
    twist[:] = 0.0
    newest = sensor.taken - 1 - sensor.delay
    if sensor.jitter > 0.0 and share(sensor.key, 2 * sensor.taken + 1) < sensor.jitter:
        newest -= 1
    for number in range(max(newest - sensor.window + 1, 0), newest + 1):
        x, y, theta = sensor.history[number % HISTORY]
        twist[0] += x
        twist[1] += y
        twist[2] += theta
    for number in range(max(sensor.delivered + 1, newest - HISTORY + 1), newest + 1):
        for a in range(3):
            sensor.measured_slip[a] += sensor.history[number % HISTORY, a]
        sensor.delivered = number
    for a in range(3):
        twist[a] /= sensor.window * sensor.sample_time
    if sensor.dropout > 0.0:
        for a in range(3):
            sensor.last[a] = twist[a]


@compiled
def displacement(sensor: Any) -> Vector:
    """Slip displacement (x, y, theta) counted in the newest sample: least squares over the axes of the chips.

    As the chips' mean is the pad centre, its three equations are independent of each other. Without a lost
    chip they are so about the centre of the others.
    """
    lost = lost_chip(sensor)
    chips, spread, centre_x, centre_y = sensor.chips, sensor.spread, 0.0, 0.0
    if lost >= 0:
        chips -= 1
        centre_x, centre_y = -sensor.at[lost, 0] / chips, -sensor.at[lost, 1] / chips
        spread -= sensor.at[lost, 0] ** 2 + sensor.at[lost, 1] ** 2
        spread -= chips * (centre_x**2 + centre_y**2)
    x, y, moment = 0.0, 0.0, 0.0
    counted = sensor.counted
    for k in range(sensor.chips):
        if k != lost:
            x += counted[2 * k]
            y += counted[2 * k + 1]
            moment += sensor.at[k, 0] * counted[2 * k + 1] - sensor.at[k, 1] * counted[2 * k]
    if lost < 0:
        return x / chips, y / chips, sensor.mirror * moment / spread
    theta = (moment - centre_x * y + centre_y * x) / spread
    return x / chips + theta * centre_y, y / chips - theta * centre_x, sensor.mirror * theta


@compiled
def lost_chip(sensor: Any) -> int:
    """Index of a chip that has counted nothing since the reset while each of the others moved; -1 if none."""
    lost, least = -1, math.inf
    for k in range(sensor.chips):
        if sensor.travel[k] > 0.0:
            least = min(least, sensor.travel[k])
        elif lost >= 0:
            return -1
        else:
            lost = k
    return lost if sensor.chips > 2 and least > LOST_AFTER * sensor.count else -1
