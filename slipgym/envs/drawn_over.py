"""Warns of values in `config` that an episode draws anew."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping
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
    """Warn of keys of a configuration given in part that have no effect, since their values are drawn.

    A whole configuration, as a run writes it, has all keys; nobody wrote a single one of them.

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
    for key, why in _drawn(values, ranges, settings, task, material):
        warnings.warn(f"{source}: {key} has no effect: {why}", stacklevel=2)


def _drawn(
    values: Mapping[str, Any], ranges: Ranges, settings: TaskConfig, task: str, material: str
) -> Iterator[tuple[str, str]]:
    """Keys that are drawn, and why."""
    for name, key in _PLACES.items():
        if getattr(ranges, name) is not None and _has(values, key):
            yield key, f"the randomization or the level draws {name}; null there keeps the configuration's"
    own = f"tasks.{task}.friction_range"
    if ranges.mu_c is not None and _has(values, own):
        yield own, "the randomization or the level draws mu_c; null there keeps the task's"
    by = "the randomization or the level" if ranges.mu_c is not None else f"{own} = {settings.friction_range}"
    if material == "random" and (ranges.mu_c is not None or settings.friction_range is not None):
        for name, given in values.get("materials", {}).items():
            if "mu_c" in given:
                yield f"materials.{name}.mu_c", f"{by} draws mu_c, unless material={name!r} is given"


def _has(values: Mapping[str, Any], key: str) -> bool:
    group, _, rest = key.partition(".")
    inside = values.get(group)
    return group in values and (not rest or (isinstance(inside, Mapping) and _has(inside, rest)))
