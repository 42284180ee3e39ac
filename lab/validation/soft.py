"""Checks the laws of soft pads against their closed forms."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from slipgym.validation.bench import Bench, Figure, Friction

BOUND = 1.0  # [%]
FRICTION = Friction(mu_s=0.6, mu_c=0.4, r=0.008)
GRIP = 5.0  # [N], the reference force
LOAD_EXPONENT, RADIUS_EXPONENT, ANISOTROPY = 0.31, 1.0 / 3.0, 0.2
SHEAR = {"shear_compliance": 5e-5, "shear_time": 2e-3, "creep": 0.4, "creep_time": 0.3}
AGING = {"aging": 0.1, "aging_time": 0.05}
SIZE = 0.4, 0.03, 0.8  # [m]


def bench(pad: dict[str, float], force: float = GRIP, **options: Any) -> Bench:
    """A box without gravity and without viscous friction, on pads with some parameters."""
    overrides = {"physics": {"gravity": 0.0}, "contact": {"pad": pad, "sigma_2": 0.0}}
    return Bench(overrides, friction=FRICTION, force=force, size=SIZE, **options)


def slide(held: Bench, load: tuple[float, float, float], duration: float = 0.1) -> np.ndarray:
    """Friction of both pads (f_x, f_y, tau) at the end of a slide under a load [N, N, N m]."""
    held.settle()
    held.run(duration, load=lambda _: load)
    return held.plant.pads["wrench"][0].sum(axis=0)


def by_load(force: float, **options: Any) -> float:
    """Error of the sliding friction at a normal force, over it [-]."""
    expected = 2.0 * FRICTION.mu_c * force * (force / GRIP) ** -LOAD_EXPONENT
    with bench({"load_exponent": LOAD_EXPONENT}, force, **options) as held:
        push = 1.3 * expected * FRICTION.mu_s / FRICTION.mu_c
        return abs(float(slide(held, (push, 0.0, 0.0))[0]) / expected + 1.0)


def by_size(force: float, **options: Any) -> float:
    """Error of the torque in pure spin at a normal force, over it [-]."""
    with bench({"radius_exponent": RADIUS_EXPONENT}, force, inertia=1e-4, **options) as held:
        radius = FRICTION.r * (force / GRIP) ** RADIUS_EXPONENT
        radius = min(radius, float(held.plant.pads["radius_max"][0, 0]))
        expected = 2.0 * FRICTION.mu_c * force * radius
        push = 1.3 * expected * FRICTION.mu_s / FRICTION.mu_c
        return abs(float(slide(held, (0.0, 0.0, push))[2]) / expected + 1.0)


def sheared(**options: Any) -> float:
    """Largest error of the displacement in 1 s under a constant force, once still, over its end [-]."""
    with bench(SHEAR, **options) as held:
        held.settle()
        start = held.plant.world["slip"][0, 0]
        trace = held.run(1.0, load=lambda _: (1.5, 0.0, 0.0))
    t = trace.time[12:] - trace.time[0] + held.step_time
    lasting = 1.0 - SHEAR["creep"]
    crept = SHEAR["creep"] / lasting * (1.0 - np.exp(-lasting * t / SHEAR["creep_time"]))
    expected = 0.5 * 1.5 * SHEAR["shear_compliance"] * (1.0 + crept)
    return float(np.abs(trace.slip[12:, 0] - start - expected).max() / expected[-1])


def aged(dwell: float, **options: Any) -> float:
    """Error of the load at break-away after a dwell time [s], over it [-]."""
    with bench(AGING, **options) as held:
        held.settle()
        rest = float(held.plant.pads["dwell"][0, 0])
        held.run(dwell, load=lambda _: (4.0, 0.0, 0.0))
        trace = held.run(
            2.0,
            load=lambda t: (4.0 + 2.0 * t, 0.0, 0.0),
            until=lambda b: abs(b.plant.world["slip"][0, 0]) > 3e-6,
        )
    total = rest + dwell + trace.time[-1] - trace.time[0]
    grown = 1.0 + AGING["aging"] * math.log1p(total / AGING["aging_time"])
    expected = 2.0 * GRIP * (FRICTION.mu_c + (FRICTION.mu_s - FRICTION.mu_c) * grown)
    return abs(float(trace.load[-1, 0]) / expected - 1.0)


def uneven(**options: Any) -> float:
    """Error of the sliding friction on anisotropic pads as a vector, over it [-]."""
    with bench({"anisotropy": ANISOTROPY}, inertia=1.0, **options) as held:
        friction = slide(held, (5.0, 6.0, 0.0), 0.15)[:2]
        v_x, v_y, _ = held.plant.world["slip_twist"][0]
    a, b = 1.0 + ANISOTROPY, 1.0 - ANISOTROPY
    direction = np.array([a * a * v_x, b * b * v_y]) / math.hypot(a * v_x, b * v_y)
    expected = -2.0 * FRICTION.mu_c * GRIP * direction
    return float(np.linalg.norm(friction - expected) / np.linalg.norm(expected))


def soft() -> Iterator[Figure]:
    """Load, size, shear and creep, dwell time and anisotropy, on both engines."""
    for engine in ("bullet", "planar"):
        rows = {
            "friction at 1 and 12 N": max(by_load(force, engine=engine) for force in (1.0, 12.0)),
            "torque at 1 and 12 N": max(by_size(force, engine=engine) for force in (1.0, 12.0)),
            "shear and creep": sheared(engine=engine),
            "break-away after 0.5 and 4 s": max(aged(dwell, engine=engine) for dwell in (0.5, 4.0)),
            "anisotropic friction": uneven(engine=engine),
        }
        for name, error in rows.items():
            yield Figure(f"soft pads, {engine}: {name}", BOUND, 100.0 * error, "%")
