"""The scenarios, a function for each group; another one is a row of a function."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from itertools import product
from typing import Any

import numpy as np

import policies
from policies.leaderboard.profile_course import STEADY, STOP, disc, profile, slip
from policies.leaderboard.scenario import Run, Scenario, after, ends, in_slip, single
from policies.stepping import environment_for, steps
from slipgym.contact import DistributedContact
from slipgym.synthetic import Course, Record, Trace, integrate, sense

MU_C, MU_S, R = 0.40, 0.54, disc(0.012)
SPEED = 0.020  # scaled [m/s]
SIGMA = {"noise_tangential": 0.02, "noise_normal": 0.04, "noise_torque": 5e-4}  # [N, N, N m]
COUNT = 7.94e-6  # [m]


@dataclass(frozen=True)
class Effort:
    """Amount of what is run."""

    seeds: int = 20
    """Records of each course with noise of their own."""
    cells: int = 41
    """Cells of a patch, along either side."""
    materials: tuple[str, ...] = ("wood", "case", "plastic", "cardboard")
    trials: tuple[tuple[float, float], ...] = ((0.02, 2.0), (0.02, 5.0), (0.04, 2.0), (0.04, 5.0))
    """Distances [m] and durations [s] of the closed-loop trials."""
    forces: tuple[float, ...] = (5.0, 20.0)
    """Normal forces of the start-value grids [N]."""
    gammas: tuple[float, ...] = (0.5, 0.7, 0.9)
    """Shares of translation of the start-value grids [-]."""
    radii: int = 9
    """Start values of r in the grids."""
    exponents: tuple[tuple[float, float], ...] = ((0.15, 0.0), (0.31, 0.0), (0.0, 1 / 3), (0.31, 1 / 3))
    """Exponents of `slipgym.contact.soft_pad`: friction falls with the load, r grows with it."""
    anisotropies: tuple[float, ...] = (0.1, 0.2)
    """Friction along x is larger by this, along y smaller [-]."""
    seed: int = 0
    """Of the noise."""

    def sense(self, trace: Trace, config: Mapping[str, Any] | None = None) -> Record:
        """The trace as sensors of a configuration see it, with each seed."""
        return sense(trace, self.seeds, self.seed, config=config)


QUICK = Effort(2, 11, ("wood",), ((0.02, 2.0),), (5.0,), (0.7,), 3, ((0.31, 1.0 / 3.0),), (0.2,))


def effort_of(quick: bool, seed: int) -> Effort:
    """The effort of a run, or a short one for a test of the machinery; the seed of the noise."""
    return replace(QUICK if quick else Effort(), seed=seed)


def profiles(effort: Effort) -> Iterator[Scenario]:
    """The velocity profile of `slipgym reproduce profile`."""
    record = effort.sense(patch(profile(), effort.cells))
    evaluated = {
        "mu_c": ends(record, *(label for label in STEADY if label != "rotational")),
        "r": ends(record, *(label for label in STEADY if not label.startswith("linear"))),
        "mu_s": ends(record, STOP) & after(record, 1.0),
    }
    yield Scenario("profile", "disc", (Run(record, evaluated),))


def stick_slip(effort: Effort) -> Iterator[Scenario]:
    """Short slips while the force loop raises f_n: closed-loop trials, by material."""
    for material in effort.materials:
        traces = closed_loop(material, effort.trials)
        yield Scenario("stick-slip", material, tuple(late(trace, 1, effort) for trace in traces))


def planar(effort: Effort) -> Iterator[Scenario]:
    """Steady planar slip on a uniform disc, from the start values."""
    for gamma_t in (0.3, 0.5, 0.7, 0.9):
        record = effort.sense(patch(slip(rest(), "planar", 3.0, gamma_t, SPEED), effort.cells))
        yield single("planar", f"γ {gamma_t:g}", record, ends(record, "planar"))


def start_values(effort: Effort) -> Iterator[Scenario]:
    """Planar slip from a grid of start values."""
    for normal in effort.forces:
        yield grid("start values", rest(normal=normal), effort)


def spin_first(effort: Effort) -> Iterator[Scenario]:
    """The same after 1 s of spin, which shows only the product of mu_c and r."""
    for normal in effort.forces:
        yield grid("spin first", slip(rest(normal=normal), "rotational", 1.0, 0.0, SPEED), effort)


def noise(effort: Effort) -> Iterator[Scenario]:
    """The mixed course with the noise of the forces and the size of a count scaled, unknown to estimators."""
    trace = patch(mixed(), effort.cells)
    for scale in (0.5, 1.0, 2.0, 4.0):
        force = {name: scale * sd for name, sd in SIGMA.items()}
        config = {"sensors": {"force_torque": force, "slip": {"count": scale * COUNT}}}
        record = effort.sense(trace, config)
        yield Scenario("noise", f"× {scale:g}", (Run(record, mixed_judged(record)),))


def pressure(effort: Effort) -> Iterator[Scenario]:
    """The mixed course under other pressure profiles with the same r."""
    for name in ("uniform", "hertz", "rim"):
        record = effort.sense(patch(mixed(), effort.cells, name))
        yield Scenario("pressure", name.replace("hertz", "Hertz"), (Run(record, mixed_judged(record)),))


def latency(effort: Effort) -> Iterator[Scenario]:
    """Stick-slip in wood with another age of the velocity, known to the estimator, and once not known."""
    for samples, assumed in ((0, 0), (1, 1), (2, 2), (3, 3), (2, 1)):
        name = f"{samples}" if assumed == samples else f"{samples}, set to {assumed}"
        runs = tuple(late(trace, samples, effort) for trace in closed_loop("wood", effort.trials))
        yield Scenario("latency" if assumed == samples else "wrong latency", name, runs, assumed)


def rest(**values: float) -> Course:
    """A patch at rest."""
    return Course.start(**{"mu_c": MU_C, "mu_s": MU_S, "r": R, **values}).to(STOP, 0.25)


def turning(duration: float, rate: float = 1.0, gamma_t: float = 0.7) -> Course:
    """Planar slip [s] of a constant scaled speed whose direction turns at a rate [rad/s], in chords of 0.1 s.

    `gamma_t` is the fraction of translation [-].
    """
    course, omega = rest(), math.sqrt(1.0 - gamma_t**2) * SPEED / R
    for k in range(round(10 * duration) + 1):
        angle = 0.1 * rate * k
        v_x, v_y = gamma_t * SPEED * math.cos(angle), gamma_t * SPEED * math.sin(angle)
        course = course.to("planar", 0.25 if k == 0 else 0.1, v_x=v_x, v_y=v_y, omega=omega)
    return course


def mixed() -> Course:
    """One slip of each kind."""
    course = slip(rest(), "linear", 1.0, 1.0, SPEED)
    return slip(slip(course, "rotational", 1.0, 0.0, SPEED), "planar", 2.0, 0.7, SPEED)


def mixed_judged(record: Record) -> dict[str, np.ndarray]:
    """Instants at which estimates of the mixed course are evaluated."""
    stops = ends(record, STOP) & after(record, 1.0)
    return {
        "mu_c": ends(record, "linear", "planar"),
        "r": ends(record, "rotational", "planar"),
        "mu_s": stops,
    }


@cache
def patch(course: Course, cells: int, pressure: str = "uniform", anisotropy: float = 0.0) -> Trace:
    """The trace of a distributed contact."""
    return integrate(course, DistributedContact(cells=cells, pressure=pressure, anisotropy=anisotropy))


def grid(group: str, course: Course, effort: Effort) -> Scenario:
    """2 s of planar slip after a course, from the truth as the start value and from a grid of others."""
    radii, frictions = np.geomspace(0.002, 0.040, effort.radii), (0.2, 0.6, 1.3)
    values = np.array([(R, MU_C), *product(radii, frictions)])
    runs = []
    for gamma_t in effort.gammas:
        trace = patch(slip(course, "planar", 2.0, gamma_t, SPEED), effort.cells)
        record = sense(trace, len(values), effort.seed)
        end = ends(record, "planar")
        runs.append(Run(record, {"mu_c": end, "r": end}))
    starts = {"r0": values[:, 0], "mu_c0": values[:, 1]}
    return Scenario(group, f"{course.points[-1].normal:g} N", tuple(runs), starts=starts)


@cache
def closed_loop(material: str, trials: tuple[tuple[float, float], ...]) -> tuple[Trace, ...]:
    """A closed-loop trial for each distance and duration."""
    return tuple(linear_slip_trace(material, *trial, seed) for seed, trial in enumerate(trials))


def late(trace: Trace, samples: int, effort: Effort) -> Run:
    """A closed-loop trial with velocities of an age [samples]."""
    return in_slip(effort.sense(trace, {"sensors": {"slip": {"latency_samples": samples}}}))


def linear_slip_trace(material: str, distance: float, duration: float, seed: int) -> Trace:
    """A trial of slipgym/LinearSlip-v0 under its controller, which knows the true friction.

    So the motion is the same whatever an estimator says. The contact is the distributed one: a
    uniform disc, as everywhere in the leaderboard. The distance is in [m], the duration in [s].

    Returns:
        What finger 1 truly felt and saw, at 120 Hz; the phase is "slip" where a sample moved on average
        faster than 1 mm/s, and "stick" elsewhere.
    """
    controller = policies.make("linear_slip_continuous")
    arguments = {"friction_source": "true", "contact": "distributed", "material": material}
    with environment_for(controller, "slipgym/LinearSlip-v0", **arguments) as env:
        observation, first = env.reset(seed=seed, options={"distance": distance, "duration": duration})
        infos = [step.info for step in steps(env, controller, observation)]
    t = np.array([info["time"] for info in infos])
    motion = np.diff([info["slip"] for info in [first, *infos]], axis=0)
    speed = np.hypot(*motion[:, :2].T) / np.diff(t, prepend=0.0)
    mu_s, mu_c, r = (np.full(len(t), value) for value in first["true"])
    return Trace(
        t=t,
        wrench=np.array([info["contact_wrench"][0] for info in infos]),
        normal=np.array([info["grip_force"][0] for info in infos]),
        twist=np.array([info["slip_twist"] for info in infos]),
        motion=motion,
        mu_s=mu_s,
        mu_c=mu_c,
        r=r,
        phase=np.where(speed > 1e-3, "slip", "stick"),
    )
