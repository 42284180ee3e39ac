"""Declares the numbers that a randomization samples for an episode, those of each finger among them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from slipgym.config import Config, Ranges
from slipgym.config.pad import EFFECTS


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


FRICTION = ("mu_c", "mu_s", "friction_ratio")
"""Fields without a value of their own in the configuration: NaN unless they are sampled, then at scale 1."""
NAMES = ("materials", "pressure")
"""Fields that are names: their place among the materials, or -1, and among `Randomizer.variants`."""
VALUES = np.dtype(
    [
        (name, "f8", len(DIFFERENCES[name].parts)) if name in DIFFERENCES else (name, "f8")
        for name in Ranges.model_fields
        if name not in ("disturbances", "friction_by_area")
    ]
)
"""Fields of `slipgym.config.Ranges` that are numbers or names, sampled or not."""
SIZE = VALUES.itemsize // 8
"""Numbers in `VALUES`."""
_ENDS = np.cumsum([VALUES[name].itemsize // 8 for name in VALUES.names or ()]).tolist()
PLACES = dict(zip(VALUES.names or (), map(slice, [0, *_ENDS], _ENDS), strict=True))
"""Field -> where its numbers stand in `flat`."""
FIXED_BY = {
    "mass_scale": "object_mass",
    "size_scale": "object_size",
    "com_x": "com_offset",
    "com_z": "com_offset",
    "radius_scale": "r",
    **{name: name for name in DIFFERENCES},
}
"""Field -> reset option that fixes it."""


def nominal_values(config: Config) -> np.ndarray:
    """VALUES (1,) without randomization."""
    contact, gripper = config.contact, config.gripper
    values = np.zeros(1, VALUES)
    nominal = {
        "stribeck_velocity": contact.stribeck_velocity,
        "speed_slope": contact.speed_slope,
        "sigma_0": contact.sigma_0,
        "radius_scale": 1.0,
        "mass_scale": 1.0,
        "size_scale": 1.0,
        "lag": gripper.lag,
        "dead_time": gripper.dead_time,
        "stiction": gripper.stiction,
        "noise_scale": 1.0,
        "slip_latency": config.sensors.slip.latency_samples,
        "materials": -1.0,
        **{name: getattr(contact.pad, name) for name in EFFECTS},
        **dict.fromkeys(FRICTION, np.nan),
        **{name: np.ravel(getattr(getattr(config, own.group), name)) for name, own in DIFFERENCES.items()},
    }
    for name, value in nominal.items():
        values[name] = value
    return values


def flat(values: np.ndarray) -> np.ndarray:
    """VALUES (m,) as plain numbers (m, SIZE), in the same memory."""
    return values.view(np.float64).reshape(len(values), SIZE)


def labels(name: str) -> list[str]:
    """Names of the numbers of a field, as infos have them."""
    if name not in DIFFERENCES:
        return [name]
    return [f"{name}_{part}" for part in DIFFERENCES[name].parts]
