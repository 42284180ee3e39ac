"""docs/randomization.md says what the presets say, and its example runs."""

import re
from pathlib import Path

import numpy as np
import pytest

from slipgym.config import load_randomization
from slipgym.config.distribution import Distribution
from slipgym.config.randomization import Ranges

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "randomization.md").read_text()
TASKS = (
    *("hold", "fragile_hold", "carry", "explore", "pivot_to", "rotational_slip"),
    *("hinge", "planar_slip"),
)


def said(value: object) -> str:
    """How the page writes a field's value."""
    if not value:
        return "-"
    if isinstance(value, Distribution):
        if value.choices is not None:
            return ", ".join(f"{choice:g}" for choice in value.choices)
        return f"{value.ends[0]:g} to {value.ends[1]:g}" + (", log" if value.log_uniform else "")
    assert isinstance(value, tuple)
    return ", ".join(value)


def rows(title: str) -> list[list[str]]:
    section = re.search(rf"^## {title}\n(.*?)(?=^## |\Z)", PAGE, re.DOTALL | re.MULTILINE)[1]
    lines = [line for line in section.splitlines() if line.startswith("|")][2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def test_the_table_of_fields_is_the_presets():
    presets = [load_randomization(name) for name in ("train", "lab", "eval_ood")]
    expected = [
        [f"`{name}`", field.description, *(said(getattr(preset, name)) for preset in presets)]
        for name, field in Ranges.model_fields.items()
        if name != "disturbances"
    ]
    assert rows("Fields") == expected


@pytest.mark.parametrize("preset", ["train", "eval_ood"])
def test_the_table_of_disturbances_is_the_presets(preset):
    expected = []
    for disturbance in load_randomization(preset).disturbances:
        values = [(name, value) for name, value in disturbance if isinstance(value, Distribution)]
        told = "; ".join(f"{name} {said(value)}" for name, value in values)
        expected.append([preset, f"`{disturbance.kind}`", f"{disturbance.probability:g}", told])
    assert [row for row in rows("Disturbances") if row[0] == preset] == expected


@pytest.mark.parametrize("preset", ["train", "eval_ood"])
def test_the_table_of_tasks_is_the_presets(preset):
    tasks = load_randomization(preset).tasks
    expected = []
    for name in TASKS:
        own = tasks[name]
        fields = [field for field in Ranges.model_fields if field in own.model_fields_set]
        told = "; ".join(
            f"{field} {said(getattr(own, field))}" for field in fields if field != "disturbances"
        )
        expected.append([preset, f"`{name}`", told])
    assert [row for row in rows("Single tasks") if row[0] == preset] == expected


@pytest.mark.parametrize("example", re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL))
def test_the_examples_run(example, capsys):
    with np.printoptions():
        exec(compile(example, "randomization.md", "exec"), {})
    assert capsys.readouterr().out
