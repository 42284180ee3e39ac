"""Compares slides of the planar engine with PyBullet's."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from lab.validation.halving import ANGLE_BOUND, BOUND, DURATION
from slipgym.validation.bench import Bench, Figure, Friction

ENGINE = "planar"
SLIDES = 40
# Halving the steps may move a slide by 0.1 mm. An error of first order is twice that, on either engine, so
# that they may be 0.4 mm apart in the worst case; errors of equal sign cancel, hence half in the median.
DISTANCE_MEDIAN, DISTANCE = 2.0 * BOUND, 4.0 * BOUND  # [mm]
ANGLE_MEDIAN, ANGLE = 2.0 * ANGLE_BOUND, 4.0 * ANGLE_BOUND  # [deg]
SIZE = 0.08, 0.03, 0.4  # [m]


def slide(seed: int, engine: str) -> np.ndarray:
    """Slip displacement at the end of a slide of 5 s that sticks and slips, and usually turns; open loop.

    Object, friction and grip profile are sampled at random. The grip opens once to twice a second, to 85 to
    95 % of the force that holds the load at static friction.

    Args:
        seed: Seed of the random numbers.
        engine: "bullet" or "planar".

    Returns:
        (x, y, theta) [m, m, rad].
    """
    rng = np.random.default_rng(seed)
    mu_c, ratio, mass = rng.uniform(0.35, 0.45), rng.uniform(1.3, 1.6), rng.uniform(0.15, 0.3)
    friction = Friction(mu_s=ratio * mu_c, mu_c=mu_c)
    offset, rate = rng.uniform(-0.003, 0.003), rng.uniform(1.0, 2.0)
    needed = 0.5 * mass * 9.81 * math.hypot(1.0, offset / friction.r) / mu_c
    low, high = rng.uniform(0.85, 0.95) * needed / ratio, 2.0 * needed

    def grip(t: float) -> float:
        return high - (high - low) * max(0.0, math.sin(2.0 * math.pi * rate * t)) ** 4

    box = {"mass": mass, "com_offset": (offset, -0.01), "size": SIZE}
    with Bench(friction=friction, force=high, engine=engine, **box) as bench:
        bench.settle()
        return bench.run(DURATION, force=grip).slip[-1]


def slides(n: int = SLIDES) -> Iterator[Figure]:
    """Random slides, by the planar engine and by PyBullet."""
    away = np.array([np.abs(slide(seed, ENGINE) - slide(seed, "bullet")) for seed in range(n)])
    distance, angle = 1e3 * np.hypot(*away[:, :2].T), np.degrees(away[:, 2])
    rows = ("mm", distance, DISTANCE_MEDIAN, DISTANCE), ("deg", angle, ANGLE_MEDIAN, ANGLE)
    for unit, apart, median, most in rows:
        name = f"{ENGINE} against PyBullet, {n} slides"
        yield Figure(f"{name}, median", median, float(np.median(apart)), unit)
        yield Figure(f"{name}, 95 %", most, float(np.quantile(apart, 0.95)), unit)
