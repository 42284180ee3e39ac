"""Episode parameters that `reset(options=...)` can fix."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Self

from pydantic import Field, ValidationError

from slipgym.config.base import Frozen, Point, Positive, Size
from slipgym.config.errors import unknown


class EpisodeOptions(Frozen):
    """Options of every task; what is not given is drawn or taken from the configuration."""

    material: str | None = Field(default=None, description='Name of a material, or "random" [-]')
    mu_s: Positive | None = Field(default=None, le=5.0, description="Static friction, >= mu_c [-]")
    mu_c: Positive | None = Field(default=None, le=5.0, description="Coulomb friction [-]")
    r: Positive | None = Field(default=None, le=0.1, description="Radius of the equivalent rim contact [m]")
    object_mass: float | None = Field(default=None, ge=0.01, le=5.0, description="Mass of the object [kg]")
    object_size: Size | None = Field(default=None, description="Extent along x, the grip axis and z [m]")
    com_offset: Point | None = Field(
        default=None, description="Centre of mass (x, z) from the geometric centre [m]"
    )
    initial_force: Positive | None = Field(default=None, le=40.0, description="Force per finger at reset [N]")
    randomization_scale: float | None = Field(
        default=None, ge=0.0, le=1.0, description="Share of the randomization's ranges: 0 none, 1 all [-]"
    )

    @classmethod
    def parse(cls, options: Mapping[str, Any] | None) -> Self:
        """Check the options of a reset.

        Raises:
            ValueError: An option is unknown or its value not allowed; the message names it,
                its value and what is valid.
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

    def choose(self, field: str, defaults: Any) -> Any:
        """The option if it was given, else the field of the same name of the configuration."""
        value = getattr(self, field)
        return getattr(defaults, field) if value is None else value
