"""Every command line on README, the pages and in the commands' help is one that the command line takes."""

import re
import shlex
import subprocess
from importlib import import_module
from pathlib import Path

import pytest
import typer

from policies.commands.front import COMMANDS

ROOT = Path(__file__).resolve().parents[2]
LINE = re.compile(r"^(?:    )?(?:python )?(scripts/(\w+)\.py|slipgym ([a-z][\w-]*)|make)(?: +(.*))?$")
EXAMPLE = re.compile(r"^ +slipgym ([a-z][\w-]*)(?: +(.*))?$")
USAGE_ERROR = typer.BadParameter.__bases__[0]
OWN = {"first_use", "lock", "make_docs", "make_notebooks", "matrix", "torture", "wheel_smoke"}
"""Scripts of the repository alone."""


def lines():
    """(page, command, arguments) of each line."""
    found = []
    for page in [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]:
        for line in page.read_text().splitlines():
            if line.startswith("    ") and (match := LINE.match(line.rstrip())):
                name = (match[2] or match[3] or "make").replace("_", "-")
                words = shlex.split((match[4] or "").replace("<time>", "TIME").replace("<folder>", "F"), True)
                found.append((page.relative_to(ROOT), name, tuple(words)))
    return found


def examples():
    """(command, command, arguments) of each example in the help of the commands."""
    found = []
    for name in COMMANDS:
        app = import_module(f"policies.commands.{name.replace('-', '_')}").app
        for line in (app.registered_commands[0].epilog or "").splitlines():
            if match := EXAMPLE.match(line):
                found.append((f"slipgym {name} --help", match[1], tuple(shlex.split(match[2] or "", True))))
    return found


LINES = lines() + examples()


def test_the_pages_have_many():
    assert len(lines()) > 60
    assert len(examples()) > 30
    assert {"evaluate", "study", "train", "estimate", "make"} <= {name for _, name, _ in LINES}


@pytest.mark.parametrize(
    ("page", "name", "words"), LINES, ids=[f"{page}-{name}-{k}" for k, (page, name, _) in enumerate(LINES)]
)
def test_a_documented_command_is_understood(page, name, words):
    if name == "make":
        subprocess.run(["make", "--dry-run", *words], cwd=ROOT, check=True, capture_output=True)
        return
    if name.replace("-", "_") in OWN:
        assert (ROOT / "scripts" / f"{name.replace('-', '_')}.py").is_file()
        return
    assert name in COMMANDS
    app = import_module(f"policies.commands.{name.replace('-', '_')}").app
    if words and words[-1] == "\\":
        words = words[:-1]
    try:
        typer.main.get_command(app).make_context(name, list(words))
    except typer.Exit:
        pass
    except USAGE_ERROR as error:
        pytest.fail(f"{page}: {name} {' '.join(words)}: {error.format_message()}")
