"""Names of packages: under slipgym too, and a file of the user's that hides one of them is named."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest


def run(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, *arguments], cwd=folder, capture_output=True, text=True)


@pytest.mark.parametrize("name", ["policies", "estimator"])
def test_a_package_is_found_under_slipgym(name: str) -> None:
    code = (
        f"import {name}, slipgym.{name} as under\n"
        f"assert all(getattr(under, each) is getattr({name}, each) for each in ('make', 'names'))\n"
        f"assert 'make' in dir(under)\n"
        f"from slipgym.{name} import registry\n"
        f"import {name}.registry\n"
        f"assert registry is {name}.registry\n"
    )
    done = run(Path.cwd(), "-c", code)
    assert done.returncode == 0, done.stderr


def test_a_name_that_is_not_there_is_an_attribute_error() -> None:
    import slipgym.policies as under

    with pytest.raises(AttributeError, match="nothing"):
        _ = under.nothing


@pytest.mark.parametrize("name", ["policies", "estimator"])
@pytest.mark.parametrize("kind", ["package", "file"])
def test_a_file_that_hides_a_package_is_named(tmp_path: Path, name: str, kind: str) -> None:
    file = tmp_path / name / "__init__.py" if kind == "package" else tmp_path / f"{name}.py"
    file.parent.mkdir(exist_ok=True)
    file.write_text("")
    done = run(tmp_path, "-m", "slipgym", "--help")
    assert done.returncode == 1
    last = done.stderr.strip().splitlines()[-1]
    assert str(file) in last, done.stderr
    assert "rename it" in last


def test_a_folder_of_data_hides_nothing(tmp_path: Path) -> None:
    (tmp_path / "policies").mkdir()
    done = run(tmp_path, "-m", "slipgym", "--help")
    assert done.returncode == 0, done.stderr
