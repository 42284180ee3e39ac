"""Draws scenarios; the ranges are wider than those of slipgym's episodes."""

from __future__ import annotations

from typing import TypeVar

import numpy as np

from lab.worlds.friction import LARGEST_R, SIGMA_1, Law
from lab.worlds.scenario import BODY, Contact, Scenario, Sensors

T = TypeVar("T")
GROUPS = {"rigid": 0.5, "soft": 0.2, "load exponent": 0.15, "anisotropic": 0.15}
"""Kind of the pads -> chance [-]."""
MOTIONS = {"slide": 0.12, "spin": 0.08, "mixed": 0.22, "course": 0.23, "leaps": 0.25, "hinge": 0.10}
"""Motion -> chance [-]."""
SHAPES = {"disc": 0.4, "ellipsoid": 0.2, "hertz": 0.25, "ring": 0.15}
GRIPS = {"constant": 0.5, "steps": 0.25, "sine": 0.25}
VARIED = {"constant": 0.1, "steps": 0.45, "sine": 0.45}
"""`GRIPS` of pads whose friction depends on the load."""
RATES = {120: 0.55, 60: 0.15, 240: 0.15, 500: 0.15}
LATENCIES = {0: 0.2, 1: 0.4, 2: 0.15, 3: 0.15, 4: 0.1}
COUNTS = {7.94e-6: 0.6, 0.0: 0.3, 2.5e-5: 0.1}
"""Of 3200 and 1000 counts an inch, and none."""
COMPLIANCE = 0.5e-4, 2.5e-4
"""Of soft pads in shear, least and largest [m/N]."""
DIRTY = 0.5
"""Chance that a force sensor has constant errors [-]."""
ZERO, ZERO_TORQUE, DRIFT, TILT, GAIN, COP = 0.08, 5e-4, 0.005, 0.015, 0.015, 0.0006
"""Standard deviations of those errors [N, N m, N/s, rad, -, m]."""


class Dice:
    """Draws numbers of a seed.

    Args:
        seed: The seed, >= 0.
    """

    def __init__(self, seed: int) -> None:
        self.rng = np.random.default_rng([seed, 1])

    def between(self, low: float, high: float) -> float:
        """Uniform."""
        return float(self.rng.uniform(low, high))

    def scale(self, low: float, high: float) -> float:
        """Uniform in the logarithm."""
        return float(np.exp(self.rng.uniform(np.log(low), np.log(high))))

    def one_of(self, chances: dict[T, float]) -> T:
        """One of the keys."""
        return list(chances)[int(self.rng.choice(len(chances), p=list(chances.values())))]

    def happens(self, chance: float) -> bool:
        """Whether something of this chance happens."""
        return bool(self.rng.random() < chance)

    def normal(self, deviation: float) -> float:
        """Normal about 0."""
        return float(self.rng.normal(0.0, deviation))


def drawn(seed: int) -> Scenario:
    """The scenario of a seed.

    Args:
        seed: The seed, >= 0.
    """
    dice = Dice(seed)
    group, motion = dice.one_of(GROUPS), dice.one_of(MOTIONS)
    return Scenario(
        seed=seed,
        group=group,
        motion=motion,
        contact=_contact(dice, group, motion),
        sensors=_sensors(dice),
        normal=dice.scale(0.5, 40.0),
        grip=dice.one_of(VARIED if group == "load exponent" else GRIPS),
        opened=dice.happens(0.6),
        regrasp=dice.happens(0.2),
        rest=dice.between(2.0, 12.0) if dice.happens(0.2) else 0.3,
    )


def _contact(dice: Dice, group: str, motion: str) -> Contact:
    shape, mu_c, r = dice.one_of(SHAPES), dice.scale(0.1, 1.1), dice.scale(0.002, LARGEST_R)
    ratio = 1.0 + (dice.between(0.02, 0.5) if dice.happens(0.8) else 0.0)
    jump = dice.scale(np.exp(-0.5), np.exp(0.5)) if dice.happens(0.35) else 1.0
    jump_r = dice.scale(np.exp(-0.35), np.exp(0.35)) if dice.happens(0.15) else 1.0
    law = Law(
        stribeck=dice.scale(5e-4, 3e-3),
        sigma_0=dice.scale(5e4, 2e5),
        sigma_1=SIGMA_1,
        sigma_2=dice.between(0.0, 0.5) if dice.happens(2.0 / 3.0) else 0.0,
    )
    if group == "soft":
        law = law._replace(compliance=dice.scale(*COMPLIANCE))
    elif group == "load exponent":
        grows = dice.between(0.0, 1.0 / 3.0) if dice.happens(0.5) else 0.0
        law = law._replace(falls=dice.between(-0.4, 0.4), grows=grows)
    elif group == "anisotropic":
        law = law._replace(stretch=dice.between(-0.1, 0.1))
    return Contact(shape, mu_c, ratio, r, law, jump, 1.0 if motion in BODY else jump_r)


def _sensors(dice: Dice) -> Sensors:
    size = 1.0 if dice.happens(DIRTY) else 0.0
    zero_x, zero_y, zero_n = (dice.normal(ZERO * size) for _ in range(3))
    return Sensors(
        rate=dice.one_of(RATES),
        latency=dice.one_of(LATENCIES),
        noise=dice.scale(0.3, 4.0),
        count=dice.one_of(COUNTS),
        irregular=dice.happens(0.2),
        jitter=dice.between(0.05, 0.3) if dice.happens(0.2) else 0.0,
        lost=dice.between(0.01, 0.1) if dice.happens(0.25) else 0.0,
        sign=1 if dice.happens(0.5) else -1,
        zero=(zero_x, zero_y, zero_n, dice.normal(ZERO_TORQUE * size)),
        drift=(dice.normal(DRIFT * size), dice.normal(DRIFT * size)),
        tilt=(dice.normal(TILT * size), dice.normal(TILT * size)),
        gain=1.0 + dice.normal(GAIN * size),
        cop=(dice.normal(COP * size), dice.normal(COP * size)),
    )
