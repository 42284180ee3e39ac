"""The groups of scenarios; another one is one more function."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from policies.leaderboard.imperfect import jumps, sensor_errors, unknown_delay
from policies.leaderboard.rubber import anisotropic, drifts, load_dependent
from policies.leaderboard.scenario import Scenario
from policies.leaderboard.scenarios import (
    Effort,
    latency,
    noise,
    planar,
    pressure,
    profiles,
    spin_first,
    start_values,
    stick_slip,
)

GROUPS: tuple[Callable[[Effort], Iterator[Scenario]], ...] = (
    profiles,
    stick_slip,
    planar,
    start_values,
    spin_first,
    noise,
    pressure,
    latency,
    unknown_delay,
    sensor_errors,
    jumps,
    drifts,
    load_dependent,
    anisotropic,
)
