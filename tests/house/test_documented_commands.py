"""Every command line of pages and help is understood, and those of the pages run.

`documented_commands.yaml` says how each is run, or why not; as a script this file prints it.
"""

import os
import re
import shlex
import subprocess
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import pytest
import typer
import yaml

from lab.commands import COMMANDS as LAB
from policies.commands.front import COMMANDS as PRODUCT
from policies.commands.front import application

ROOT = Path(__file__).resolve().parents[2]
COMMAND = r"(?:python )?(scripts/(?P<script>\w+)\.py|slipgym (?P<name>[a-z][\w-]*)|make)"
LINE = re.compile(rf"^ +{COMMAND}(?: +(?P<words>.*))?$")
INLINE = re.compile(rf"`{COMMAND} (?P<words>[^`]+)`")
OPTION = re.compile(r"`slipgym ([a-z][\w-]*) (--[\w-]+)`|`scripts/(\w+)\.py (--[\w-]+)`")
"""A sentence that names an option of a command."""
USAGE_ERROR = typer.BadParameter.__bases__[0]
COMMANDS = PRODUCT | LAB
OWN = {"lock", "make-docs", "make-notebooks", "matrix", "wheel-smoke"}
"""Scripts of the repository alone."""
TARGETS = {"make validate", "make benchmark"}
"""Commands within a sentence that state figures; the other targets are those of development."""
RUNS: dict[str, dict[str, Any]] = yaml.safe_load(
    (ROOT / "tests/house/documented_commands.yaml").read_text(encoding="utf-8")
)


def parsed(match: re.Match[str]) -> tuple[str, tuple[str, ...]]:
    name = match["script"] or match["name"] or "make"
    text = (match["words"] or "").replace("<time>", "TIME").replace("<folder>", "F").rstrip("\\")
    return name.replace("_", "-"), tuple(shlex.split(text, True))


def command(name: str) -> Any:
    """The sub-command of a name."""
    return typer.main.get_command(application(name))


def lines() -> list[tuple[Path, str, tuple[str, ...]]]:
    """(page, command, arguments) of each line, and of each command with arguments within a sentence."""
    found = []
    for page in [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]:
        for line in page.read_text(encoding="utf-8").splitlines():
            block = line.startswith("    ")
            for match in LINE.finditer(line.rstrip()) if block else INLINE.finditer(OPTION.sub("", line)):
                name, words = parsed(match)
                if name != "make" or block or f"make {' '.join(words)}" in TARGETS:
                    found.append((page.relative_to(ROOT), name, words))
    return found


def examples():
    """(command, command, arguments) of each example in the help of the commands."""
    found = []
    for name in COMMANDS:
        for line in (command(name).epilog or "").splitlines():
            if match := LINE.match(line):
                found.append((f"slipgym {name} --help", *parsed(match)))
    return found


LINES = lines()
DOCUMENTED = sorted({" ".join([name, *words]) for _, name, words in LINES})


def test_the_pages_have_many():
    assert len(LINES) > 60
    assert len(examples()) > 30
    assert {"evaluate", "study", "train", "estimate", "make"} <= {name for _, name, _ in LINES}


ALL = LINES + examples()


@pytest.mark.parametrize(
    ("page", "name", "words"), ALL, ids=[f"{page}-{name}-{k}" for k, (page, name, _) in enumerate(ALL)]
)
def test_a_documented_command_is_understood(page, name, words):
    if name == "make":
        make = ["make", "--dry-run", f"PYTHON={sys.executable}"]
        subprocess.run([*make, *words], cwd=ROOT, check=True, capture_output=True)
        return
    if name in OWN:
        assert (ROOT / "scripts" / f"{name.replace('-', '_')}.py").is_file()
        return
    assert name in COMMANDS
    try:
        found = command(name)
        if parts := getattr(found, "commands", {}):
            name, *words = words
            found = parts[name]
        found.make_context(name, list(words))
    except typer.Exit:
        pass
    except USAGE_ERROR as error:
        pytest.fail(f"{page}: {name} {' '.join(words)}: {error.format_message()}")


def test_the_help_of_every_command_has_examples():
    for name in COMMANDS:
        assert "Examples:" in (command(name).epilog or ""), name


def test_an_option_that_a_sentence_names_exists():
    for page in (ROOT / "docs").rglob("*.md"):
        for match in OPTION.finditer(page.read_text(encoding="utf-8")):
            name, option = (match[1] or match[3]).replace("_", "-"), match[2] or match[4]
            assert option in {each for parameter in command(name).params for each in parameter.opts}, page


def test_every_documented_command_is_run_or_says_why_not():
    assert [command for command in DOCUMENTED if command not in RUNS] == []
    assert [command for command in RUNS if command not in DOCUMENTED] == []
    ways = {"test", "like", "unrun"}
    for command, how in RUNS.items():
        assert set(how) <= {"with", "after", "prints", "writes"} or len(set(how) & ways) == len(how) == 1, (
            command
        )
        assert how, command
        if "like" in how:
            assert not set(RUNS[how["like"]]) & ways, f"{command}: {how['like']} is not run itself"
        if "test" in how:
            assert (ROOT / how["test"]).is_file(), how["test"]


def run(command: str, folder: Path) -> str:
    """What a command prints in a folder that has the repository's examples."""
    name, *words = shlex.split(command)
    done = subprocess.run(
        [sys.executable, "-m", "slipgym", name, *words],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "100"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, f"{command}\n{done.stdout[-1000:]}\n{done.stderr[-3000:]}"
    return done.stdout


@pytest.mark.slow
@pytest.mark.parametrize(
    "command", [key for key, how in RUNS.items() if not {"test", "like", "unrun"} & set(how)]
)
def test_a_documented_command_does_what_it_says(command, tmp_path):
    how = RUNS[command]
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    for first in how.get("after", []):
        run(first, tmp_path)
    printed = run(f"{command} {how.get('with', '')}", tmp_path)
    assert re.search(how.get("prints", ""), printed), printed
    assert not how.get("writes") or list(tmp_path.glob(how["writes"])), sorted(tmp_path.rglob("*"))


if __name__ == "__main__":
    for command in DOCUMENTED:
        how = RUNS.get(command, {})
        way = next((key for key in ("unrun", "test", "like", "with") if key in how), "as printed")
        print(f"{command}\n    {way}{': ' + str(how[way]) if way in how else ''}")
    print(
        Counter(
            next((key for key in ("unrun", "test", "like", "with") if key in RUNS[c]), "as printed")
            for c in RUNS
        )
    )
