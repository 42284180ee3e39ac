"""Describes the motion of the object that a task asks for."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np


@dataclass(frozen=True)
class Motion:
    """One coordinate of the slip and its reference; for pictures, tables and figures."""

    label: str = "slid"
    """What it is."""
    unit: Literal["m", "rad"] = "m"
    """Its unit."""
    axis: tuple[float, float, float] | None = None
    """Weights of the slip displacement (x, y, theta); None: the distance from the grasp."""
    sign: float = 1.0
    """Factor from the episode's reference position to the coordinate's target."""
    entry: int = 0
    """Index of the position in the episode's reference."""
    goal: str = ""
    """Column of the task's observation with the end of the reference; none if the reference is 0."""

    body: Literal["box", "bottle", "tool"] = "box"
    """What the object is drawn as, within the box that is simulated."""
    end: Callable[[Any], tuple[float, float, float]] | None = None
    """Slip displacement (x, y, theta) that the task asks for [m, m, rad], of an EPISODE record, as pictures
    show it; None: none but that at the grasp."""

    @property
    def title(self) -> str:
        """Name of the coordinate, with the unit it is shown in."""
        return f"{self.label} [{'mm' if self.unit == 'm' else '°'}]"

    @property
    def scale(self) -> float:
        """From its unit to the one it is shown in, mm or degrees."""
        return 1e3 if self.unit == "m" else math.degrees(1.0)

    def path(self, slip: np.ndarray) -> np.ndarray:
        """Coordinate of the object.

        Args:
            slip: Slip displacement (x, y, theta), (..., 3) [m, m, rad].

        Returns:
            (...) [mm or degrees].
        """
        if self.axis is None:
            return self.scale * np.hypot(slip[..., 0], slip[..., 1])
        return self.scale * (slip @ np.array(self.axis))

    def pose(self, episode: Any) -> tuple[float, float, float] | None:
        """Slip displacement that an episode asks for, see `end`."""
        return None if self.end is None else self.end(episode)

    def target(self, reference: Any) -> Any:
        """Target of the coordinate [mm or degrees], from the reference position [m or rad]."""
        return self.sign * self.scale * reference
