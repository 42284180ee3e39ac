"""The tables that the site fills in are named on pages, and say what the declarations say."""

import importlib
import re
import sys
from pathlib import Path

import gymnasium as gym
import pytest

from slipgym.config import load_randomization
from slipgym.config.randomization import Ranges
from slipgym.registration import ENVIRONMENTS
from slipgym.tasks import find
from slipgym.tasks.episode import EPISODE
from slipgym.world.records import FINGER, WORLD

DOCS = Path(__file__).resolve().parents[2] / "docs"


@pytest.fixture(scope="module")
def tables():
    sys.path.insert(0, str(DOCS / "site"))
    try:
        return importlib.import_module("tables")
    finally:
        sys.path.remove(str(DOCS / "site"))


def rows(table: str) -> list[list[str]]:
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines()[2:]]


def test_every_table_stands_on_one_page_and_every_mark_has_a_table(tables):
    marks = [
        name for page in DOCS.rglob("*.md") for name in tables.MARK.findall(page.read_text(encoding="utf-8"))
    ]
    assert sorted(marks) == sorted(tables.TABLES)


def test_a_page_is_filled(tables):
    assert (
        tables.filled("a\n\n<!-- table: privileged columns -->\n") == f"a\n\n{tables.privileged_columns()}\n"
    )
    with pytest.raises(KeyError):
        tables.filled("<!-- table: of nothing -->")


def test_every_row_has_the_columns_of_its_head(tables):
    for write in tables.TABLES.values():
        head, *lines = write().splitlines()
        assert len(lines) > 5
        assert {line.count(" | ") for line in lines[1:]} == {head.count(" | ")}


def test_privileged_columns_are_those_of_the_environment(tables):
    env = gym.make("slipgym:slipgym/LinearSlip-v0", engine="planar", observation_mode="dict")
    listed = [row[0].strip("`") for row in rows(tables.privileged_columns())]
    assert listed == [column.name for column in env.unwrapped.privileged_columns]


def test_fields_are_those_of_the_presets(tables):
    found = {row[0].strip("`"): row[1:] for row in rows(tables.fields())}
    assert found.keys() == Ranges.model_fields.keys() - {"disturbances"}
    low, high = re.match(r"(\S+) to (\S+)$", found["mu_c"][1]).groups()
    assert (float(low), float(high)) == load_randomization("train").mu_c.ends


def test_record_fields_are_those_of_the_records(tables):
    found = rows(tables.record_fields())
    records = {"episode": EPISODE, "world": WORLD, "fingers[f]": FINGER}
    expected = [f"{record}.{name}" for record, dtype in records.items() for name in dtype.names]
    assert [re.match("`(.+)`", row[0])[1] for row in found] == expected
    assert all(meaning for *_, meaning in found)
    assert [row[0] for row in found if not row[1] and row[0].startswith("`episode.")] == []
    assert ["`world.slip` (3)", "m, m, rad", "slip displacement (x, y, theta)"] in found


def test_disturbances_and_tasks_are_those_of_the_presets(tables):
    for preset in ("train", "eval_ood"):
        chosen = load_randomization(preset)
        kinds = [row[1].strip("`") for row in rows(tables.disturbances()) if row[0] == preset]
        assert kinds == [disturbance.kind for disturbance in chosen.disturbances]
        tasks = [row[1].strip("`") for row in rows(tables.single_tasks()) if row[0] == preset]
        assert tasks == list(chosen.tasks)


def test_the_sums_of_the_scales_are_those_of_the_tasks():
    """The table of docs/rewards.md; terms that are negative say so by their meaning."""
    expected = []
    for name in ENVIRONMENTS:
        task = find(name)
        dense = [term for term in task.terms if not term.event or term.name == "following"]
        negative = sum(term.scale for term in dense if term.meaning.startswith(("-", "(S / ln 100 - 1)")))
        positive = sum(term.scale for term in dense) - negative
        expected.append(f"| {task.name} | {positive:g} | {negative:g} |")
    page = (DOCS / "rewards.md").read_text(encoding="utf-8")
    shown = [line for line in page.splitlines() if re.match(r"\| [A-Z]\w+ \|", line)]
    assert sorted(shown) == sorted(expected)  # other tests register tasks, and one of these again
