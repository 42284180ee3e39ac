"""Checks that friction dissipates energy and never adds any, and that an object falls freely without grip."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from slipgym.validation.bench import Bench, Figure, Signal, Trace

THROWS = 8
SIZE = 0.3, 0.03, 0.3  # [m]; the pads stay on it
LONG = 0.3, 0.03, 0.6  # [m]
SLIDE_GRIPS = 1.75, 6.0  # [N]; 2 N lets the weight slide
INERTIA = 2e-4  # [kg m^2]; small, so that it spins
GRIP = 5.0  # [N]
GRIP_RANGE = 1.0, 10.0  # [N]
PUSH_TIME = 0.05  # [s]
FREE_TIME = 0.5  # [s]
FALL_BOUND = 0.1  # [%]
FALL_TIME = 0.5  # [s]


def energies(bench: Bench, trace: Trace) -> np.ndarray:
    """Kinetic and potential energy of the object half an engine step before each row (n,) [J].

    The engine's velocity is the mean over its last step, so it belongs to that time.
    """
    box, gravity = bench.box, bench.config.physics.gravity
    x, z, omega = trace.velocity.T
    height = trace.position[:, 1] - bench.velocity_age * z
    return 0.5 * (box.mass * (x * x + z * z) + box.inertia * omega * omega) + box.mass * gravity * height


def largest_rise(energy: np.ndarray) -> float:
    """Largest rise of a signal above what it was at any time before."""
    return float((energy - np.minimum.accumulate(energy)).max())


def elastic_store(bench: Bench, force: float) -> float:
    """Energy that the bristles of both pads hold at the static limit [J]."""
    return 2.0 * force * bench.friction.mu_s**2 / (2.0 * bench.config.contact.sigma_0)


def throw(seed: int, vary_grip: bool, **options: Any) -> tuple[float, float]:
    """Push an object in zero gravity, let it slide and spin until it rests.

    Returns:
        Largest rise of its energy after the push over the elastic energy of the bristles at the
        largest grip [-]; and its energy at the end of the push [J].
    """
    rng = np.random.default_rng(seed)
    direction = rng.normal(size=3)
    grips = rng.uniform(*GRIP_RANGE, 1000)
    with Bench({"physics": {"gravity": 0.0}}, force=GRIP, size=SIZE, inertia=INERTIA, **options) as bench:
        grip: Signal = (lambda t: grips[round(t / bench.step_time)]) if vary_grip else (lambda _: GRIP)
        bench.settle()
        push = 2.0 * bench.limit() * direction / np.linalg.norm(direction) * (1.0, 1.0, bench.friction.r)
        bench.run(PUSH_TIME, load=lambda _: push, force=grip)
        bench.run(bench.step_time, force=grip)  # the engine follows half a step late
        energy = energies(bench, bench.run(FREE_TIME, force=grip))
        return largest_rise(energy) / elastic_store(bench, GRIP_RANGE[1]), energy[0]


def slide(seed: int, **options: Any) -> float:
    """Rise of the energy while weight drags the object through sticking and slipping.

    Returns:
        Largest rise over the elastic energy of the bristles at the largest grip [-].
    """
    low, high = SLIDE_GRIPS
    grips = np.repeat(np.random.default_rng(seed).uniform(low, high, 100), 12)
    with Bench(force=high, com_offset=(0.004, 0.0), size=LONG, **options) as bench:
        bench.settle()
        energy = energies(bench, bench.run(2.0, force=lambda t: grips[round(t / bench.step_time)]))
        return largest_rise(energy) / elastic_store(bench, high)


def energy(**options: Any) -> Iterator[Figure]:
    """Rise of the energy against what the bristles can store."""
    for vary_grip, name in ((False, "constant grip"), (True, "varying grip")):
        rises = [throw(seed, vary_grip, **options)[0] for seed in range(THROWS)]
        yield Figure(f"energy gained, {THROWS} random throws, {name}", 1.0, max(rises), "store")
    rises = [slide(seed, **options) for seed in range(THROWS)]
    yield Figure("energy gained, weight, slipping and sticking", 1.0, max(rises), "store")


def drop(**options: Any) -> float:
    """Distance fallen against g t^2 / 2 at every control step, largest difference [%]."""
    with Bench(force=0.0, **options) as bench:
        start = float(bench.plant.world["com"][0, 1])
        trace = bench.run(FALL_TIME, force=lambda _: 0.0)
        parabola = 0.5 * bench.config.physics.gravity * trace.time**2
    away = np.abs((start - trace.position[:, 1]) / parabola - 1.0)
    return 100.0 * away.max()


def fall(**options: Any) -> Iterator[Figure]:
    """An object that nothing holds."""
    yield Figure("free fall without grip, from 1/120 s to 0.5 s", FALL_BOUND, drop(**options), "%")
