"""Scenarios of a real gripper: unknown errors, friction that jumps, drifts or is no constant."""

from __future__ import annotations

import math
from collections.abc import Iterator

from policies.leaderboard.imperfections import Imperfections, impaired
from policies.leaderboard.scenario import Scenario, after, in_slip, single
from policies.leaderboard.scenarios import MU_C, MU_S, Effort, R, closed_loop, patch, turning
from slipgym.synthetic import Course

AT_ONCE = {"sensors": {"slip": {"latency_samples": 0}}}
DELAYS = ((0, 0.0), (1, 0.3), (2, 0.0), (2, 0.3))
"""Age of the velocities [samples] and fraction of them that are one older still."""
ERRORS = {
    "zero 0.1 N": Imperfections(velocity_delay=1, zero=0.1),
    "zero 0.2 N": Imperfections(velocity_delay=1, zero=0.2),
    "tilt 1°": Imperfections(velocity_delay=1, tilt=math.radians(1.0)),
    "tilt 2°": Imperfections(velocity_delay=1, tilt=math.radians(2.0)),
    "CoP 1 mm": Imperfections(velocity_delay=1, cop=0.001),
    "CoP 2 mm": Imperfections(velocity_delay=1, cop=0.002),
    "all": Imperfections(velocity_delay=1, zero=0.2, tilt=math.radians(2.0), cop=0.002),
}


def unknown_delay(effort: Effort, material: str = "wood") -> Iterator[Scenario]:
    """Stick-slip with velocities of an age that no estimator is given; one sample is nominal."""
    for delay, jitter in DELAYS:
        runs = []
        for k, trace in enumerate(closed_loop(material, effort.trials)):
            exact, errors = effort.sense(trace, AT_ONCE), Imperfections(velocity_delay=delay, jitter=jitter)
            runs.append(in_slip(impaired(exact, errors, effort.seed + k)))
        yield Scenario("unknown delay", f"{delay}, jitter {100 * jitter:.0f} %", tuple(runs))


def sensor_errors(effort: Effort) -> Iterator[Scenario]:
    """3 s of planar slip whose direction turns by 1 rad/s, seen by sensors with constant errors."""
    exact = effort.sense(patch(turning(3.0), effort.cells), AT_ONCE)
    late = after(exact, exact.t[-1] - 0.25)
    for name, imperfections in ERRORS.items():
        yield single("sensor errors", name, impaired(exact, imperfections, effort.seed), late)


def jumps(effort: Effort) -> Iterator[Scenario]:
    """Steady planar slip in which mu_c jumps; evaluated from 0.3 s later to the end."""
    for factor in (0.7, 1.35):
        course = turning(2.0, 0.0).to("planar", 1e-3, mu_c=factor * MU_C, mu_s=factor * MU_S)
        record = effort.sense(patch(course.to("planar", 1.0), effort.cells))
        yield single("jump", f"× {factor:g}", record, after(record, course.times[-1] + 0.3))


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
