"""docs/modes.md says what the code says, and its examples print what it prints."""

import re
from pathlib import Path

import pytest

from slipgym.config import load
from slipgym.envs.actions import ACTION_MODES, components
from slipgym.envs.arguments import OBSERVATION_MODES
from slipgym.envs.observation import DEVIATION_COLUMNS, WRIST
from slipgym.envs.observer import privileged_columns

PAGE = (Path(__file__).parents[2] / "docs" / "modes.md").read_text(encoding="utf-8")
CONFIG = load()


def row(column) -> str:
    return f"| `{column.name}` | {column.low:g} | {column.high:g} | {column.unit} | {column.meaning} |"


@pytest.mark.parametrize("mode", ACTION_MODES)
def test_every_action_mode_and_component_is_listed(mode):
    named = ", ".join(f"`{name}`" for name in ACTION_MODES[mode])
    assert f'| `"{mode}"` | {len(ACTION_MODES[mode])} | {named} |' in PAGE
    for column in components(mode, CONFIG):
        assert row(column) in PAGE


def test_every_observation_mode_and_column_is_listed():
    for mode in OBSERVATION_MODES:
        assert f'| `"{mode}"` |' in PAGE
    for column in (reading.column(CONFIG) for reading in WRIST):
        assert row(column) in PAGE
    for column in DEVIATION_COLUMNS:
        assert row(column) in PAGE
    table = "\n".join(f"{row(column)}" for column in privileged_columns(CONFIG))
    assert f"| Column | Min | Max | Unit | Meaning |\n|---|---|---|---|---|\n{table}\n\n" in PAGE


EXAMPLES = re.findall(r"```python\n(.*?)```\n\n```text\n(.*?)```", PAGE, re.DOTALL)


@pytest.mark.parametrize(("code", "printed"), EXAMPLES)
def test_the_examples_print_what_the_page_says(capsys, code, printed):
    exec(compile(code, "docs/modes.md", "exec"), {})
    assert capsys.readouterr().out == printed


def test_the_page_has_its_examples():
    assert len(EXAMPLES) == PAGE.count("```python") == 2
