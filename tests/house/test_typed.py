"""Type checkers of users see the annotations of the three packages."""

import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
WHEEL = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["hatch"]["build"]["targets"]["wheel"]


@pytest.mark.parametrize("package", ["estimator", "slipgym", "policies"])
def test_a_package_is_marked_as_typed_in_the_wheel(package):
    assert (ROOT / package / "py.typed").read_bytes() == b""
    assert package in WHEEL["only-include"]  # the whole folder goes into the wheel
    assert "exclude" not in WHEEL
