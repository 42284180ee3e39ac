"""What the files around the packages promise."""

import re
import subprocess
import tomllib
from pathlib import Path

import slipgym

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]


def requirement_names(requirements: list[str]) -> set[str]:
    names = {re.split(r"[\[<>=!~ ;]", requirement)[0] for requirement in requirements}
    return {name.lower().replace("_", "-") for name in names}


def test_every_dependency_is_pinned_in_the_constraints():
    lines = (ROOT / "constraints.txt").read_text().splitlines()
    pinned = requirement_names([line for line in lines if not line.startswith("#")])
    wanted = requirement_names(PROJECT["dependencies"])
    for extra in PROJECT["optional-dependencies"].values():
        wanted |= requirement_names(extra)
    assert wanted - pinned == {"slipgym"}


def test_only_the_train_extra_installs_learning_libraries():
    wanted = requirement_names(PROJECT["dependencies"])
    for extra in ("eval", "dev"):
        wanted |= requirement_names(PROJECT["optional-dependencies"][extra])
    assert not wanted & {"torch", "stable-baselines3"}


def test_the_changelog_opens_with_this_version():
    versions = re.findall(r"^## \[(.+?)\]", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)
    assert next(version for version in versions if version != "Unreleased") == slipgym.__version__


def test_make_knows_its_targets_and_lists_them():
    targets = ["demo", "test", "test-all", "lint", "types", "wheel-smoke", "check"]
    subprocess.run(["make", "--dry-run", *targets], cwd=ROOT, check=True, capture_output=True)
    listed = subprocess.run(["make", "help"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    for target in targets:
        assert re.search(rf"^  {target} ", listed, re.MULTILINE)


def test_make_says_so_when_python_is_too_old(tmp_path):
    (tmp_path / "Makefile").write_text((ROOT / "Makefile").read_text())
    old = tmp_path / "old-python"
    old.write_text("#!/bin/sh\nexit 1\n")
    old.chmod(0o755)
    done = subprocess.run(
        ["make", ".venv/bin/python", f"PYTHON={old}"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode != 0
    assert "needs Python 3.11" in done.stderr
