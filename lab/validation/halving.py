"""Checks that halving every time step hardly changes a slide of five seconds."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from slipgym.config import load
from slipgym.validation.bench import Bench, Figure, Signal, Trace

BOUND = 0.1  # [mm]
ANGLE_BOUND = 0.1  # [deg]; at the pad's rim of 15 mm it is 0.03 mm
DURATION = 5.0  # [s]
HOLDING_GRIP = 2.2  # [N]; the weight takes 87 % of its limit
SIZE = 0.08, 0.03, 0.3  # [m]


def smooth_grip(t: float) -> float:
    """Lets the object start, then keeps it sliding at 1 to 3 cm/s [N]."""
    return 1.86 if t < 0.05 else 2.68 - 0.02 * math.sin(2.0 * math.pi * t / 2.5)


def stick_slip_grip(t: float) -> float:
    """Opens and closes once a second; the object slips and sticks each time [N]."""
    return 4.0 - 2.17 * max(0.0, math.sin(2.0 * math.pi * t)) ** 4


def travel(grip: Signal, refinement: int, com_offset: tuple[float, float], **options: Any) -> Trace:
    """The slide under a grip force profile, open loop.

    Args:
        grip: Grip force per finger [N].
        refinement: Divides every step.
        com_offset: Centre of mass (x, z) from the pad centre [m].
        **options: More arguments of `Bench`.
    """
    default = load().physics
    finer = {
        "engine_steps": default.engine_steps * refinement,
        "substep_max": default.substep_max / refinement,
        "patch_substep_max": default.patch_substep_max / refinement,
        "planar_substep_max": default.planar_substep_max / refinement,
    }
    with Bench({"physics": finer}, force=5.0, com_offset=com_offset, size=SIZE, **options) as bench:
        bench.settle()
        bench.settle(force=lambda _: HOLDING_GRIP)
        return bench.run(DURATION, force=grip)


def compare(
    name: str, grip: Signal, com_offset: tuple[float, float], refinement: int = 1, **options: Any
) -> Iterator[Figure]:
    """Difference between a slide and the same with all steps halved; arguments as of `travel`."""
    coarse = travel(grip, refinement, com_offset, **options).slip
    fine = travel(grip, 2 * refinement, com_offset, **options).slip
    away = np.abs(coarse - fine)
    length = 1e3 * np.hypot(*coarse[-1, :2])
    yield Figure(f"{name}, {length:.0f} mm", BOUND, 1e3 * np.hypot(*away[:, :2].T).max(), "mm")
    yield Figure(name, ANGLE_BOUND, math.degrees(away[:, 2].max()), "deg")


def halving() -> Iterator[Figure]:
    """Slides that are steady, stick and slip, and turn as well, with both engines and contacts of a disc."""
    for name, options in {
        "halved step": {},
        "planar: halved step": {"engine": "planar"},
        "disc: halved step": {"contact": "disc"},
        "distributed: halved step": {"contact": "distributed"},
    }.items():
        if "contact" not in options:
            yield from compare(f"{name}, steady", smooth_grip, (0.0, 0.0), **options)
        if options.get("contact") != "disc":
            yield from compare(f"{name}, stick-slip", stick_slip_grip, (0.0, 0.0), **options)
        yield from compare(f"{name}, stick-slip and turning", stick_slip_grip, (0.003, -0.01), **options)
