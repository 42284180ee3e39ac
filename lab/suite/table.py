"""Runs every scene in an engine, and writes the results as tables."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from lab.suite import scenes, truth
from lab.suite.rig import Grasp, Variant
from lab.suite.scenes import GAMMAS, Held

BOTH = 0.7
"""gamma_t of the loads of force and torque together [-]."""
LOADS = {"force": 1.0, "torque": 0.0, "both": BOTH}
"""Loads of the break-away ramps by their gamma_t [-]."""


@dataclass(frozen=True)
class Result:
    """What the scenes measured in one variant."""

    variant: Variant
    step: float
    """Step of the engine that the scenes see [ms]."""
    weight: Held
    """Hold of a weight."""
    both: Held
    """Hold of a force and a torque."""
    ramps: dict[str, float]
    """Load at break-away over the exact limit, less 1, by the names of `LOADS` [%]."""
    friction: np.ndarray
    """Measured and exact steady friction at `GAMMAS`, (n, 2, 3) [-]."""
    energy: float
    """Largest rise of kinetic energy in free sliding [%]."""
    shaken: float
    """Largest slip in a shaken wrist [mm]."""

    @property
    def off(self) -> float:
        """Largest distance of steady friction from the exact one over mu sum f_n [%]."""
        return 100.0 * float(np.linalg.norm(self.friction[:, 0] - self.friction[:, 1], axis=1).max())


def measure(variant: Variant) -> Result:
    """Run all scenes.

    Raises:
        RuntimeError: The engine is not installed.
    """
    rig = variant.make(Grasp())
    step = 1e3 * rig.step_time
    rig.close()
    return Result(
        variant=variant,
        step=step,
        weight=scenes.hold(variant, 1.0, scenes.HOLD_TIME),
        both=scenes.hold(variant, BOTH, scenes.BOTH_TIME),
        ramps={name: scenes.ramp(variant, gamma) for name, gamma in LOADS.items()},
        friction=np.array([scenes.steady(variant, gamma) for gamma in GAMMAS]),
        energy=scenes.energy(variant),
        shaken=scenes.shaken(variant),
    )


def number(value: float) -> str:
    """Two significant digits; below a millionth the size does not matter."""
    if abs(value) < 1e-6:
        return "0" if value == 0.0 else "< 1e-6"
    return f"{value:.2g}" if abs(value) < 100.0 else f"{value:.0f}"


def crept(held: Held, size: float) -> str:
    """Creep, or when the object was lost."""
    return f"lost after {held.duration:.0f} s" if held.lost else number(size)


def broke(value: float) -> str:
    """Break-away against the limit."""
    first = 100.0 * (scenes.RAMP_START - 1.0)
    if math.isinf(value):
        return f"> +{100.0 * (scenes.RAMP_END - 1.0):.0f}"
    return f"< {first:.0f}" if value < first + 0.1 else f"{value:+.1f}"


COLUMNS: dict[str, Callable[[Result], str]] = {
    "engine": lambda result: result.variant.engine,
    "settings": lambda result: result.variant.settings,
    "step [ms]": lambda result: number(result.step),
    "creep in 60 s, weight [mm]": lambda result: crept(result.weight, result.weight.distance),
    "in 10 s, both [mm]": lambda result: crept(result.both, result.both.distance),
    "[deg]": lambda result: crept(result.both, result.both.angle),
    "break-away, force [%]": lambda result: broke(result.ramps["force"]),
    "torque [%]": lambda result: broke(result.ramps["torque"]),
    "both [%]": lambda result: broke(result.ramps["both"]),
    "steady friction off by [%]": lambda result: number(result.off),
    "energy gained [%]": lambda result: number(result.energy),
    "shaken [mm]": lambda result: number(result.shaken),
    "cost [s/s]": lambda result: number(result.weight.cost),
}
"""Heads of the table, and what stands below."""


def _markdown(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def results_table(results: Sequence[Result]) -> str:
    """All scenes, a row for each result, as Markdown."""
    return _markdown(list(COLUMNS), [[write(result) for write in COLUMNS.values()] for result in results])


def friction_table(results: Sequence[Result]) -> str:
    """Steady friction f_t and tau / r over mu sum f_n at every gamma_t, as Markdown."""
    heads = ["engine", "settings", *(f"gamma_t {gamma:g}" for gamma in GAMMAS)]
    exact = [truth.friction(scenes.along(gamma)) for gamma in GAMMAS]
    rows = [["exact", "uniform disc", *map(_pair, exact)]]
    for result in results:
        rows.append(
            [result.variant.engine, result.variant.settings, *(_pair(found[0]) for found in result.friction)]
        )
    return _markdown(heads, rows)


def _pair(friction: np.ndarray) -> str:
    return f"{math.hypot(friction[0], friction[1]):.2f}, {abs(friction[2]):.2f}"
