"""A seeded sample of the figures that README and the pages claim is printed again, and compared with them.

A figure is a success rate over seeded episodes, which repeats to the last episode on one processor;
another processor may round differently. Beyond `TOLERANCE` the page is older than the code.
"""

import random
import re
from pathlib import Path

import pytest

from policies.policy_leaderboard.run import outcomes
from policies.reward_order.zoo import Member, controllers, learned, remembering
from slipgym.tasks import find

ROOT = Path(__file__).resolve().parents[2]
EPISODES = 200
TOLERANCE = 2.0
"""Percentage points, four episodes."""
SAMPLE = 8
"""Figures of each page."""
ARGUMENTS = {"sensors": "realistic", "randomization": "none", "estimator": "adaptive"}


def tables(page: str) -> dict[tuple[str, str, str], float]:
    """(task, level, column) -> success [%] of the tables with a task and a level in each row."""
    found = {}
    head: list[str] = []
    for line in (ROOT / page).read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if cells[:2] == ["task", "level"]:
            head = cells[2:]
        elif not line.startswith("|"):
            head = []
        elif head and not line.startswith("| ---"):
            found |= {
                (cells[0], cells[1], name): float(cell)
                for name, cell in zip(head, cells[2:], strict=True)
                if cell != "–"
            }
    return found


README, LEVELS = tables("README.md"), tables("docs/results/levels.txt")
CLAIMS = [
    (page, *key)
    for page in ("README.md", "docs/results/levels.txt")
    for key in random.Random(24).sample([key for key in tables(page) if key[2] != "best constant"], SAMPLE)
]
"""The sample: (page, task, level, column)."""


def member(task: str, column: str) -> Member:
    key = find(task).key
    if column == "memory of slips":
        return remembering(key)
    name = column if column.startswith("learned") else f"controller, {column}"
    (found,) = [each for each in (*controllers(key), *learned(key)) if each.name == name]
    return found


def test_the_tables_are_found():
    assert len(README) > 50
    assert len(LEVELS) > 150
    assert {task for task, _, _ in LEVELS} > {"Hold", "Carry", "PivotTo"}


def test_the_readme_says_what_the_page_says():
    assert {key: README[key] for key in README if key in LEVELS} == {
        key: LEVELS[key] for key in LEVELS if key in README
    }


def test_the_sentence_below_the_table_is_about_its_figures():
    """Whether the estimates are worth more than a memory of slips, by README's own table."""
    text = " ".join((ROOT / "README.md").read_text(encoding="utf-8").split())
    (figures,) = re.findall(
        r"worth about (\d+) points in PlanarSlip \"hard\", (\d+) to (\d+) in FragileHold and Carry, and ",
        text,
    )
    planar, low, high = map(float, figures)

    def gain(task: str) -> float:
        return README[task, "hard", "estimated"] - README[task, "hard", "memory of slips"]

    assert planar == pytest.approx(gain("PlanarSlip"), abs=0.5)
    assert (low, high) == pytest.approx(sorted(map(gain, ("FragileHold", "Carry"))), abs=0.5)
    (less,) = re.findall(r"nothing in RotationalSlip and PivotTo \((\d+) points less in the latter\)", text)
    assert abs(gain("RotationalSlip")) < 1.0
    assert -gain("PivotTo") == pytest.approx(float(less), abs=0.5)
    assert min(gain(task) for task in ("Hinge", "Hold")) > 50.0


@pytest.mark.slow
@pytest.mark.parametrize(("page", "task", "level", "column"), CLAIMS)
def test_a_figure_is_printed_again(page, task, level, column):
    (row,) = outcomes(task, level, [member(task, column)], EPISODES, ARGUMENTS, progress=False).to_dict(
        "records"
    )
    assert row["solved [%]"] == pytest.approx(tables(page)[task, level, column], abs=TOLERANCE)
