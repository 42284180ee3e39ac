"""In what the two fingers differ: values of the configuration, and checks of those that options fix."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from slipgym.config import Config
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


def nominal_differences(config: Config) -> dict[str, np.ndarray]:
    """Numbers of `DIFFERENCES` without randomization."""
    return {name: np.ravel(getattr(getattr(config, own.group), name)) for name, own in DIFFERENCES.items()}


def fixed_differences(config: Config, options: EpisodeOptions) -> dict[str, np.ndarray]:
    """Numbers of `DIFFERENCES` that options fix.

    Raises:
        ValueError: A centre of pressure does not lie on its pad.
    """
    if options.cop_offset is not None:
        config.check_cop_offset("option cop_offset", options.cop_offset)
    given = {name: getattr(options, name) for name in DIFFERENCES}
    return {name: np.ravel(value) for name, value in given.items() if value is not None}


def check_contacts(config: Config, options: EpisodeOptions, r: float, factors: tuple[float, ...]) -> None:
    """Check that the contacts of both fingers fit on their pads.

    Args:
        config: Configuration with the episode's pressure profile.
        options: Reset options.
        r: Radius of the equivalent rim contact [m].
        factors: Radius of each finger over r [-].

    Raises:
        ValueError: One does not.
    """
    config.check_patch("option r", r)
    largest = r * max(factors)
    if options.finger_radius is not None:
        config.check_radius("option finger_radius: the larger radius r", largest)
    elif largest != r:
        config.check_patch("option r times finger_radius", largest)
