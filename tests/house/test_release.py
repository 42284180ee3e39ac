"""A release has one version, one address, absolute links in its description, and files that parse."""

import importlib.util
import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
import yaml
from packaging.requirements import Requirement

import slipgym

ROOT = Path(__file__).resolve().parents[2]
PYPROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
PROJECT = PYPROJECT["project"]
REPOSITORY = PROJECT["urls"]["Repository"]
OWNER = REPOSITORY.removeprefix("https://github.com/")


def test_the_version_is_the_same_everywhere():
    assert "version" in PROJECT["dynamic"]
    recipe = yaml.safe_load((ROOT / "conda/recipe.yaml").read_text())
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert recipe["context"]["version"] == citation["version"] == slipgym.__version__
    dated = re.search(r"^## \[([\d.]+)\] - (\S+)$", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)
    assert dated.groups() == (slipgym.__version__, str(citation["date-released"]))
    assert f"git tag -a v{slipgym.__version__} " in (ROOT / "CONTRIBUTING.md").read_text()


def test_the_address_is_the_same_everywhere():
    assert yaml.safe_load((ROOT / "CITATION.cff").read_text())["repository-code"] == REPOSITORY
    places = [
        "pyproject.toml",
        "conda/recipe.yaml",
        "scripts/make_notebooks.py",
        "examples/1_first_rollout.ipynb",
    ]
    for place in places:
        text = (ROOT / place).read_text()
        found = re.findall(r"(?:github\.com|githubusercontent\.com)/([\w-]+/slipgym)\b", text)
        assert set(found) == {OWNER}, place


def test_the_description_of_the_package_has_absolute_links_to_files_that_exist():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    hook = PYPROJECT["tool"]["hatch"]["metadata"]["hooks"]["fancy-pypi-readme"]
    for each in hook["substitutions"]:
        text = re.sub(
            each["pattern"], each["replacement"].replace("$HFPR_VERSION", slipgym.__version__), text
        )
    links = re.findall(r"(!?)\[[^]]*\]\(([^)]+)\)", text)
    assert len(links) > 5
    files = {"": f"{REPOSITORY}/blob/", "!": f"https://raw.githubusercontent.com/{OWNER}/"}
    for kind, link in links:
        assert link.startswith(("https://", "#")), link
        if link.startswith(files[kind]):
            version, _, path = link.removeprefix(files[kind]).partition("/")
            assert version == f"v{slipgym.__version__}"
            assert (ROOT / path.partition("#")[0]).exists(), link


def test_conda_asks_for_what_the_package_asks_for():
    recipe = yaml.safe_load((ROOT / "conda/recipe.yaml").read_text())
    asked = {
        name: f"{versions}"
        for name, _, versions in (run.partition(" ") for run in recipe["requirements"]["run"])
    }
    assert asked.pop("python") == PROJECT["requires-python"]
    wanted = [Requirement(line) for line in PROJECT["dependencies"] if "pybullet" not in line]
    assert {name: set(text.split(",")) for name, text in asked.items()} == {
        each.name: set(str(each.specifier).split(",")) for each in wanted
    }
    (script,) = PROJECT["scripts"].items()
    assert recipe["build"]["python"]["entry_points"] == [" = ".join(script)]


@pytest.mark.parametrize(
    "workflow", sorted((ROOT / ".github/workflows").glob("*.yml")), ids=lambda path: path.stem
)
def test_a_workflow_parses_and_uploads_no_package(workflow):
    text = workflow.read_text()
    found = yaml.safe_load(text)
    assert {"name", "permissions", "jobs"} <= found.keys()
    assert "twine" not in text
    for job in found["jobs"].values():
        assert all(("uses" in step) != ("run" in step) for step in job["steps"])
        for step in job["steps"]:
            for path in re.findall(r"scripts/\w+\.py", step.get("run", "")):
                assert (ROOT / path).is_file()


def test_services_install_extras_that_exist():
    for place in (".readthedocs.yaml", ".github/workflows/pages.yml", "Dockerfile"):
        for extras in re.findall(r"'\.\[([\w,]+)\]'", (ROOT / place).read_text()):
            assert set(extras.split(",")) <= PROJECT["optional-dependencies"].keys(), place
    assert yaml.safe_load((ROOT / ".readthedocs.yaml").read_text())["mkdocs"]["configuration"] == "mkdocs.yml"


def page(folder, output):
    command = [
        sys.executable,
        str(ROOT / "scripts/leaderboard_page.py"),
        str(folder),
        "--output",
        str(output),
    ]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_the_page_of_the_leaderboard_shows_entries_best_first_and_escapes_them(tmp_path):
    pytest.importorskip("jinja2")
    rows = [
        {"task": "Hold", "level": "hard", "policy": name, "solved [%]": share, "low": None}
        for name, share in (("<b>mine</b>", 40.0), ("other", 90.0))
    ]
    board = {"played": {"episodes": 200}, "versions": {"slipgym": "0.3.0", "numpy": "2"}, "rows": rows}
    (tmp_path / "group.json").write_text(json.dumps(board))
    done = page(tmp_path, tmp_path / "board.html")
    assert done.returncode == 0, done.stderr
    text = (tmp_path / "board.html").read_text()
    assert text.index("other") < text.index("&lt;b&gt;mine&lt;/b&gt;")
    assert "<b>mine" not in text
    assert "Rules of entry" in text


@pytest.mark.parametrize(
    "content", ["[]", "{", '{"played": {}, "versions": {}, "rows": [{"task": "Hold"}]}', "3"]
)
def test_a_file_that_is_no_entry_is_named(tmp_path, content):
    (tmp_path / "broken.json").write_text(content)
    done = page(tmp_path, tmp_path / "board.html")
    assert done.returncode == 2
    assert "broken.json" in done.stderr
    assert not (tmp_path / "board.html").exists()


def test_a_notebook_becomes_a_page():
    pytest.importorskip("nbconvert")
    pytest.importorskip("mkdocs")
    spec = importlib.util.spec_from_file_location("pages", ROOT / "docs/site/pages.py")
    pages = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(pages)
    text, pictures = pages.notebook((ROOT / "examples/1_first_rollout.ipynb").read_text(), "1_first_rollout")
    assert pictures
    assert all(name in text for name in pictures)
    assert ".ipynb)" not in text
