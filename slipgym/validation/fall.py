"""Checks that the object falls freely without grip."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from slipgym.validation.bench import Bench
from slipgym.validation.figure import Figure

BOUND = 0.1  # [%]
DURATION = 0.5  # [s]


def drop(**options: Any) -> float:
    """Distance fallen against g t^2 / 2 at every control step, largest difference [%]."""
    with Bench(force=0.0, **options) as bench:
        start = float(bench.plant.world["com"][0, 1])
        trace = bench.run(DURATION, force=lambda _: 0.0)
        parabola = 0.5 * bench.config.physics.gravity * trace.time**2
    away = np.abs((start - trace.position[:, 1]) / parabola - 1.0)
    return 100.0 * away.max()


def fall(**options: Any) -> Iterator[Figure]:
    """An object that nothing holds."""
    yield Figure("free fall without grip, from 1/120 s to 0.5 s", BOUND, drop(**options), "%")
