"""Rules that hold for every field of every model."""

import re
from collections.abc import Iterator
from typing import get_args

import pytest
from pydantic import BaseModel, Field, ValidationError

from slipgym import config
from slipgym.config.base import Frozen

UNIT = re.compile(r"\w.* \[[^\[\]]+\]$")


def models(model: type[BaseModel]) -> Iterator[type[BaseModel]]:
    """A model and all that it is made of."""
    yield model
    for field in model.model_fields.values():
        for kind in (field.annotation, *get_args(field.annotation)):
            if isinstance(kind, type) and issubclass(kind, BaseModel):
                yield from models(kind)


def undescribed(model: type[BaseModel]) -> list[str]:
    """The fields without a description, and those whose unit is missing or says nothing."""
    return [
        f"{part.__name__}.{name}"
        for part in models(model)
        for name, field in part.model_fields.items()
        if not field.description or is_number(field.annotation) != bool(UNIT.search(field.description))
    ]


def is_number(kind: object) -> bool:
    """Whether a type holds numbers: a float, an integer, or a tuple of them."""
    if kind in (float, int):
        return True
    return kind not in (bool, str) and not isinstance(kind, type) and any(map(is_number, get_args(kind)))


def leaves(value: object, path: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    """The places of all numbers in a nested mapping."""
    if isinstance(value, dict):
        for key, child in value.items():
            yield from leaves(child, (*path, key))
    elif isinstance(value, float):
        yield path


def nested(path: tuple[str, ...], value: object) -> dict:
    for key in reversed(path):
        value = {key: value}
    return value


def test_every_field_says_what_it_is_and_its_unit():
    assert undescribed(config.Config) == []


def test_the_rule_finds_what_it_is_for():
    class Part(Frozen):
        bare: float
        unitless: float = Field(description="A length")
        good: float = Field(description="A length [m]")
        name: str = Field(description="A name")
        odd: str = Field(description="A name [-]")

    class Whole(Frozen):
        part: dict[str, Part] = Field(description="Parts")

    assert undescribed(Whole) == ["Part.bare", "Part.unitless", "Part.odd"]


def test_every_part_is_frozen_strict_and_documented():
    parts = set(models(config.Config))
    assert len(parts) >= 10
    for part in parts:
        assert issubclass(part, Frozen)
        assert part.__doc__
        settings = part.model_config
        assert settings.get("frozen")
        assert settings.get("strict")
        assert settings.get("extra") == "forbid"
        assert settings.get("allow_inf_nan") is False


def test_the_numbers_live_in_the_files_alone():
    for part in set(models(config.Config)):
        assert all(field.is_required() for field in part.model_fields.values()), part
    with pytest.raises(ValidationError):
        config.GripperConfig()


@pytest.mark.parametrize("path", list(leaves(config.load().model_dump())), ids=".".join)
def test_no_number_takes_what_is_not_a_finite_number(path):
    for bad in (float("nan"), float("inf"), "1", None, True, []):
        with pytest.raises(ValueError, match=re.escape(".".join(path))):
            config.load(nested(path, bad))
