"""Warns of configurations whose steps take far longer than those of the defaults."""

from __future__ import annotations

import warnings
from functools import cache

from slipgym.config import Config, load

SLOW = 100.0
"""Work of a step over that of the defaults from which there is a warning."""


def work(config: Config, frame_skip: int = 1) -> float:
    """Upper bound of the work of a step, in arbitrary units: sub-steps, sensor samples, engine iterations.

    Args:
        config: Configuration.
        frame_skip: Control steps per step.
    """
    physics, contact = config.physics, config.contact
    patches = contact.model == "distributed"
    longest = min(physics.substep_max, physics.patch_substep_max) if patches else physics.substep_max
    per_substep = 1.0 + contact.cells**2 / 40.0 if patches else 1.0  # a patch of 21 cells: 12 ellipsoids
    substeps = 1.0 / (physics.control_rate * longest) * per_substep
    samples = config.sensors.force_torque.rate / physics.control_rate
    return frame_skip * (substeps + samples + physics.engine_steps * physics.solver_iterations)


def warn_if_slow(config: Config, frame_skip: int) -> None:
    """Warn if a step may take `SLOW` times as long as one of the defaults with the same friction model."""
    ratio = work(config, frame_skip) / _default_work(config.contact.model)
    if ratio > SLOW:
        message = (
            f"a step may take {ratio:.0f} times as long as with the defaults: see physics.control_rate, "
            "substep_max, engine_steps and solver_iterations, sensors.force_torque.rate, contact.cells and "
            "frame_skip"
        )
        warnings.warn(message, stacklevel=2)


@cache
def _default_work(model: str) -> float:
    return work(load(contact=model))
