"""Checks that a slowly growing load breaks the object away at the static limit ellipsoid."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from slipgym.validation.bench import Bench, Figure

BOUND = 1.0  # [%]
RATE = 0.02  # of the limit [1/s]
# The bristles give mu_s / sigma_0 = 0.5 um. From the limit on the excess load RATE * limit * t moves the
# mass by RATE * limit t^3 / (6 m): 2 um takes about 0.03 s, in which the ramp grows by 0.06 % of the limit.
BROKEN = 2e-6  # [m], scaled
WITHOUT_GRAVITY = {"physics": {"gravity": 0.0}}


def broken_away(bench: Bench) -> bool:
    """Whether the object has left the bristles' reach."""
    x, y, theta = bench.plant.world["slip"][0]
    return math.hypot(x, y, bench.friction.r * theta) > BROKEN


def ramp(
    direction: tuple[float, float, float], com_offset: tuple[float, float] = (0.0, 0.0), **options: Any
) -> float:
    """Load at break-away over mu_s sum f_n [-].

    The direction is that of the scaled load (f_x, f_z, tau / r) at the pad centre. The centre of mass (x, z)
    is `com_offset` from the pad centre [m].
    """
    unit = np.array(direction) / np.linalg.norm(direction)
    with Bench(WITHOUT_GRAVITY, com_offset=com_offset, **options) as bench:
        limit = bench.limit()
        f_x, f_z, scaled_torque = limit * unit
        torque = bench.friction.r * scaled_torque - (com_offset[0] * f_z - com_offset[1] * f_x)
        load = np.array([f_x, f_z, torque])
        bench.run(1.0, load=lambda t: 0.9 * t * load)
        trace = bench.run(10.0, load=lambda t: (0.9 + RATE * t) * load, until=broken_away)
        return float(np.linalg.norm(trace.load[-1]) / np.linalg.norm(load) * limit / bench.limit())


def release(eccentricity: float, **options: Any) -> float:
    """Scaled load of a weight on a lever over mu_s sum f_n, when a slowly opening grip releases it [-].

    The eccentricity is the distance of the centre of mass from the pads along x [m].
    """
    with Bench(com_offset=(eccentricity, 0.0), force=30.0, **options) as bench:
        load = bench.box.mass * bench.config.physics.gravity
        load *= math.hypot(1.0, eccentricity / bench.friction.r)
        start = load / (2.0 * bench.friction.mu_s) / 0.9
        bench.run(1.0, force=lambda _: start)
        bench.run(10.0, force=lambda t: start * (1.0 - RATE * t), until=broken_away)
        return load / bench.limit()


def breakaway(**options: Any) -> Iterator[Figure]:
    """Break-away against mu_s sum f_n in many directions."""
    loads = {
        "along x": (1.0, 0.0, 0.0),
        "down": (0.0, -1.0, 0.0),
        "oblique": (0.6, 0.8, 0.0),
        "torque": (0.0, 0.0, 1.0),
        "negative torque": (0.0, 0.0, -1.0),
        "force and torque": (0.5, -0.4, 0.77),
        "force, little torque": (-0.9, 0.3, 0.3),
    }
    for name, direction in loads.items():
        yield Figure(f"break-away, {name}", BOUND, 100.0 * abs(ramp(direction, **options) - 1.0), "%")
    off_centre = ramp((0.7, -0.5, 0.5), com_offset=(0.01, -0.02), **options)
    yield Figure("break-away, force and torque, eccentric mass", BOUND, 100.0 * abs(off_centre - 1.0), "%")
    for eccentricity in (0.0, 0.012):
        name = f"break-away, opening grip, lever {1e3 * eccentricity:.0f} mm"
        yield Figure(name, BOUND, 100.0 * abs(release(eccentricity, **options) - 1.0), "%")
