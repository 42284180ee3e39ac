"""Checks the disc, the contact whose limit surface is a table of the exact one."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from slipgym.validation.breakaway import BOUND, ramp
from slipgym.validation.creep import DISTANCE_BOUND, drift, sway
from slipgym.validation.distributed import DIRECTIONS, LOADS, THROWS, limit
from slipgym.validation.distributed import disc as exact
from slipgym.validation.energy import slide, throw
from slipgym.validation.figure import Figure
from slipgym.validation.halving import compare, stick_slip_grip
from slipgym.validation.steady import deviation, summary

MODEL = "disc"


def disc(**options: Any) -> Iterator[Figure]:
    """Creep, break-away, steady slip, energy and halved steps."""
    options = {"contact": MODEL, **options}
    distance, _ = drift(0.01, sway, **options)
    yield Figure(f"{MODEL}: creep, both, wrist swaying", DISTANCE_BOUND, distance, "mm")
    for name, direction in LOADS.items():
        away = ramp(direction, **options) / limit(direction) - 1.0
        yield Figure(f"{MODEL}: break-away, {name}", BOUND, 100.0 * abs(away), "%")
    angles = np.linspace(0.0, 0.5 * math.pi, DIRECTIONS)
    yield summary(
        f"{MODEL}: steady slip", "disc", [deviation(angle, 0.0, exact, **options) for angle in angles]
    )
    rises = [throw(seed, vary, **options)[0] for seed in range(THROWS) for vary in (False, True)]
    yield Figure(f"{MODEL}: energy gained, random throws", 1.0, max(rises), "store")
    rises = [slide(seed, **options) for seed in range(THROWS)]
    yield Figure(f"{MODEL}: energy gained, slipping and sticking", 1.0, max(rises), "store")
    name = f"{MODEL}: halved step, stick-slip and turning"
    yield from compare(name, stick_slip_grip, (0.003, -0.01), **options)
