"""Scenarios of pads whose friction is no constant: it drifts, depends on the load or on the direction."""

from __future__ import annotations

import math
from collections.abc import Iterator

from policies.leaderboard.scenario import Scenario, after, single
from policies.leaderboard.scenarios import MU_C, MU_S, Effort, R, patch, turning
from slipgym.synthetic import Course

DRIFTS = (0.7, 1.35)
"""Factor of the friction at the end of a drift; those of the group "jump"."""
DRIFT_TIME = 2.0  # [s]
LOAD, SWING, PERIOD = 5.0, 0.5, 1.5
"""Mean normal force [N], its amplitude over the mean [-], its period [s]."""


def drifts(effort: Effort) -> Iterator[Scenario]:
    """Planar slip in which friction changes steadily over 2 s; evaluated from 0.3 s on."""
    for factor in DRIFTS:
        steady = turning(1.0, 0.0)
        course = steady.to("planar", DRIFT_TIME, mu_c=factor * MU_C, mu_s=factor * MU_S)
        record = effort.sense(patch(course, effort.cells))
        yield single("drift", f"× {factor:g}", record, after(record, steady.times[-1] + 0.3))


def load_dependent(effort: Effort) -> Iterator[Scenario]:
    """Planar slip that turns while the normal force swings; the truth is that at the load of the sample."""
    for friction, radius in effort.exponents:
        record = effort.sense(patch(swinging(friction, radius), effort.cells))
        names = [f"μ a {friction:g}"] * (friction > 0.0) + ["r ⅓"] * (radius > 0.0)
        yield single("load", ", ".join(names), record, after(record, record.t[-1] - PERIOD))


def anisotropic(effort: Effort) -> Iterator[Scenario]:
    """Planar slip that turns by half a circle, evaluated all over it; the truth is the mean of both axes."""
    for anisotropy in effort.anisotropies:
        record = effort.sense(patch(turning(1.0 + math.pi), effort.cells, anisotropy=anisotropy))
        late = after(record, record.t[-1] - math.pi)
        yield single("anisotropy", f"± {100 * anisotropy:.0f} %", record, late)


def swinging(friction: float, radius: float) -> Course:
    """3 s of `turning` under a normal force that swings; friction and r follow it.

    mu falls with the normal force to the power of `friction`, r grows with it to the power of `radius` [-].
    """
    course = turning(3.0)
    points = list(course.points)
    for k, t in enumerate(course.times):
        ratio = 1.0 + SWING * math.sin(2.0 * math.pi * t / PERIOD)
        scale = ratio**-friction
        changes = {"mu_c": scale * MU_C, "mu_s": scale * MU_S, "r": R * ratio**radius}
        points[k] = points[k]._replace(normal=LOAD * ratio, **changes)
    return Course(course.times, tuple(points), course.labels)
