"""Distributions of numbers that are sampled anew in every episode."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from typing import Annotated, Any, NamedTuple, Self

from pydantic import AfterValidator, BeforeValidator, Field, ValidationInfo, field_validator, model_validator

from slipgym.config.base import Frozen, PositiveInterval, as_tuple, ordered

Ends = Annotated[tuple[float, float], BeforeValidator(as_tuple), AfterValidator(ordered)]
Numbers = Annotated[tuple[float, ...], Field(min_length=1), BeforeValidator(as_tuple)]


EVEN, LOGARITHMIC, CHOICES = range(3)
"""Kinds of distributions."""


class Distribution(Frozen):
    """A range, linear or logarithmic, or a list of choices: exactly one of them."""

    uniform: Ends | None = Field(default=None, description="Ends of an even range [-]")
    log_uniform: PositiveInterval | None = Field(
        default=None, description="Ends of a range that is even in the logarithm [-]"
    )
    choices: Numbers | None = Field(default=None, description="Values of the same probability [-]")

    @model_validator(mode="after")
    def _is_one_kind(self) -> Self:
        kinds = list(type(self).model_fields)
        given = [kind for kind in kinds if getattr(self, kind) is not None]
        if len(given) != 1:
            raise ValueError(f"needs exactly one of {', '.join(kinds)}, got {', '.join(given) or 'none'}")
        return self

    @property
    def ends(self) -> tuple[float, float]:
        """Smallest and largest value."""
        values = self.uniform or self.log_uniform or self.choices or ()
        return min(values), max(values)

    def at(self, share: float) -> float:
        """The quantile: a value below which a fraction in [0, 1) of the samples lies."""
        return quantile(*self.parameters, self.choices or (), share)

    @property
    def parameters(self) -> tuple[int, float, float, float]:
        """The first arguments of `quantile`."""
        low, high = self.ends
        if self.choices is not None:
            return CHOICES, low, high, 0.0
        if self.log_uniform is not None:
            return LOGARITHMIC, low, high, math.log(high / low)
        return EVEN, low, high, high - low


def quantile(
    kind: int, low: float, high: float, span: float, choices: Sequence[float], share: float
) -> float:
    """The number of a distribution below which a fraction of the samples lies; it can be compiled.

    `kind` is EVEN, LOGARITHMIC or CHOICES; `span` is the length of the range, or its logarithmic length;
    `share` is the fraction, in [0, 1).
    """
    if kind == CHOICES:
        return choices[int(share * len(choices))]
    if kind == LOGARITHMIC:
        return min(max(low * math.exp(share * span), low), high)
    return min(low + share * span, high)


Drawn = Distribution | None
"""Type of a field of `Ranged` that need not be given: null is not sampled."""


class _Bounds(NamedTuple):
    """Metadata of a field: bounds of its values."""

    low: float
    high: float

    def __call__(self, schema: dict[str, Any]) -> None:
        """Pydantic calls this for a JSON schema, to which it adds nothing."""


def within(low: float, high: float, meaning: str, default: Any = ...) -> Any:
    """Declare a field of `Ranged`: a distribution whose values lie within bounds."""
    return Field(default, description=meaning, json_schema_extra=_Bounds(low, high))


ranged = partial(within, default=None)
"""`within`, of a distribution that need not be given."""


class Ranged(Frozen):
    """Base class of models with distributions whose bounds `within` and `ranged` declare."""

    @field_validator("*")
    @classmethod
    def _values_lie_within(cls, value: Any, info: ValidationInfo) -> Any:
        bounds = cls.model_fields[info.field_name or ""].json_schema_extra
        if isinstance(bounds, _Bounds) and value is not None:
            least, most = value.ends
            if not bounds.low <= least <= most <= bounds.high:
                valid = f"{bounds.low:g} to {bounds.high:g}"
                raise ValueError(f"must lie within {valid}, got {least:g} to {most:g}")
        return value
