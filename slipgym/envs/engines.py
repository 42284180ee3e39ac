"""Chooses the engine that moves the bodies, and the simulation that runs on it."""

from __future__ import annotations

import logging
from collections.abc import Callable
from functools import cache
from importlib.util import find_spec
from typing import Any

from slipgym.envs.simulation import Simulation


def resolved(engine: str) -> str:
    """Return the engine that "auto" stands for: PyBullet where it is installed, else the planar engine.

    Args:
        engine: "auto", "bullet" or "planar"; the last two stand for themselves.
    """
    return _automatic() if engine == "auto" else engine


def simulation_of(engine: str) -> Callable[..., Simulation]:
    """Return the class of an engine's simulation; PyBullet is loaded on first use.

    Raises:
        ModuleNotFoundError: The engine is "bullet", and PyBullet is not installed.
    """
    if engine == "planar":
        from slipgym.envs.planar_simulation import PlanarSimulation

        return PlanarSimulation
    from slipgym.envs.bullet_simulation import BulletSimulation

    return BulletSimulation


@cache  # the line is said once per process
def _automatic() -> str:
    try:
        found: Any = find_spec("pybullet")
    except (ImportError, ValueError):
        found = None
    if found is not None:
        return "bullet"
    logging.getLogger("slipgym").warning(
        "PyBullet is not installed: environments run on the planar engine (engine='planar' asks for it "
        "without this line)"
    )
    return "planar"
