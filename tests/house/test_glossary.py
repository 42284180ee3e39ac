"""docs/glossary.md: every term has a link and names in the code that exist; a script makes the drawing."""

import importlib
import re
import subprocess
import sys
from pathlib import Path

import gymnasium as gym
import pytest

from slipgym.config import load

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "glossary.md").read_text()
ENVIRONMENT = "".join(
    (ROOT / "docs" / "environments" / f"{name}.md").read_text() for name in ("common", "linear_slip")
)
MODES = (ROOT / "docs" / "modes.md").read_text()
PRIVILEGED = gym.make(
    "slipgym:slipgym/Hold-v0", engine="planar", observation_mode="dict"
).unwrapped.privileged_columns
ENTRIES = [part for part in PAGE.split("\n\n") if part.startswith("**")]
SECTIONS = {
    "argument": ("## Arguments", ENVIRONMENT),
    "option": ("## Reset Options", ENVIRONMENT),
    "info": ("## Info", ENVIRONMENT),
}
PACKAGES = ("slipgym.", "estimator.", "policies.", "gymnasium.")


def names(entry: str) -> list[tuple[str, str]]:
    """The code names of an entry, each with its kind: "" for a path, else "argument", "option", "column"."""
    code = re.search(r"\*Code\*:(.+)", entry, re.DOTALL)[1]
    return re.findall(r"(argument|option|column)?\s*`([^`]+)`", code)


def resolve(path: str) -> object:
    """What a dotted path names: a module, or an attribute of one.

    Raises:
        LookupError: It names nothing.
    """
    parts = path.split(".")
    for k in range(len(parts), 0, -1):
        try:
            found = importlib.import_module(".".join(parts[:k]))
        except ModuleNotFoundError:
            continue
        for part in parts[k:]:
            if not hasattr(found, part):
                raise LookupError(f"{path}: no {part}")
            found = getattr(found, part)
        return found
    raise LookupError(f"{path}: no such module")


def listed(title: str, page: str) -> set[str]:
    section = re.search(rf"^{title}\n(.*?)(?=^## |\Z)", page, re.DOTALL | re.MULTILINE)[1]
    return set(re.findall(r"^\| `(\w+)` \|", section, re.MULTILINE))


def exists(kind: str, name: str) -> bool:
    info = re.fullmatch(r'info\["(\w+)"\]', name)
    if info:
        return info[1] in listed(*SECTIONS["info"])
    if kind == "column":
        columns = set(re.findall(r"^\| -?\d+ \| `(\w+)`:", ENVIRONMENT, re.MULTILINE))
        columns |= {column.name for column in PRIVILEGED}
        return name in columns | set(re.findall(r"^\| `(\w+)` \|", MODES, re.MULTILINE))
    if kind:
        return name in listed(*SECTIONS[kind])
    if name.startswith(PACKAGES) or name in ("policies", "estimator", "slipgym"):
        return resolve(name) is not None
    found = load().model_dump()
    for part in name.split("."):
        found = found[part]
    return True


@pytest.mark.parametrize("entry", ENTRIES, ids=[re.search(r"\*\*(.+?)\*\*", e)[1] for e in ENTRIES])
def test_a_term_has_names_that_exist_and_a_link(entry):
    assert names(entry)
    assert [name for kind, name in names(entry) if not exists(kind, name)] == []
    assert re.search(r"\[[^]]+\]\([\w/]+\.md(#[\w-]+)?\)", entry)


@pytest.mark.parametrize("kind", ["argument", "option", "column"])
def test_a_name_that_does_not_exist_is_found(kind):
    assert not exists(kind, "flux")
    with pytest.raises(LookupError):
        exists("", "slipgym.contact.Flux")
    with pytest.raises(KeyError):
        exists("", "contact.flux")


@pytest.mark.slow
def test_the_drawing_is_made_by_its_script(tmp_path):
    script = ROOT / "docs" / "drawings" / "frames.py"
    subprocess.run(
        [sys.executable, script, tmp_path / "frames.png"], cwd=ROOT, check=True, capture_output=True
    )
    assert (tmp_path / "frames.png").stat().st_size > 50_000
    assert "images/frames.png" in PAGE
