"""The README's examples run as they are printed."""

import math
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text()
EXAMPLES = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
MOST = 700
"""Words that a reader takes in before the first try."""


def test_the_page_is_short():
    assert len(README.split()) <= MOST


def claim() -> str:
    """README's table from docs/results/worth.txt: the realistic sensors, and the gain with "lab"."""
    printed = (ROOT / "docs/results/worth.txt").read_text().split("Worth of friction:")[1:]
    tables = [part.split("\n\n")[1] for part in printed]
    realistic, lab = (
        [
            [cell.strip() for cell in row.strip("|").split("|")]
            for row in re.findall(r"^\|.*hard.*\|$", part, re.MULTILINE)
        ]
        for part in tables
    )
    gain = {row[0]: (row[6], row[7], row[8]) for row in lab}
    lines = [
        "| task | strongest policy without friction | without | estimated | true | gain "
        "| gain, lab sensors |",
        "| --- | --- | ---: | ---: | ---: | ---: | ---: |",
    ]
    for task, _, name, without, estimated, true, *own in realistic:
        cells = [f"{rounded(value):.0f}" for value in (without, estimated, true)]
        lines.append(f"| {task} | {name} | {' | '.join([*cells, points(*own), points(*gain[task])])} |")
    return "\n".join(lines)


def number(text: str) -> float:
    return float(text.replace("−", "-"))


def rounded(text: str) -> float:
    """To whole numbers, halves away from zero."""
    return math.trunc(number(text) + math.copysign(0.5, number(text)))


def points(mean: str, low: str, high: str) -> str:
    """A gain; bold if its interval leaves 0 out."""
    shown = f"{rounded(mean):+.0f}".replace("-", "−") if rounded(mean) else "0"
    return f"**{shown}**" if number(low) * number(high) > 0.0 else shown


def test_the_claim_is_what_was_printed():
    assert claim() in README


def test_the_first_sentence_of_the_claim_has_the_figures_of_the_table():
    said = re.search(r"in Hold: (\d+) points .*?, (\d+) with a laboratory's sensors", README)
    (hold,) = re.findall(r"^\| Hold .*\|$", README, re.MULTILINE)
    assert said is not None
    assert list(said.groups()) == re.findall(r"\+(\d+)", hold)


def test_there_are_examples():
    assert len(EXAMPLES) == 2


@pytest.mark.parametrize(
    "example", EXAMPLES, ids=[re.findall(r"import (\w+)", text)[-1] for text in EXAMPLES]
)
def test_example_runs(example):
    done = subprocess.run(
        [sys.executable, "-c", example.replace("1_000_000", "10_000")],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    if find_spec("pybullet") is None and "needs PyBullet" in done.stderr:
        pytest.skip("needs PyBullet")
    assert done.returncode == 0, done.stderr
