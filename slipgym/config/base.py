"""Base class of the configuration models: immutable, strictly typed, finite numbers only."""

from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np
from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, model_validator


def plain(value: Any, seen: dict[int, Any] | None = None) -> Any:
    """Return a value without numpy in it: numbers as int or float, arrays as lists, mappings as dicts.

    Other values stay as they are, and so does a container inside itself.

    Args:
        value: Any value.
        seen: Containers that were converted, by identity.
    """
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, np.generic):
        return float(value) if isinstance(value, np.floating) else value.item()
    if not isinstance(value, Mapping | list | tuple):
        return value
    seen = {} if seen is None else seen
    if id(value) in seen:
        return seen[id(value)]
    seen[id(value)] = value
    if isinstance(value, Mapping):
        made: Any = {plain(key, seen): plain(each, seen) for key, each in value.items()}
    else:
        made = [plain(each, seen) for each in value]
        made = tuple(made) if isinstance(value, tuple) else made
    seen[id(value)] = made
    return made


class Frozen(BaseModel):
    """A part of the configuration: immutable, no unknown keys, no silent conversions, finite numbers only.

    Numbers, texts and arrays of numpy count as Python's.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)

    @model_validator(mode="before")
    @classmethod
    def _without_numpy(cls, values: Any) -> Any:
        return plain(values)


def as_tuple(value: object) -> object:
    """Convert a list to a tuple; leave other values unchanged."""
    return tuple(value) if isinstance(value, list) else value


def as_name(value: object) -> object:
    """Convert True to "true": YAML takes this friction source for a truth value."""
    return "true" if value is True else value


def ordered(pair: tuple[float, float]) -> tuple[float, float]:
    """Return a pair whose first value is not above its second, or raise ValueError."""
    if pair[0] > pair[1]:
        raise ValueError(f"the lower end {pair[0]:g} lies above the upper end {pair[1]:g}")
    return pair


def ends_within(low: float, high: float) -> AfterValidator:
    """Validator of a pair whose values must lie within bounds."""

    def check(pair: tuple[float, float] | None) -> tuple[float, float] | None:
        if pair is not None and not (low <= pair[0] and pair[1] <= high):
            raise ValueError(f"must lie within {low:g} to {high:g}, got {pair[0]:g} to {pair[1]:g}")
        return pair

    return AfterValidator(check)


def number(least: float, most: float, meaning: str) -> Any:
    """Declare a field that is a number within bounds, both of them allowed."""
    return Field(ge=least, le=most, description=meaning)


Positive = Annotated[float, Field(gt=0)]
NonNegative = Annotated[float, Field(ge=0)]
Count = Annotated[int, Field(ge=1)]

# YAML has no tuples: a list becoming one is the only conversion.
_LIST = BeforeValidator(as_tuple)
Point = Annotated[tuple[float, float], _LIST]
Points = Annotated[tuple[Point, Point], _LIST]
_Factor = Annotated[float, Field(ge=0.1, le=10.0)]
Factors = Annotated[tuple[_Factor, _Factor], _LIST]
_Extent = Annotated[float, Field(ge=1e-3, le=10.0)]
Size = Annotated[tuple[_Extent, _Extent, _Extent], _LIST]
Interval = Annotated[tuple[NonNegative, NonNegative], _LIST, AfterValidator(ordered)]
PositiveInterval = Annotated[tuple[Positive, Positive], _LIST, AfterValidator(ordered)]
