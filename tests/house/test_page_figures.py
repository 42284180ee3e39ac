"""A seeded sample of the figures in docs/results/levels.txt is printed again, and compared with them.

A figure is a success rate over seeded episodes, which repeats to the last episode on one processor;
another processor may round differently. Beyond `TOLERANCE` the page is older than the code.
"""

import random
from pathlib import Path

import pytest

from policies.policy_leaderboard.entries import Member, bounds, controllers, further, learned, remembering
from policies.policy_leaderboard.run import outcomes, play_all
from slipgym.tasks import find

ROOT = Path(__file__).resolve().parents[2]
EPISODES = 200
TOLERANCE = 2.0
"""Percentage points, four episodes."""
SAMPLE = 12
ARGUMENTS = {"sensors": "realistic", "randomization": "none", "estimator": "adaptive"}


def table() -> dict[tuple[str, str, str], float]:
    """(task, level, column) -> success [%]."""
    found = {}
    head: list[str] = []
    text = (ROOT / "docs/results/levels.txt").read_text(encoding="utf-8").partition("Worth of friction:")[0]
    for line in text.splitlines():
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


TABLE = table()
CLAIMS = random.Random(24).sample([key for key in TABLE if key[2] != "best constant"], SAMPLE)


def member(task: str, level: str, column: str) -> Member:
    key = find(task).key
    if column == "controller, memory of slips":
        return remembering(task, {**ARGUMENTS, "level": level}, EPISODES)
    members = [*controllers(key), *further(task), *learned(key), *bounds(key)]
    return {each.name: each for each in members}[column]


def test_the_table_is_found():
    assert len(TABLE) > 150
    assert {task for task, _, _ in TABLE} > {"Hold", "Carry", "PivotTo"}


@pytest.mark.slow
@pytest.mark.parametrize(("task", "level", "column"), CLAIMS)
def test_a_figure_is_printed_again(task, level, column):
    played = play_all(task, level, [member(task, level, column)], EPISODES, ARGUMENTS, progress=False)
    (row,) = outcomes(task, level, played).to_dict("records")
    assert row["solved [%]"] == pytest.approx(TABLE[task, level, column], abs=TOLERANCE)
