"""In what the two fingers differ: values of the configuration, sampled ones, and those that options fix."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from slipgym.config import Config
from slipgym.config.distribution import Distribution
from slipgym.tasks.options import EpisodeOptions


class Difference(NamedTuple):
    """A quantity that each finger has its own value of."""

    parts: tuple[str, ...]
    """Suffixes of its numbers' names, in order."""
    group: str
    """Group of the configuration that holds it."""


_PER_FINGER = ("1", "2")
DIFFERENCES = {
    "finger_friction": Difference(_PER_FINGER, "contact"),
    "finger_radius": Difference(_PER_FINGER, "contact"),
    "cop_offset": Difference(("x_1", "y_1", "x_2", "y_2"), "contact"),
    "finger_lag": Difference(_PER_FINGER, "gripper"),
    "force_gain": Difference(_PER_FINGER, "gripper"),
}
"""Name in the configuration, in `Ranges` and among the reset options -> what it consists of."""

Numbers = tuple[float, ...]


def _flat(value: object) -> Numbers:
    return tuple(np.ravel(np.asarray(value, dtype=float)).tolist())


def nominal_differences(config: Config) -> dict[str, Numbers]:
    """Numbers of `DIFFERENCES` without randomization."""
    return {name: _flat(getattr(getattr(config, own.group), name)) for name, own in DIFFERENCES.items()}


def sample_difference(
    field: Distribution, nominal: Numbers, scale: float, rng: np.random.Generator
) -> Numbers:
    """Sample each number on its own.

    Args:
        field: Distribution of each.
        nominal: Numbers of the configuration.
        scale: 0 for these, 1 for the sampled numbers, linear between.
        rng: Random generator; one draw a number, whatever the scale.
    """
    shares = rng.random(len(nominal)).tolist()
    return tuple(
        (1.0 - scale) * value + scale * field.at(u) for value, u in zip(nominal, shares, strict=True)
    )


def chosen_differences(
    config: Config, options: EpisodeOptions, drawn: Mapping[str, Numbers], r: float
) -> Mapping[str, Numbers]:
    """Numbers of `DIFFERENCES` of an episode: the options' values, else the sampled ones.

    Args:
        config: Configuration with the episode's pressure profile.
        options: Reset options.
        drawn: Numbers of the configuration or sampled ones.
        r: Radius of the equivalent rim contact [m].

    Raises:
        ValueError: A contact or its centre of pressure does not fit on the pad.
    """
    fixed = {name: value for name in DIFFERENCES if (value := getattr(options, name)) is not None}
    if "cop_offset" in fixed:
        config.check_cop_offset("option cop_offset", fixed["cop_offset"])
    chosen = {**drawn, **{name: _flat(value) for name, value in fixed.items()}} if fixed else drawn
    largest = r * max(chosen["finger_radius"])
    if "finger_radius" in fixed:
        config.check_radius("option finger_radius: the larger radius r", largest)
    elif largest != r:
        config.check_patch("option r times finger_radius", largest)
    return chosen


def named(name: str, numbers: Numbers) -> dict[str, float]:
    """Numbers of one of `DIFFERENCES`, each by its name."""
    return {f"{name}_{part}": value for part, value in zip(DIFFERENCES[name].parts, numbers, strict=True)}
