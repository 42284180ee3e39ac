"""The files of docs/results: title, head with command and commit, and what the command printed."""

from __future__ import annotations

import platform
import re
import subprocess
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from lab.results.declarations import RESULTS, Result
from slipgym import atomic_io

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "docs" / "results"
INDEX = FOLDER / "README.md"
IMAGES = ROOT / "docs" / "images"
LIBRARIES = ("numpy", "numba", "gymnasium", "pybullet", "torch", "mujoco", "drake", "newton")
"""Libraries whose versions stand in the head."""
LAST = "Look at:"
"""Line from which the commands print paths of the machine."""
RULE = re.compile(r":?-{3,}:?")


def path(result: Result) -> Path:
    """The file of a result."""
    return FOLDER / f"{result.name}.txt"


def commit() -> str:
    """The commit of the working tree; " + changes" follows if tracked files outside docs differ."""
    name = _git("rev-parse", "--short=10", "HEAD")
    changed = _git("status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs")
    return f"{name} + changes" if changed else name


def versions() -> str:
    """Versions of Python and of the installed `LIBRARIES`."""
    found = [f"Python {platform.python_version()}"]
    for name in LIBRARIES:
        try:
            found.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            continue
    return ", ".join(found)


def head(result: Result, at: str, day: str, libraries: str) -> str:
    """The first lines of a file.

    Args:
        result: Its declaration.
        at: Commit at which it was printed.
        day: Date at which it was printed.
        libraries: Versions of the libraries.
    """
    return _head(result, f"printed: {day}, commit {at}", f"with:    {libraries}")


def awaited(result: Result) -> str:
    """The file of a result that was declared after the last `make results`: a head and no figures."""
    return _head(result, "printed: not yet") + "\n"


def _head(result: Result, *printed: str) -> str:
    """The first lines of a file.

    Args:
        result: Its declaration.
        printed: Lines that say when and with what it was printed.
    """
    commands = [f"command: slipgym {command}" for command in result.commands]
    return "\n".join([result.question, "", *commands, *printed, f"page:    docs/{result.page}"]) + "\n"


def body(result: Result, printed: str) -> str:
    """The part of an output that is kept, with aligned tables.

    Args:
        result: Its declaration: first line, sections.
        printed: The standard output of a command.

    Raises:
        ValueError: Nothing is left, or a section is missing.
    """
    lines = [line.rstrip() for line in printed.splitlines()]
    first = next((k for k, line in enumerate(lines) if line.startswith(result.begins)), len(lines))
    last = next((k for k, line in enumerate(lines) if line.startswith(LAST)), len(lines))
    text = re.sub(r"\n{3,}", "\n\n", "\n".join(lines[first:last])).strip("\n")
    text = re.sub(r"\A# .*\n+", "", text)
    if result.keep:
        sections = dict(re.findall(r"^#+ (.+)\n+((?:(?!#+ ).*\n?)*)", text, re.MULTILINE))
        lacking = [title for title in result.keep if title not in sections]
        if lacking:
            raise ValueError(f"{result.name}: the output has no section {', '.join(lacking)}")
        text = "\n\n".join(f"## {title}\n\n{sections[title].strip()}" for title in result.keep)
    if not text:
        raise ValueError(f"{result.name}: nothing was printed")
    return aligned(text)


def aligned(text: str) -> str:
    """The text with the cells of each Markdown table padded to equal widths."""
    return re.sub(r"(?:^\|.*\|\n?)+", lambda match: _padded(match[0]), text, flags=re.MULTILINE)


def _padded(table: str) -> str:
    """A Markdown table with padded cells; a column with "---:" is aligned to the right."""
    rows = [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in table.splitlines()]
    rules = rows[1] if len(rows) > 1 and all(map(RULE.fullmatch, rows[1])) else [""] * len(rows[0])
    widths = [max(len(row[k]) for row in rows if k < len(row)) for k in range(len(rows[0]))]
    lines = []
    for row in rows:
        cells = []
        for cell, rule, width in zip(row, rules, widths, strict=True):
            right = rule.endswith(":")
            filled = ("-" * width)[:-1] + (":" if right else "-") if RULE.fullmatch(cell) else cell
            cells.append(filled.rjust(width) if right else filled.ljust(width))
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + ("\n" if table.endswith("\n") else "")


def write(result: Result, outputs: list[str], at: str) -> None:
    """Write the file of a result, the index and the pictures, each whole or not at all.

    Args:
        result: Its declaration.
        outputs: Standard output of each of its commands.
        at: Commit of the working tree when the run began.
    """
    bodies = [body(result, printed) for printed in outputs]
    pictures = {new: content for printed in outputs for new, content in drawn(result, printed).items()}
    if len(bodies) > 1:
        bodies = [f"## {command}\n\n{text}" for command, text in zip(result.commands, bodies, strict=True)]
    day = f"{datetime.now(UTC):%Y-%m-%d}"
    text = "\n".join([head(result, at, day, versions()), "\n\n".join(bodies), ""])
    FOLDER.mkdir(parents=True, exist_ok=True)
    atomic_io.write(path(result), text.encode())
    atomic_io.write(INDEX, index().encode())
    for name, content in pictures.items():
        atomic_io.write(IMAGES / name, content)


def drawn(result: Result, printed: str) -> dict[str, bytes]:
    """The pictures of a run: name in docs/images -> content.

    Raises:
        ValueError: The output does not say where one is.
    """
    _, _, listed = printed.partition(f"\n{LAST}\n")
    paths = {Path(line.strip()).name: ROOT / line.strip() for line in listed.splitlines() if line.strip()}
    lacking = [name for name in result.pictures if name not in paths]
    if lacking:
        raise ValueError(f"{result.name}: the run has no picture {', '.join(lacking)}")
    return {new: paths[name].read_bytes() for name, new in result.pictures.items()}


def index() -> str:
    """The page that lists all results."""
    lines = [
        "# Results",
        "",
        "Each file holds what its command printed, with commit and date. `make results` prints all of them",
        "again, `python -m lab.results NAME ...` some. No figure is edited by hand. A file that says",
        "`printed: not yet` waits for the next `make results`.",
        "",
        "| result | page | minutes |",
        "| --- | --- | ---: |",
    ]
    for result in RESULTS:
        title = f"[{result.question}]({path(result).name})"
        lines.append(f"| {title} | [{result.page}](../{result.page}) | {result.minutes:g} |")
    return "\n".join(lines) + "\n"


def _git(*arguments: str) -> str:
    """What git prints in the repository."""
    done = subprocess.run(["git", *arguments], cwd=ROOT, check=True, capture_output=True, text=True)
    return done.stdout.strip()
