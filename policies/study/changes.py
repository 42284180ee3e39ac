"""A preset in which one thing is worse."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from policies.study.config import Degradation
from slipgym.config import load_randomization
from slipgym.tasks import find

TITLES = {
    "noise_scale": "sensor noise, times the configured",
    "slip_latency": "age of the slip velocity [samples of 1/120 s]",
    "friction_jump": "friction after over before a jump in mid-episode",
}
"""Change -> what its levels are, in words."""


@dataclass(frozen=True)
class Change:
    """One field of a preset, held at one value."""

    name: str
    """One of `TITLES`, or nothing."""
    level: float
    """Of what `TITLES` says."""
    time: tuple[float, float] = (0.0, 0.0)
    """When a jump happens [s]."""

    def of(self, preset: str, task: str) -> str | Mapping[str, Any]:
        """The preset with this change, for one task: what an environment takes as `randomization`."""
        if not self.name:
            return preset
        ranges = load_randomization(preset).of(find(task).key).model_dump(mode="json", exclude_defaults=True)
        if self.name == "friction_jump":
            jump = {
                "kind": "friction_jump",
                "probability": 1.0,
                "time": {"uniform": list(self.time)},
                "factor": {"choices": [self.level]},
            }
            others = [each for each in ranges.get("disturbances", []) if each["kind"] != "friction_jump"]
            return {**ranges, "disturbances": [*others, jump]}
        return {**ranges, self.name: {"choices": [self.level]}}


UNCHANGED = Change("", 0.0)


def changes(worse: Degradation) -> list[Change]:
    """Every change of a study."""
    return [Change(name, level, worse.jump_time) for name in TITLES for level in getattr(worse, name)]
