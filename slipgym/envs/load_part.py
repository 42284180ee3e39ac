"""Declares and writes the load part of an observation: sensor readings in the scales of friction."""

from __future__ import annotations

import math

from slipgym.config import Config
from slipgym.envs.readings import Reading, row_writer

LEAST_LOAD, LEAST_NORMAL = 0.01, 0.1
"""Smaller forces count as these in the load part [N]."""
RATIO_MAX = 10.0
"""Largest ratio in the load part [-]."""


def _ln_grip(config: Config) -> tuple[float, float]:
    return math.log(max(config.gripper.force_min, LEAST_LOAD)), math.log(config.gripper.force_limit)


def _ln_load(config: Config) -> tuple[float, float]:
    return math.log(LEAST_LOAD), math.log(2.0 * config.sensors.force_torque.force_range)


def _load(f: int) -> tuple[Reading, ...]:
    """What follows from the forces of finger 1 or 2."""
    wrench, ratio = f"wrenches[i, {f - 1}, ", (-RATIO_MAX, RATIO_MAX)
    load, normal = f"math.hypot({wrench}0], {wrench}1])", f"max({wrench}2], {LEAST_NORMAL})"
    torque = f"{wrench}3] / ({normal} * max(episodes[i].pad_radius, 1e-9))"
    return (
        Reading(f"ln_load_{f}", _ln_load, "-", f"logarithm of the tangential force on finger {f} in newtons",
                f"math.log(max({load}, {LEAST_LOAD}))"),
        Reading(f"load_ratio_{f}", ratio, "-", f"the same force over finger {f}'s normal force",
                f"{load} / {normal}"),
        Reading(f"torque_ratio_{f}", ratio, "-", "torque over normal force and pad radius", torque),
    )  # fmt: skip


LOAD = (
    Reading("ln_grip", _ln_grip, "-", "logarithm of the commanded grip force in newtons",
            f"math.log(max(episodes[i].command, {LEAST_LOAD}))"),
    *_load(1),
    *_load(2),
)  # fmt: skip
"""Load part, at the end of an observation with `load_columns=True`."""

write_load = row_writer(
    "write_load",
    [reading.read for reading in LOAD],
    ("wrenches", "episodes"),
    __file__,
    "Write `LOAD` of environment i.",
    functions={"math": math},
)
