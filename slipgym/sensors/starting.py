"""Sensors at the start of an episode."""

from __future__ import annotations

import numpy as np


def start_sensors(force_torque: np.ndarray, chips: np.ndarray, rng: np.random.Generator) -> None:
    """Forget all samples, and draw the keys of the noise and what each chip has not counted yet.

    Args:
        force_torque: FORCE_TORQUE, any shape.
        chips: SLIP_SENSOR, any shape.
        rng: Source of the draws.
    """
    force_torque["history"] = chips["counted"] = chips["moved"] = chips["travel"] = 0.0
    force_torque["read"] = chips["taken"] = 0
    keys = rng.bit_generator.random_raw(3 * chips.size).reshape(3, *chips.shape)
    force_torque["key"], force_torque["drift_key"], chips["key"] = keys
    chips["carry"] = rng.uniform(-1.0, 1.0, chips["carry"].shape) * chips["count"][..., None]
