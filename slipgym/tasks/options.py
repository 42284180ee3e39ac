"""Episode parameters that `reset(options=...)` can fix."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Self

from pydantic import Field, ValidationError, create_model

from slipgym.config.base import Factors, Frozen, Point, Points, Positive, Size
from slipgym.config.errors import unknown
from slipgym.config.task import SAME, Option, SettingsT, TaskConfig


def option(meaning: str, **bounds: Any) -> Any:
    """Declare an option that need not be given; bounds in pydantic's words."""
    return Field(default=None, description=meaning, **bounds)


class EpisodeOptions(Frozen):
    """Options of every task; parameters that are not given are sampled or taken from the settings."""

    settings_fields: ClassVar[frozenset[str]] = frozenset()
    """Options that replace the setting of the same name."""

    material: str | None = option('Name of a material, or "random"')
    mu_s: Positive | None = option("Static friction, >= mu_c [-]", le=5.0)
    mu_c: Positive | None = option("Coulomb friction [-]", le=5.0)
    r: Positive | None = option("Radius of the equivalent rim contact [m]", le=0.1)
    finger_friction: Factors | None = option("Friction of each finger over mu_s and mu_c [-]")
    finger_radius: Factors | None = option("Contact radius of each finger over r [-]")
    cop_offset: Points | None = option("Centre of pressure (x, y) from the pad's centre, per finger [m]")
    finger_lag: Factors | None = option("Time constant of each finger's force loop over the gripper's [-]")
    force_gain: Factors | None = option("Force of each finger's actuator over the commanded [-]")
    object_mass: float | None = option("Mass of the object [kg]", ge=0.01, le=5.0)
    object_size: Size | None = option("Extent along x, the grip axis and z [m]")
    com_offset: Point | None = option("Centre of mass (x, z) from the geometric centre [m]")
    wrist_roll: float | None = option(
        "Roll of the wrist about x at the start; needs `physics.tilt` [rad]", ge=-math.pi, le=math.pi
    )
    randomization_scale: float | None = option(
        "Fraction of the randomization's ranges: 0 none, 1 all [-]", ge=0.0, le=1.0
    )

    @classmethod
    def parse(cls, options: Mapping[str, Any] | None) -> Self:
        """Check the options of a reset.

        Raises:
            ValueError: An option is unknown or its value not allowed; the message names it,
                its value and the valid values.
        """
        if options is not None and not isinstance(options, Mapping):
            raise ValueError(f"options = {options!r} must be a mapping; valid: {', '.join(cls.model_fields)}")
        try:
            return cls.model_validate(dict(options or {}))
        except ValidationError as error:
            raise ValueError("; ".join(cls._explain(fault) for fault in error.errors())) from error

    @classmethod
    def _explain(cls, fault: Any) -> str:
        name = str(fault["loc"][0]) if fault["loc"] else "options"
        if fault["type"] in ("extra_forbidden", "invalid_key"):
            return unknown("option", name, cls.model_fields)
        meaning = cls.model_fields[name].description if name in cls.model_fields else ""
        return f"option {name} = {fault['input']!r}: {fault['msg']} ({meaning})"

    def applied_to(self, settings: SettingsT) -> SettingsT:
        """The settings of an episode: options replace the settings of the same name."""
        given = {name: getattr(self, name) for name in self.settings_fields & self.model_fields_set}
        given = {name: value for name, value in given.items() if value is not None}
        return settings.model_copy(update=given) if given else settings


def derive_options(name: str, settings: type[TaskConfig]) -> type[EpisodeOptions]:
    """The options of a task: those of every task, and each setting that is declared with `reset`.

    Args:
        name: Name of the task.
        settings: Its settings.
    """
    fields: dict[str, Any] = {}
    replaced = set()
    for key, field in settings.model_fields.items():
        own = field.json_schema_extra
        if not isinstance(own, Option):
            continue
        if own is not SAME:
            bounds: dict[str, Any] = dict(own.bounds or {})
            kind: Any = Annotated[own.annotation, Field(**bounds)]
            fields[key] = (kind | None, option(own.meaning))
            continue
        kind = field.annotation
        for constraint in field.metadata:
            kind = Annotated[kind, constraint]
        fields[key] = (kind | None, Field(default=None, description=field.description))
        replaced.add(key)
    made = create_model(
        f"{name}Options", __base__=EpisodeOptions, __doc__="What `reset(options=...)` can fix.", **fields
    )
    made.settings_fields = frozenset(replaced)
    return made
