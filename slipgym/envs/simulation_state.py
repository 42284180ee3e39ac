"""State of a simulation as plain data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from slipgym.world.plant import Plant
from slipgym.world.scene import Box
from slipgym.world.snapshot import EngineState


@dataclass(frozen=True)
class SimulationState:
    """State of a `Simulation` between two control steps, as plain data."""

    engine: EngineState | None
    """Bodies in PyBullet; None for the planar engine."""
    plant: Plant
    """Worlds, pads, fingers and sensors."""
    arrays: Mapping[str, np.ndarray]
    """Estimators, episodes, and their last outputs, by name."""
    materials: list[str]
    """Name of every episode's material."""
    boxes: list[Box]
    """Every episode's object."""
