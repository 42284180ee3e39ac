"""Which motion of the object a task is about."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from slipgym.tasks import Task


@dataclass(frozen=True)
class Motion:
    """One coordinate of the slip, and where it should be."""

    title: str
    """What it is, with its unit."""
    path: Callable[[np.ndarray], float]
    """From the slip displacement (x, y, theta) [m, m, rad]."""
    target: Callable[[float], float]
    """From the episode's reference position."""
    goal: str = ""
    """Column of the task's observation that says where the reference ends; none if it stays at 0."""
    axis: int = 0
    """Which entry of the episode's reference is its position."""


def motion_of(task: Task) -> Motion:
    """What the columns of a task's observation say that it is about."""
    units = {column.name: column.unit for column in task.columns}
    if units.get("reference_position") == "m":
        return Motion("slid down [mm]", lambda s: -1e3 * s[1], _millimetres, "distance")
    if units.get("reference_position") == "rad":
        return Motion("turned by gravity [°]", lambda s: -math.degrees(s[2]), math.degrees, "angle")
    if "wrist_pitch_goal" in units:  # what hangs upright turns against the wrist
        return Motion(
            "turned in the grip [°]",
            lambda s: math.degrees(s[2]),
            lambda pitch: -math.degrees(pitch),
            "wrist_pitch_goal",
        )
    if "target_theta" in units:
        return Motion(
            "turned in the grip [°]", lambda s: math.degrees(s[2]), math.degrees, "target_theta", axis=2
        )
    return Motion("slid [mm]", lambda s: 1e3 * math.hypot(s[0], s[1]), _millimetres)


def _millimetres(metres: float) -> float:
    return 1e3 * metres
