"""Simulates the force/torque sensor of a finger: bias and noise, quantisation, saturation, latency.

Six components (f_x, f_y, f_n, tau_x, tau_y, tau_n) of the load on the finger at the pad
centre. Finger 2 is mirrored: it sees the same in-plane axes and counts the torque about
its own, opposite normal.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.contact.fields import joined
from slipgym.contact.records import Pad
from slipgym.sensors.misalignment import mixed, share
from slipgym.sensors.noise import standard_normal

FEW, HISTORY = 4, 64
"""Loads that a small record has room for, and a large one: a sensor can keep no more for its latency."""


FORCE_TORQUE_FIXED = np.dtype(
    [
        ("period", "i8"),  # ticks between samples
        ("mirror", "f8"),  # +1 finger 1, -1 finger 2
        ("drift", "f8", 6),  # standard deviation of the bias step per control step
        ("resolution", "f8", 6),  # one count, 0 = continuous
        ("range", "f8", 6),  # saturation
        ("misaligned", "i8"),  # 1 if `mix` is not the identity, 0 otherwise
        ("dropout", "f8"),  # probability that a reading is the last one again [-]
        ("kept", "i8"),  # loads that `history` keeps
        # what an episode samples from, see `slipgym.sensors.misalignment`
        ("off_centre", "f8"),  # largest distance of the pad's centre from its place along x and y [m]
        ("tilt", "f8"),  # largest tilt of the frame about x and y [rad]
        ("crosstalk", "f8"),  # largest part of an axis's load that another axis reads [-]
        ("least_delay", "i8"),  # in ticks
        ("delay_spread", "i8"),  # what may be added, in ticks
        ("own_delay", "i8"),  # 1 if it samples that by itself, 0 if it shares finger 1's
        ("least_tip", "f8"),  # smallest mass of the fingertip in front of the sensor [kg]
        ("tip_spread", "f8"),  # what may be added [kg]
    ]
)
"""Fields of FORCE_TORQUE that the configuration fixes for all episodes."""


def force_torque(large: bool) -> np.dtype:
    """FORCE_TORQUE, the record of a sensor: with room for all, or for `FEW` loads without `mix` and `swing`.

    Among thousands of records space costs time, and every other dtype has to be compiled for.
    """
    room, axes, numbers, rows = (HISTORY, 6, 5, (3, 6)) if large else (FEW, 1, 1, (1, 1))
    episode = np.dtype(
        [
            ("delay", "i8"),  # latency in ticks
            ("tip_mass", "f8"),  # [kg]
            ("tip_load", "f8", 2),  # its weight and inertia along the pad's x and y, newest [N]
            ("noise", "f8", 6),  # standard deviation per sample [N, N m]
            ("bias", "f8", 6),
            ("last", "f8", 6),  # reading
            ("key", "u8"),  # of the noise
            ("drift_key", "u8"),  # of the bias's random walk
            ("read", "i8"),  # readings since reset
            ("mode", "f8", numbers),  # see `slipgym.sensors.structure`, like the next; 0: the finger has none
            ("swing", "f8", rows),
            ("mix", "f8", (axes, axes)),  # of the load on all axes
            ("history", "f8", (room, 6)),  # loads at the newest samples, in turn
        ]
    )
    return joined(FORCE_TORQUE_FIXED, episode)


def roomier(sensors: np.ndarray, kept: int) -> np.ndarray:
    """The same FORCE_TORQUE with room for more loads, at most `HISTORY`, none of which there is yet."""
    larger = np.zeros(sensors.shape, force_torque(kept > FEW or sensors.dtype == force_torque(large=True)))
    for name in larger.dtype.names or ():
        if name != "history":
            larger[name] = sensors[name]
    larger["kept"] = kept
    return larger


@compiled
def sample_force_torque(sensor: Any, pad: Pad, tick: int) -> None:
    """Store the load on a finger at a sampling instant; `sensed` applies bias, noise and quantisation.

    `pad` has the present wrench and normal force; `tick` is a multiple of the sensor's period.
    """
    fx, fy, tau = -pad.wrench[0], -pad.wrench[1], -pad.wrench[2]
    cx, cy = pad.pressure_centre
    load = sensor.history[(tick // sensor.period) % sensor.kept]
    load[0], load[1], load[2] = fx, fy, pad.normal
    load[3], load[4] = cy * pad.normal, -cx * pad.normal
    load[5] = sensor.mirror * (tau + cx * fy - cy * fx)


@compiled
def next_sample_read(sensor: Any, tick: int, control_ticks: int) -> int:
    """Time of the first sample after `tick` that a reading, every `control_ticks`, or a mode needs."""
    period = sensor.period
    number = tick // period + 1
    if sensor.mode[0] > 0.0:
        return number * period
    readings = -(-(number * period + sensor.delay) // control_ticks)
    return (readings * control_ticks - sensor.delay) // period * period


@compiled
def next_sample(sensors: Any, tick: int, control_ticks: int) -> int:
    """`next_sample_read` of both fingers' sensors: the earlier one."""
    sample = next_sample_read(sensors[0], tick, control_ticks)
    if sensors[1].delay != sensors[0].delay:
        return min(sample, next_sample_read(sensors[1], tick, control_ticks))
    return sample


@compiled
def reading_at(sensor: Any, a: int, value: float, index: int) -> float:
    """Reading of axis a at a load with bias: with the noise of an index, quantisation and saturation."""
    if sensor.noise[a] > 0.0:
        value += sensor.noise[a] * standard_normal(sensor.key, index)
    if sensor.resolution[a] > 0.0:
        value = sensor.resolution[a] * math.floor(value / sensor.resolution[a] + 0.5)
    return min(max(value, -sensor.range[a]), sensor.range[a])


@compiled
def sensed(sensor: Any, number: int, reading: np.ndarray) -> None:
    """Write the reading (6,) of a load that the sensor keeps, with bias, noise, quantisation, saturation.

    `number` is that of the sample, 1 the first after reset; 0 before reads as zero [N, N m].
    """
    load = sensor.history[number % sensor.kept]
    for a in range(6):
        reading[a] = 0.0
        if number >= 1:
            value = (mixed(sensor, load, a) if sensor.misaligned else load[a]) + sensor.bias[a]
            reading[a] = reading_at(sensor, a, value, 6 * number + a)


@compiled
def read_force_torque(sensor: Any, tick: int, reading: np.ndarray) -> None:
    """Read the newest sample that has arrived by `tick` into `reading` (6,); the bias then drifts on."""
    if sensor.dropout > 0.0 and sensor.read > 0 and share(sensor.key, sensor.read) < sensor.dropout:
        for a in range(6):
            reading[a] = sensor.last[a]
    else:
        sensed(sensor, max((tick - sensor.delay) // sensor.period, 0), reading)
    if sensor.dropout > 0.0:
        for a in range(6):
            sensor.last[a] = reading[a]
    for a in range(6):
        if sensor.drift[a] > 0.0:
            sensor.bias[a] += sensor.drift[a] * standard_normal(sensor.drift_key, 6 * sensor.read + a)
    sensor.read += 1


@compiled
def resolve_at_cop(
    sensor: Any, reading: np.ndarray, contact_threshold: float, wrench: np.ndarray, cop: np.ndarray
) -> None:
    """Wrench (f_x, f_y, f_n, tau) at the measured centre of pressure, in the pad frame.

    Args:
        sensor: FORCE_TORQUE record, for the mirror sign.
        reading: Sensor reading (6,) [N, N m].
        contact_threshold: Normal force below which the centre of pressure is not defined [N].
        wrench: Output (4,) [N, N, N, N m].
        cop: Output (2,): centre of pressure in the pad frame [m].
    """
    fx, fy, fn = reading[0], reading[1], reading[2]
    cop[0], cop[1] = 0.0, 0.0
    if fn >= contact_threshold:
        cop[0], cop[1] = -reading[4] / fn, reading[3] / fn
    wrench[0], wrench[1], wrench[2] = fx, fy, fn
    wrench[3] = sensor.mirror * reading[5] - (cop[0] * fy - cop[1] * fx)
