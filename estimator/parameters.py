"""Documented, checked parameters: the base of every estimator's parameter dataclass."""

import dataclasses
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray


def parameter(default: float | int | bool, doc: str, within: str = "", unit: str = "") -> Any:
    """Declares a parameter field.

    Args:
        default: Default value.
        doc: What it means; one sentence or two.
        within: Valid interval such as "(0, 1]"; a round bracket leaves the end out. Empty for a bool.
        unit: SI unit; empty if it has none.
    """
    return dataclasses.field(default=default, metadata={"doc": doc, "within": within, "unit": unit})


def _inside(value: Any, interval: str) -> bool:
    low, high = (float(end) for end in interval[1:-1].split(","))
    above = low < value if interval[0] == "(" else low <= value
    below = value < high if interval[-1] == ")" else value <= high
    return above and below


def _checked(field: "dataclasses.Field[Any]", value: Any) -> float | int | bool:
    within, unit = field.metadata["within"], field.metadata["unit"]
    truth = isinstance(value, bool | np.bool_)
    if field.type is bool and truth:
        return bool(value)
    if field.type is int and not truth and isinstance(value, int | np.integer) and _inside(value, within):
        return int(value)
    if (
        field.type is float
        and not truth
        and isinstance(value, float | int | np.floating | np.integer)
        and _inside(value, within)
    ):
        return float(value)
    expected = {bool: "True or False", int: "an integer in ", float: "a number in "}[field.type]
    raise ValueError(f"{field.name} = {value!r}: expected {expected}{within} {unit}".rstrip())


@dataclasses.dataclass(frozen=True)
class Parameters:
    """Frozen parameters of an estimator; subclasses declare each field with `parameter`.

    Raises:
        ValueError: A value has the wrong type, is NaN or lies outside its interval.
    """

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            object.__setattr__(self, field.name, _checked(field, getattr(self, field.name)))

    @classmethod
    def create(cls, **values: Any) -> Self:
        """Like the constructor, but an unknown name is a ValueError that lists the valid ones."""
        valid = [field.name for field in dataclasses.fields(cls)]
        unknown = sorted(set(values) - set(valid))
        if unknown:
            raise ValueError(f"unknown parameter {', '.join(unknown)}; valid: {', '.join(valid)}")
        return cls(**values)

    @classmethod
    def dtype(cls) -> np.dtype[np.void]:
        """The fields as a structured dtype, for the compiled kernel."""
        return np.dtype([(field.name, field.type) for field in dataclasses.fields(cls)], align=True)

    def as_array(self) -> NDArray[np.void]:
        """The values as a structured array, shape (1,)."""
        return np.array([dataclasses.astuple(self)], dtype=self.dtype())
