"""Makes streams of a gripper's readings, and adds the faults of sensors and networks."""

from __future__ import annotations

import heapq
import math
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

FORCE, VELOCITY = 1000, 120
_BLOCK = 10  # s

Reading = tuple[str, float, list[float]]
"""Kind, stamp [s], values."""


def readings(seconds: float, seed: int = 0, width: int = 6) -> Iterator[Reading]:
    """One finger that slides, sticks and turns, in order of time.

    Args:
        seconds: Length [s].
        seed: Of the noise.
        width: Numbers of a wrench: 4, or 6 with tilting torques.
    """
    rng = np.random.default_rng(seed)
    for begin in range(0, math.ceil(seconds), _BLOCK):
        length = min(_BLOCK, seconds - begin)
        t = _times(begin, length, FORCE)
        f_n = 5.0 + np.sin(3.0 * t)
        load = np.where(_slides(t), 0.4, 0.25) * f_n
        wrench = np.column_stack((0.9 * load, 0.1 * load, f_n, 0.002 * load, 0.001 * f_n, -0.0005 * f_n))
        wrench += rng.normal(0.0, 0.01, wrench.shape) * [1, 1, 1, 1e-3, 1e-3, 1e-3]
        s = _times(begin, length, VELOCITY) + 0.0003
        moves = np.array([0.02, 0.002, 0.5]) + rng.normal(0.0, 1e-3, (len(s), 3))
        twist = np.where(_slides(s)[:, None], moves, 0.0)
        block = [("wrench", *row) for row in zip(t.tolist(), wrench[:, :width].tolist(), strict=True)]
        block += [("twist", *row) for row in zip(s.tolist(), twist.tolist(), strict=True)]
        yield from sorted(block, key=lambda reading: reading[1])


def _times(begin: int, length: float, rate: int) -> np.ndarray:
    return np.arange(begin * rate, begin * rate + round(length * rate)) / rate


def _slides(t: np.ndarray) -> np.ndarray:
    return np.sin(np.pi * t) > 0.0


def faulty(
    given: Iterable[Reading], seed: int = 0, lateness: float = 0.002, offset: float = 0.0
) -> Iterator[tuple[str, float, list[float], float]]:
    """The readings with their arrival [s]: some drop, come twice, are NaN, out of order, late, or in bursts.

    Args:
        given: In order of time.
        seed: Of the faults.
        lateness: Delays stay within it, but for one in 500 [s].
        offset: Of the clock of the velocities [s].
    """
    rng = np.random.default_rng(seed)
    sent: list[tuple[float, int, Any]] = []
    for k, (kind, t, values) in enumerate(given):
        while sent and sent[0][0] <= t:
            yield heapq.heappop(sent)[2]
        draws = rng.random(5)
        if draws[0] < 0.01:
            continue
        values = [float("nan"), *values[1:]] if draws[1] < 0.002 else values
        arrival = t + 0.01 + 0.9 * lateness * draws[2] + 10.0 * lateness * (draws[3] < 0.002)
        if int(arrival) % 5 == 4 and arrival % 1.0 < 0.03:  # all of 30 ms comes at once
            arrival = int(arrival) + 0.03
        for copy in range(1 + (draws[4] < 0.005)):
            row = (kind, t + offset * (kind == "twist"), values, arrival)
            heapq.heappush(sent, (arrival, 2 * k + copy, row))
    while sent:
        yield heapq.heappop(sent)[2]


def feed(live: Any, given: Iterable[tuple], finger: int = 1) -> list[Any]:
    """All outputs of a stream of (kind, stamp, values) or (kind, stamp, values, arrival)."""
    outputs = []
    for kind, t, values, *arrival in given:
        take = live.feed_wrench if kind == "wrench" else live.feed_twist
        outputs += take(finger, t, values, arrival[0] if arrival else t)
    return outputs
