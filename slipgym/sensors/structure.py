"""Simulates one structural mode of a finger, between the load on its pad and what its sensor reads.

The fingertip is a mass on the spring of the finger and its sensor, which reads the spring's force x under the
load f (Eppinger & Seering, On dynamic models of robot force control, IEEE ICRA 1986):

    x'' + 2 zeta omega x' + omega^2 x = omega^2 f

on each of the six axes alike. f counts as straight between two samples, so that x is exact there: with the
change c per sample and lag = 2 zeta / omega in samples, x = f - lag c + d, where d vibrates freely.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from slipgym._numba.compiled import compiled
from slipgym.sensors.misalignment import LOAD_AXES

READ, RATE, LOAD = range(3)
"""Rows of a sensor's `swing`: x, its change per sample, f, at the newest sample; NaN before the first one."""


def mode(frequency: float, damping: float, period: float) -> tuple[float, ...]:
    """Returns the coefficients of a sample: the lag, and how d and its change follow from the last ones.

    The frequency is omega / 2 pi [Hz], the damping zeta is below 1, the period that of the samples [s].
    """
    omega, decay = math.tau * frequency * period, math.tau * frequency * period * damping
    turn = omega * math.sqrt(1.0 - damping**2)
    kept = math.exp(-decay)
    cos, sin = kept * math.cos(turn), kept * math.sin(turn) / turn
    return 2.0 * damping / omega, cos + decay * sin, sin, -(omega**2) * sin, cos - decay * sin


@compiled
def vibrate(sensor: Any, load: Any) -> None:
    """Replace the load (6,) of a sample by what the spring of a sensor with a mode bears [N, N m].

    Every sample comes once and in turn; the first is at rest.
    """
    lag, kept, gained, pulled, slowed = sensor.mode
    swing = sensor.swing
    first = math.isinf(swing[LOAD, 0])
    for a in range(LOAD_AXES):
        change = 0.0 if first else load[a] - swing[LOAD, a]
        away = 0.0 if first else swing[READ, a] - swing[LOAD, a] + lag * change
        speed = 0.0 if first else swing[RATE, a] - change
        swing[LOAD, a] = load[a]
        swing[READ, a] = load[a] - lag * change + kept * away + gained * speed
        swing[RATE, a] = change + pulled * away + slowed * speed
        load[a] = swing[READ, a]


@compiled
def forget(sensor: Any) -> None:
    """Let the next sample of a FORCE_TORQUE record be the first one."""
    if sensor.mode[0] > 0.0:
        sensor.swing[LOAD, 0] = np.inf
