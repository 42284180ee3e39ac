"""Simulates a scenario: what the estimator of a finger gets, and the truth at the times of evaluation."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lab.worlds.body import simulate_body
from lab.worlds.course import simulate_course
from lab.worlds.scenario import BODY, Scenario
from lab.worlds.sensing import sample_steps, twists, wrenches
from lab.worlds.shown import Mark, marks
from lab.worlds.trace import COLUMNS, Trace

OPENED = 0.4
"""Time that the gripper is open at first, if it is [s]."""
FASTEST = 3.0
"""Speed of a body that has fallen out of the grip [m/s]."""


@dataclass(frozen=True)
class Record:
    """Samples of one finger."""

    t: NDArray[np.float64]
    """Time, (m,) [s]."""
    wrenches: NDArray[np.float64]
    """f_x, f_y, f_n, tau, (m, 4) [N, N, N, N m]."""
    twists: NDArray[np.float64]
    """v_x, v_y, omega, (m, 3) [m/s, m/s, rad/s]."""
    marks: list[Mark]
    """Where estimates are evaluated."""
    sound: bool
    """Whether the body stayed in the grip."""


def simulate(scenario: Scenario) -> Record:
    """The record of a scenario; the same bits whenever it is called.

    Args:
        scenario: The scenario.
    """
    trace, rng = simulate_trace(scenario), np.random.default_rng([scenario.seed, 3])
    sensors = scenario.sensors
    steps = sample_steps(trace, sensors, rng)
    t = (steps + 1) / trace.rate
    read, seen = (measured(trace, sensors, steps, rng) for measured in (wrenches, twists))
    finite = bool(np.isfinite(trace.values).all())
    sound = finite and float(np.abs(trace.twist[:, :2]).max()) <= FASTEST
    return Record(t, read, seen, marks(scenario, trace, steps), sound)


def simulate_trace(scenario: Scenario) -> Trace:
    """What truly happens in a scenario."""
    rng = np.random.default_rng([scenario.seed, 2])
    made = (simulate_body if scenario.motion in BODY else simulate_course)(scenario, rng)
    if not scenario.opened:
        return made
    empty = np.zeros((round(OPENED * made.rate), COLUMNS))
    empty[:, 10:] = made.truth[0]
    times = [OPENED + t for t in made.marks]
    return replace(made, values=np.vstack((empty, made.values)), marks=times, jump=OPENED + made.jump)
