"""Identifies hidden grippers: how often intervals hold, and how far held-out residuals exceed the noise."""

from __future__ import annotations

import time
from collections.abc import Iterator

import numpy as np

from lab.simulated_gripper import draw_gripper, simulated_log
from slipgym.identification import identify
from slipgym.identification.parameters import NAMES


def rows(seeds: range) -> Iterator[str]:
    """A line per gripper and one for all of them."""
    shown = inside = 0
    ratios = []
    for seed in seeds:
        gripper = draw_gripper(seed)
        pressure = "hertz" if seed % 2 else "uniform"
        log = simulated_log(gripper, seed, pressure=pressure)
        start = time.perf_counter()
        result = identify(log)
        took = time.perf_counter() - start
        truth = np.array([gripper.values[name] for name in NAMES])
        low, high = result.interval().T
        holds = (low <= truth) & (truth <= high)
        missed = [name for name, out in zip(NAMES, ~holds & result.shown, strict=True) if out]
        shown, inside = shown + result.shown.sum(), inside + (holds & result.shown).sum()
        ratios.append(result.held_out / gripper.noise)
        fits = "does not fit" if result.misfits() else "fits"
        yield (
            f"{seed:4d} {pressure:8s} {took:5.1f} s  shown {result.shown.sum():2d}  "
            f"held out over noise {np.round(ratios[-1], 2)}  {fits}  outside: {', '.join(missed) or 'none'}"
        )
    yield (
        f"{inside} of {shown} ({100 * inside / max(shown, 1):.1f} %) inside their 90 % intervals; held-out "
        f"residual over noise, median by reading {np.round(np.median(ratios, axis=0), 2)}"
    )
