"""One function reads every kind of YAML file into its model."""

import pytest
from pydantic import Field

from slipgym.config.base import Count, Frozen
from slipgym.config.yaml_model import names, read_model, validate


class Model(Frozen):
    """A model."""

    count: Count = Field(description="How many")


def read(choice):
    return read_model(choice, Model, "randomization", "model")


def test_a_mapping_a_file_and_a_name(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("count: 3")
    assert read({"count": 3}) == read(path) == read(str(path)) == Model(count=3)
    assert "train" in names("randomization")
    with pytest.raises(ValueError, match=r"train\.yaml: .*unknown key"):
        read("train")


@pytest.mark.parametrize(
    ("choice", "message"),
    [
        ("trian", r"unknown model 'trian'; did you mean 'train'"),
        ({"cuont": 3}, r"model argument: cuont: unknown key 'cuont'; did you mean 'count'"),
        ({"count": 0}, r"model argument: count = 0: must be a whole number >= 1 \(How many\)"),
        (3, r"model = 3 must be a name, a path or a mapping; names: .*train"),
    ],
)
def test_errors_name_what_is_valid(choice, message):
    with pytest.raises(ValueError, match=message):
        read(choice)


def test_a_missing_file_is_said_to_be_missing(tmp_path):
    with pytest.raises(FileNotFoundError):
        read(tmp_path / "none.yaml")


def test_a_source_may_depend_on_the_key():
    with pytest.raises(ValueError, match=r"^count's file: count = 0"):
        validate({"count": 0}, Model, lambda location: f"{location[0]}'s file")
