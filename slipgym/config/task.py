"""Base class of the tasks' settings, and the declaration of a task's own parameters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, TypeVar

from pydantic import ConfigDict, Field

from slipgym.config.base import Frozen, Positive, PositiveInterval, ends_within
from slipgym.config.hardware import ObjectConfig
from slipgym.config.root import Config


@dataclass(frozen=True)
class Option:
    """A reset option of another type than the setting of the same name, for `setting(reset=...)`."""

    annotation: Any
    """Type of the option's value."""
    meaning: str
    """Meaning of the option."""
    bounds: Mapping[str, Any] | None = None
    """Bounds in pydantic's words: gt, ge, lt, le."""

    def __call__(self, schema: dict[str, Any]) -> None:
        """Pydantic calls this for a JSON schema, to which it adds nothing."""


SAME = Option(None, "")
"""Metadata of a setting that `reset(options=...)` can fix with a value of its own type."""


def setting(meaning: str, unit: str = "", *, reset: bool | Option = False, **bounds: Any) -> Any:
    """Metadata of a task's parameter.

    `distance: Annotated[Positive, setting("Distance to slide", "m")] = 0.04` declares one, with its default.

    Args:
        meaning: Meaning of the parameter, for errors and documentation.
        unit: SI unit; empty for a plain number.
        reset: Whether `reset(options=...)` can fix it for one episode; an `Option` where the option has
            another type than the setting.
        **bounds: Bounds in pydantic's words: gt, ge, lt, le.
    """
    extra = SAME if reset is True else reset or None
    return Field(description=f"{meaning} [{unit}]" if unit else meaning, json_schema_extra=extra, **bounds)


Scale = Annotated[float, Field(ge=-1e6, le=1e6)]
InitialForce = Annotated[Positive, setting("Grip force per finger at reset", "N", reset=True, le=40.0)]
TaskObject = Annotated[ObjectConfig | None, setting("The object of this task; null: the common one")]
MassRange = Annotated[
    PositiveInterval | None,
    ends_within(1e-3, 1e3),
    setting("The object's mass is sampled from this range; null: the object's own", "kg"),
]
FrictionRange = Annotated[
    PositiveInterval | None,
    ends_within(1e-2, 5.0),
    setting(
        "mu_c is sampled from this range, log-uniformly, unless a material is given or the randomization "
        "samples it; the material gives mu_s / mu_c then; null: the material's own",
        "-",
    ),
]
RadiusRange = Annotated[
    PositiveInterval | None,
    setting(
        "r is sampled from this range, unless a reset option fixes it; the randomization scales it; "
        "null: `radius`",
        "m",
    ),
]
WristSpeed = Annotated[
    Positive | None,
    setting("Largest speed of the wrist in this task; null: gripper.wrist_speed_max", "m/s", le=100.0),
]
TaskRadius = Annotated[
    Positive | None,
    setting("Radius r of the equivalent rim contact in this task, also nominal; null: the common", "m"),
]


class TaskConfig(Frozen):
    """Settings of every task; a task's own are fields of a subclass.

    A subclass gives a common setting another default by naming it again with its type:
    `initial_force: InitialForce = 5.0`.
    """

    model_config = ConfigDict(validate_default=True)

    initial_force: InitialForce = 15.0
    object: TaskObject = None
    mass_range: MassRange = None
    friction_range: FrictionRange = None
    radius: TaskRadius = None
    radius_range: RadiusRange = None
    wrist_speed: WristSpeed = None
    reward: Annotated[Mapping[str, Scale], setting("Scales of the reward terms, by their names")] = {}

    def check(self, config: Config, name: str) -> None:
        """Check the settings against gripper and pads.

        Args:
            config: Configuration of the environment.
            name: Location of the settings, for error messages: "tasks.hold".

        Raises:
            ValueError: The contact radius does not fit on the pad, or the gripper cannot hold the initial
                force.
        """
        if self.radius is not None:
            config.check_radius(f"{name}.radius", self.radius)
        if self.radius_range is not None:
            config.check_radius(f"{name}.radius_range", self.radius_range[1])
        low, high = config.gripper.force_min, config.gripper.force_max
        if not low <= self.initial_force <= high:
            raise ValueError(
                f"{name}.initial_force must lie within the gripper's {low:g} to {high:g} N, "
                f"got {self.initial_force:g} N"
            )


SettingsT = TypeVar("SettingsT", bound=TaskConfig)
