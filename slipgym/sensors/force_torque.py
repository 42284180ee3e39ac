"""Force/torque sensor of a finger: corrupt, quantise, saturate, delay.

Six components (f_x, f_y, f_n, tau_x, tau_y, tau_n) of the load on the finger at the pad
centre. Finger 2 is mirrored: it sees the same in-plane axes and counts the torque about
its own, opposite normal.
"""

from __future__ import annotations

import math

import numpy as np

from slipgym.compiled import compiled

HISTORY = 128

FORCE_TORQUE = np.dtype(
    [
        ("period", "i8"),  # ticks between samples
        ("delay", "i8"),  # latency in ticks
        ("mirror", "f8"),  # +1 finger 1, -1 finger 2
        ("noise", "f8", 6),  # standard deviation per sample [N, N m]
        ("drift", "f8", 6),  # standard deviation of the bias step per control step
        ("bias", "f8", 6),
        ("resolution", "f8", 6),  # one count, 0 = continuous
        ("range", "f8", 6),  # saturation
        ("history", "f8", (HISTORY, 6)),
        ("taken", "i8"),  # samples since reset
        ("drawn", "i8"),  # samples since the noise was drawn
    ]
)


@compiled
def sample_force_torque(sensor, pad, noise):
    """Take one sample of the load on a finger.

    Args:
        sensor: FORCE_TORQUE record.
        pad: PAD record with the present wrench and normal force.
        noise: Standard normal draws, shape (samples, 6); row `drawn` is used.
    """
    fx, fy, tau = -pad.wrench[0], -pad.wrench[1], -pad.wrench[2]
    cx, cy = pad.cop
    load = (fx, fy, pad.normal, cy * pad.normal, -cx * pad.normal, sensor.mirror * (tau + cx * fy - cy * fx))
    row = sensor.taken % HISTORY
    for a in range(6):
        value = load[a] + sensor.bias[a] + sensor.noise[a] * noise[sensor.drawn, a]
        if sensor.resolution[a] > 0.0:
            value = sensor.resolution[a] * math.floor(value / sensor.resolution[a] + 0.5)
        sensor.history[row, a] = min(max(value, -sensor.range[a]), sensor.range[a])
    sensor.taken += 1
    sensor.drawn += 1


@compiled
def drift_force_torque(sensor, noise):
    """Move the bias by one control step of its random walk; `noise` holds six standard normal draws."""
    for a in range(6):
        sensor.bias[a] += sensor.drift[a] * noise[a]
    sensor.drawn = 0


@compiled
def read_force_torque(sensor, tick, reading):
    """Copy the newest sample that has arrived by `tick` into `reading` (6,)."""
    number = (tick - sensor.delay) // sensor.period
    if number < 1:
        reading[:] = 0.0
    else:
        reading[:] = sensor.history[(number - 1) % HISTORY]


@compiled
def resolve_at_cop(sensor, reading, contact_threshold, wrench, cop):
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
