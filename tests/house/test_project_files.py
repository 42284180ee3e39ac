"""The files for contributors: they parse, agree with the project's versions, and name files that exist."""

import re
import tomllib
from pathlib import Path

import pytest
import yaml

import slipgym

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
TEMPLATES = sorted((ROOT / ".github" / "ISSUE_TEMPLATE").glob("*.yml"))


def test_the_citation_has_what_a_reader_needs():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert {"cff-version", "message", "title", "authors", "version", "license"} <= citation.keys()
    assert citation["version"] == slipgym.__version__
    assert citation["license"] == PROJECT["license"]
    papers = {reference["identifiers"][0]["value"] for reference in citation["references"]}
    assert papers == {"arXiv:2507.06824", "arXiv:2308.01123", "arXiv:2410.19660"}
    for reference in citation["references"]:
        assert reference["title"]
        assert [author["family-names"] for author in reference["authors"]] == ["Waltersson", "Karayiannidis"]


def test_pre_commit_uses_the_ruff_of_the_constraints():
    hooks = yaml.safe_load((ROOT / ".pre-commit-config.yaml").read_text())["repos"]
    ruff = next(repository for repository in hooks if repository["repo"].endswith("ruff-pre-commit"))
    pinned = re.search(r"^ruff==(.+)$", (ROOT / "constraints.txt").read_text(), re.MULTILINE)[1]
    assert ruff["rev"] == f"v{pinned}"


@pytest.mark.parametrize("template", TEMPLATES, ids=[path.stem for path in TEMPLATES])
def test_an_issue_template_is_a_form(template):
    form = yaml.safe_load(template.read_text())
    assert form["name"]
    assert form["description"]
    inputs = [part for part in form["body"] if part["type"] != "markdown"]
    assert len({part["id"] for part in inputs}) == len(inputs)
    assert all(part["attributes"]["label"] for part in inputs)


def test_there_is_a_template_for_each_kind_of_issue():
    assert {path.stem for path in TEMPLATES} == {"bug", "feature", "physics"}


def test_contributing_names_files_and_targets_that_exist():
    page = (ROOT / "CONTRIBUTING.md").read_text()
    paths = re.findall(r"(?<![\w.])((?:slipgym|estimator|policies|configs|scripts|tests|docs)/[\w./]*)", page)
    assert len(paths) > 20
    assert [path for path in paths if not (ROOT / path.rstrip(".")).exists()] == []
    makefile = (ROOT / "Makefile").read_text()
    targets = set(re.findall(r"`make ([\w-]+)`", page))
    assert [target for target in targets if not re.search(rf"^{target}:", makefile, re.MULTILINE)] == []
