"""The mounting of a force/torque sensor: off centre, tilted, with cross-talk between its axes.

All three are one matrix, sampled at the start of an episode, which no estimator knows:
reading = mix load + bias.
"""

from __future__ import annotations

import math
from typing import Any

from slipgym._numba.compiled import compiled, compiled_call
from slipgym.sensors.noise import uniform

LOAD_AXES = 6
"""Of a force/torque sensor."""
OFF_CENTRE, TILT, CROSSTALK, LATENCY, TIP = 0, 2, 4, 64, 65
"""First of the numbers that each takes from `share`."""
_START = 1 << 40
"""Index of the first of them; the noise of a sensor uses smaller ones."""


@compiled
def share(key: int, number: int) -> float:
    """A uniform number in (0, 1) of an episode, which the noise of the same uint64 key does not use."""
    return uniform(key, _START + number)


@compiled
def about(key: int, number: int, most: float) -> float:
    """A uniform number of an episode in (-most, most)."""
    return most * (2.0 * share(key, number) - 1.0)


@compiled_call
def mount(sensor: Any) -> None:
    """Sample how a FORCE_TORQUE record is mounted: its `mix`, from its `drift_key`.

    With the pad's centre at e in the sensor's frame the moment of the load gains e x f. Both the forces
    (f_x, f_y, f_n) and the moments then turn with the frame. Cross-talk adds to an axis a part of the load on
    another, each over its range.
    """
    key, mix, mirror = sensor.drift_key, sensor.mix, sensor.mirror
    x, y = about(key, OFF_CENTRE, sensor.off_centre), about(key, OFF_CENTRE + 1, sensor.off_centre)
    a, b = about(key, TILT, sensor.tilt), about(key, TILT + 1, sensor.tilt)
    turned = (
        (math.cos(b), math.sin(a) * math.sin(b), math.cos(a) * math.sin(b)),
        (0.0, math.cos(a), -math.sin(a)),
        (-math.sin(b), math.sin(a) * math.cos(b), math.cos(a) * math.cos(b)),
    )
    arm = ((0.0, 0.0, y), (0.0, 0.0, -x), (-mirror * y, mirror * x, 0.0))
    for i in range(3):
        for j in range(3):
            moment = 0.0
            for k in range(3):
                moment += turned[i][k] * arm[k][j]
            mix[i, j], mix[i, 3 + j] = turned[i][j], 0.0
            mix[3 + i, j], mix[3 + i, 3 + j] = moment, turned[i][j]
    if sensor.crosstalk > 0.0:
        for j in range(LOAD_AXES):
            column = mix[0, j], mix[1, j], mix[2, j], mix[3, j], mix[4, j], mix[5, j]
            for i in range(LOAD_AXES):
                for k in range(LOAD_AXES):
                    if k != i:
                        part = about(key, CROSSTALK + LOAD_AXES * i + k, sensor.crosstalk)
                        mix[i, j] += part * sensor.range[i] / sensor.range[k] * column[k]


@compiled
def mixed(sensor: Any, load: Any, axis: int) -> float:
    """Reading of an axis of a sensor under a load (6,) on the finger at the pad's centre [N or N m]."""
    total = 0.0
    for k in range(LOAD_AXES):
        total += sensor.mix[axis, k] * load[k]
    return total
