"""Documented, checked parameters: the base of every estimator's parameter dataclass."""

import dataclasses
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from estimator.suggestions import asking

_KINDS = {
    bool: ((bool, np.bool_), "True or False"),
    int: ((int, np.integer), "an integer in"),
    float: ((float, int, np.floating, np.integer), "a number in"),
    str: ((str,), "a text"),
}
"""Field type -> accepted value types and the words for them; an int field does not accept a bool."""


RADIUS = "(0, 0.2]"
"""Valid interval of a contact's radius [m]: the pads of the largest grippers are 0.2 m wide, so that it holds
twice what is needed and refuses one in mm or cm."""


def parameter(default: float | int | bool | str, doc: str, within: str = "", unit: str = "") -> Any:
    """Declares a parameter field.

    Args:
        default: Default value.
        doc: Its meaning, in one or two sentences.
        within: Valid interval such as "(0, 1]"; a round bracket excludes the end. Empty for a bool or a text.
        unit: SI unit; empty if it has none.
    """
    return dataclasses.field(default=default, metadata={"doc": doc, "within": within, "unit": unit})


def _inside(value: float, interval: str) -> bool:
    low, high = (float(end) for end in interval[1:-1].split(","))
    above = low < value if interval[0] == "(" else low <= value
    below = value < high if interval[-1] == ")" else value <= high
    return above and below


def _checked(field: "dataclasses.Field[Any]", value: Any) -> float | int | bool | str:
    kind: Any = field.type
    within, unit = field.metadata["within"], field.metadata["unit"]
    accepted, expected = _KINDS[kind]
    number: Any = value.item() if isinstance(value, np.ndarray) and value.ndim == 0 else value
    is_truth_value = isinstance(number, _KINDS[bool][0])
    if (
        isinstance(number, accepted)
        and is_truth_value == (kind is bool)
        and (not within or _inside(number, within))
    ):
        return kind(number)
    raise ValueError(f"{field.name} = {value!r}: expected {expected} {within} {unit}".rstrip())


@dataclasses.dataclass(frozen=True)
class Parameters:
    """Frozen parameters of an estimator; subclasses declare each field with `parameter`.

    Raises:
        ValueError: A value has the wrong type, is NaN or lies outside its interval.
    """

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            object.__setattr__(self, field.name, _checked(field, getattr(self, field.name)))

    def _ordered(self, *names: str) -> None:
        values = [getattr(self, name) for name in names]
        if values != sorted(values):
            given = ", ".join(f"{name} = {value!r}" for name, value in zip(names, values, strict=True))
            raise ValueError(f"{given}: expected {' <= '.join(names)}")

    @classmethod
    def create(cls, **values: Any) -> Self:
        """Like the constructor, but an unknown name is a ValueError that lists the valid ones."""
        valid = [field.name for field in dataclasses.fields(cls)]
        unknown = sorted(set(values) - set(valid))
        if unknown:
            said = f"unknown parameter {', '.join(unknown)}; valid: {', '.join(valid)}"
            raise ValueError(asking(said, unknown[0], valid))
        return cls(**values)

    def changed(self) -> dict[str, Any]:
        """The fields that differ from their defaults: name -> value."""
        fields = {field.name: field.default for field in dataclasses.fields(self)}
        return {
            name: getattr(self, name) for name, default in fields.items() if getattr(self, name) != default
        }

    @classmethod
    def dtype(cls) -> np.dtype[np.void]:
        """The fields as a structured dtype, for the compiled kernel."""
        return np.dtype([(field.name, field.type) for field in dataclasses.fields(cls)], align=True)

    def as_array(self) -> NDArray[np.void]:
        """The values as a structured array, shape (1,)."""
        return np.array([dataclasses.astuple(self)], dtype=self.dtype())
