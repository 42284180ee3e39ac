"""Measures the creep of a held object, with the gripper at rest and moving."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from slipgym.validation.bench import Bench, Figure, Friction, Signal

LEVEL = 0.8  # of the friction limit
DURATION = 60.0  # [s]
DISTANCE_BOUND = 1e-3  # [mm]
ANGLE_BOUND = 1e-3  # [deg]
GRAVITY = 9.81  # [m/s^2]
SWAY = np.array([4e-3, 4e-3, 0.05])  # amplitude of the moving wrist (x, z, pitch) [m, m, rad]
# what the sway adds to the load, at most: A omega^2 at 1 Hz is 1.6 % of g, the pitch acceleration
# 2 rad/s^2 on 5.3e-4 kg m^2 at r = 10 mm is 0.11 N, 5 % of the weight of 0.2 kg
SWAY_LOAD = 0.08


def sway(t: float) -> np.ndarray:
    """Wrist velocity of a smooth periodic motion that starts from rest, period 1 s."""
    return SWAY * 2.0 * math.pi * math.sin(2.0 * math.pi * t)


def grip_for(level: float, mass: float, eccentricity: float, friction: Friction) -> float:
    """Grip force per finger at which weight on a lever loads the pads to a level [N]."""
    load = mass * GRAVITY * math.hypot(1.0, eccentricity / friction.r)
    return load / (2.0 * friction.mu_s * level)


def drift(eccentricity: float, wrist: Signal | None = None, **bench: Any) -> tuple[float, float]:
    """Largest distance [mm] and rotation [deg] from where the object was after one second.

    Compared at whole seconds, at which the moving wrist, whose velocity has a period of 1 s, is at rest in
    its first pose and the load is the same. The eccentricity is the distance of the centre of mass from the
    pads along x [m].
    """
    friction, mass = Friction(), 0.2
    level = LEVEL if wrist is None else LEVEL / (1.0 + SWAY_LOAD)
    force = grip_for(level, mass, eccentricity, friction)
    com_offset = eccentricity, 0.0
    with Bench(force=force, friction=friction, mass=mass, com_offset=com_offset, **bench) as held:
        slip = held.run(1.0 + DURATION, wrist=wrist).slip
    rate = held.config.physics.control_rate
    moved = slip[rate - 1 :: rate] - slip[rate - 1]
    return 1e3 * np.hypot(moved[:, 0], moved[:, 1]).max(), math.degrees(np.abs(moved[:, 2]).max())


def creep(**bench: Any) -> Iterator[Figure]:
    """Creep at 80 % of the limit over 60 s, under weight, torque and both, at rest and moving."""
    cases = {
        "translation": (0.0, None),
        "mostly torque": (0.03, None),
        "both": (0.01, None),
        "translation, wrist swaying": (0.0, sway),
        "both, wrist swaying": (0.01, sway),
    }
    for name, (eccentricity, wrist) in cases.items():
        distance, angle = drift(eccentricity, wrist, **bench)
        yield Figure(f"creep, {name}", DISTANCE_BOUND, distance, "mm")
        yield Figure(f"creep, {name}", ANGLE_BOUND, angle, "deg")
