"""Checks that friction in steady slip lies on the limit ellipsoid and opposes the scaled slip twist."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from slipgym.validation.bench import Bench, Figure, Trace

BOUND = 1.0  # [%]
MASS = 0.5  # [kg]
SPEEDS = 0.01, 0.15  # [m/s], scaled; the Stribeck part has decayed to exp(-100) at 10 v_s
DIRECTIONS = 13  # gamma_t from 1 to 0
AZIMUTH = 0.6  # [rad], of the force in the contact plane


def friction_and_twist(bench: Bench, trace: Trace) -> tuple[np.ndarray, np.ndarray]:
    """Friction on the object and slip twist at the pad centre, from the engine's motion alone.

    Friction is computed as the change of the rigid body's momentum less the load. The wrist
    must rest at the origin.

    Returns:
        Scaled friction (f_x, f_z, tau / r) [N] and twist (v_x, v_z, r omega) [m/s], both (n - 1, 3).
    """
    mass, inertia, r = bench.box.mass, bench.box.inertia, bench.friction.r
    rate = np.diff(trace.velocity, axis=0) / bench.step_time
    force = rate * (mass, mass, inertia) - trace.load[1:]
    velocity = 0.5 * (trace.velocity[1:] + trace.velocity[:-1])
    # both belong to times somewhat before the control step; so must the lever
    here = trace.position - bench.velocity_age * trace.velocity
    arm = 0.5 * (here[1:] + here[:-1])
    force[:, 2] += arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]
    velocity[:, 0] += velocity[:, 2] * arm[:, 1]
    velocity[:, 1] -= velocity[:, 2] * arm[:, 0]
    return force * (1.0, 1.0, 1.0 / r), velocity * (1.0, 1.0, r)


def ellipsoid(twist: np.ndarray) -> np.ndarray:
    """Scaled friction over mu_c f_n of the ellipsoid, opposing scaled twists, both (n, 3)."""
    return -twist / np.linalg.norm(twist, axis=1)[:, None]


def deviation(
    angle: float, sigma_2: float, law: Callable[[np.ndarray], np.ndarray] = ellipsoid, **options: Any
) -> tuple[float, np.ndarray]:
    """Largest distance of friction from its law while a constant load drags the object [% of mu_c sum f_n].

    The angle is that of the scaled load from translation to torque [rad]; `law` gives scaled friction over
    mu_c f_n at scaled twists, (n, 3) from (n, 3). The gamma_t of the samples are returned as well.
    """
    overrides = {"physics": {"gravity": 0.0}, "contact": {"sigma_2": sigma_2}}
    # inertia m r^2: the scaled mass is the same in all directions, the twist stays with the load
    with Bench(overrides, mass=MASS, inertia=MASS * 0.01**2, **options) as bench:
        r, mu_c = bench.friction.r, bench.friction.mu_c
        bench.settle()
        total = bench.plant.fingers["contact_force"].sum()
        size = 1.05 * bench.limit()
        f_t = size * math.cos(angle)
        load = f_t * math.cos(AZIMUTH), f_t * math.sin(AZIMUTH), size * r * math.sin(angle)
        trace = bench.run(0.15, load=lambda _: load)
    force, twist = friction_and_twist(bench, trace)
    speed = np.linalg.norm(twist, axis=1)
    sliding = (speed > SPEEDS[0]) & (speed < SPEEDS[1])
    force, twist = force[sliding], twist[sliding]
    expected = (mu_c * law(twist) - sigma_2 * twist) * total
    away = np.linalg.norm(force - expected, axis=1) / (mu_c * total)
    return 100.0 * away.max(), np.hypot(twist[:, 0], twist[:, 1]) / speed[sliding]


def steady(**options: Any) -> Iterator[Figure]:
    """Steady slip against the ellipsoid for gamma_t from 0 to 1."""
    for sigma_2 in (0.0, 0.2):
        found = [
            deviation(angle, sigma_2, **options) for angle in np.linspace(0.0, 0.5 * math.pi, DIRECTIONS)
        ]
        yield summary("steady slip", f"sigma_2 {sigma_2:g} s/m", found)


def summary(name: str, detail: str, found: Sequence[tuple[float, np.ndarray]]) -> Figure:
    """The largest of some deviations and the range of gamma_t that they cover."""
    gammas = np.concatenate([gamma for _, gamma in found])
    span = f"gamma_t {gammas.min():.2f} to {gammas.max():.2f}"
    return Figure(f"{name}, {span}, {detail}", BOUND, max(away for away, _ in found), "%")
