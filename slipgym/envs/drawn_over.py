"""Warns of values in `config` that an episode draws anew."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

from slipgym.config import Config, Overrides, Ranges, TaskConfig
from slipgym.config.load import read_overrides
from slipgym.config.pad import EFFECTS
from slipgym.envs.values import DIFFERENCES

_PLACES = {
    **{name: f"{own.group}.{name}" for name, own in DIFFERENCES.items()},
    **{name: f"contact.pad.{name}" for name in EFFECTS},
    **{name: f"contact.{name}" for name in ("stribeck_velocity", "speed_slope", "sigma_0", "pressure")},
    **{name: f"gripper.{name}" for name in ("lag", "dead_time", "stiction")},
    "slip_latency": "sensors.slip.latency_samples",
}
"""Field of the randomization -> key of the configuration that it takes the place of."""


def warn_of_drawn(
    overrides: Overrides | None, ranges: Ranges, settings: TaskConfig, task: str, material: str
) -> None:
    """Warn of keys of a configuration given in part that are drawn; nobody wrote a single key of a whole one.

    Args:
        overrides: The configuration, as given.
        ranges: What the randomization and the level draw for the task.
        settings: The task's settings.
        task: The task's key.
        material: The environment's.
    """
    source, values = ("", {}) if overrides is None else read_overrides(overrides)
    if values.keys() >= Config.model_fields.keys():
        return
    places = {**_PLACES, "mu_c": f"tasks.{task}.friction_range"}
    drawn = {places[name]: f"the randomization or the level draws {name}" for name in places
             if getattr(ranges, name) is not None}  # fmt: skip
    if ranges.friction_by_area:
        drawn[places["load_exponent"]] = "friction_by_area takes it from the radius_exponent that is drawn"
    if material == "random" and (ranges.mu_c is not None or settings.friction_range is not None):
        for name in values.get("materials", {}):
            drawn[f"materials.{name}"] = f"its friction is drawn, unless material={name!r} is given"
    for key, why in drawn.items():
        if _has(values, key):
            warnings.warn(f"{source}: {key} has no effect: {why}", stacklevel=2)


def _has(values: Mapping[str, Any], key: str) -> bool:
    group, _, rest = key.partition(".")
    return group in values and (not rest or _has(values[group], rest))
