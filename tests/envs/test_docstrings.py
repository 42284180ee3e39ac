"""The docstrings say what the code says, and the pages say what the docstrings say."""

import importlib
import inspect
import math
import re
import sys
from pathlib import Path

import numpy as np
import pytest

from slipgym.registration import ENVIRONMENTS

DOCS = Path(__file__).resolve().parents[2] / "docs"
SECTIONS = [
    "Description",
    "Action Space",
    "Observation Space",
    "Rewards",
    "Starting State",
    "Episode End",
    "Arguments",
    "Reset Options",
    "Info",
    "Version History",
]


@pytest.fixture(params=ENVIRONMENTS)
def env(request, make):
    return make(request.param, action_mode=None)


def section(env, title: str) -> str:
    text = inspect.getdoc(type(env))
    assert text is not None
    return text.partition(f"\n## {title}\n")[2].partition("\n## ")[0]


def rows(text: str) -> list[list[str]]:
    """Cells of the table in a section, without its head."""
    lines = [line for line in text.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split(" | ")] for line in lines[2:]]


def first_names(text: str) -> list[str]:
    return [row[0].strip("`") for row in rows(text)]


def test_the_sections_are_gymnasiums(env):
    assert re.findall(r"^## (.+)$", inspect.getdoc(type(env)) or "", re.MULTILINE) == SECTIONS


def test_the_observation_table_is_the_observation_space(env):
    expected = [
        [str(i), f"`{c.name}`: {c.meaning}", f"{c.low:.4g}", f"{c.high:.4g}", c.unit]
        for i, c in enumerate(env.columns)
    ]
    assert rows(section(env, "Observation Space")) == expected
    assert f"({len(expected)},), float32" in section(env, "Observation Space")
    np.testing.assert_array_equal(env.observation_space.low, np.float32([c.low for c in env.columns]))
    np.testing.assert_array_equal(env.observation_space.high, np.float32([c.high for c in env.columns]))


def test_the_reward_table_is_the_configuration(env):
    events = {"solved", "violated", "drop", "following"}
    expected = [
        [f"`{name}`", "event" if name in events else "dense", f"{env.settings.reward[name]:g}"]
        for name in env.task.term_names
    ]
    assert [row[:3] for row in rows(section(env, "Rewards"))] == expected


def test_every_argument_is_listed_with_its_default(env):
    listed = {
        row[0].strip("`"): row[1].strip("`").replace('"', "'") for row in rows(section(env, "Arguments"))
    }
    parameters = [p for p in inspect.signature(type(env)).parameters.values() if p.kind is not p.VAR_KEYWORD]
    assert listed == {parameter.name: repr(parameter.default) for parameter in parameters}


def test_every_reset_option_is_listed_as_it_describes_itself(env):
    fields = env.task.options.model_fields
    listed = {row[0].strip("`"): row[1] for row in rows(section(env, "Reset Options"))}
    assert listed == {name: field.description for name, field in fields.items()}


def test_every_key_of_info_is_listed(env):
    _, info = env.reset(seed=0)
    assert set(first_names(section(env, "Info"))) == set(info)


def test_the_numbers_in_the_text_are_the_defaults(env):
    gripper, task = env.config.gripper, env.settings
    action, end = (" ".join(section(env, title).split()) for title in ("Action Space", "Episode End"))
    assert f"-1 is `gripper.force_min` ({gripper.force_min:g} N)" in action
    assert f"+1 is `gripper.force_max` ({gripper.force_max:g} N)" in action
    assert f"({1e3 * gripper.dead_time:g} ms)" in action
    assert f"({1e3 * gripper.lag:g} ms)" in action
    assert f"({task.initial_force:g} N)" in section(env, "Starting State")
    for name, field in type(task).model_fields.items():
        if name.endswith("tolerance"):
            value, length = getattr(task, name), (field.description or "").endswith("[m]")
            words = f"({1e3 * value:g} mm)" if length else f"({math.degrees(value):.3g} deg)"
            assert f"`{name}` {words}" in end
    env.reset(seed=0)
    assert f"{env.simulation.episode['steps'][0]} control steps)" in end


@pytest.fixture(scope="module")
def pages():
    """File name -> text of the pages of the environments, as scripts/make_docs.py writes them."""
    sys.path.insert(0, str(DOCS / "site"))
    try:
        return importlib.import_module("environments").pages()
    finally:
        sys.path.remove(str(DOCS / "site"))


def test_the_pages_are_up_to_date(pages):
    written = {path.name: path.read_text(encoding="utf-8") for path in (DOCS / "environments").glob("*.md")}
    assert written == pages, "run scripts/make_docs.py"


def test_a_page_and_the_common_one_have_what_the_docstring_has(env, pages):
    """Every observation column, reward term, reset option and key of info."""
    text = pages[f"{env.task.key}.md"] + pages["common.md"]
    names = [column.name for column in env.columns] + list(env.task.term_names)
    names += [*env.task.options.model_fields, *first_names(section(env, "Info"))]
    assert [name for name in names if f"`{name}`" not in text] == []
    assert f"({len(env.columns)},), float32" in pages[f"{env.task.key}.md"]
    assert "## Episode End" in pages[f"{env.task.key}.md"]


@pytest.mark.parametrize("entry_point", ENVIRONMENTS.values())
def test_a_docstring_holds_no_results(entry_point):
    """What somebody's policy solves belongs to the pages of results."""
    module, _, cls = entry_point.partition(":")
    text = inspect.getdoc(getattr(importlib.import_module(module), cls)) or ""
    assert not re.search(r"solved \[%\]|leaderboard|\b\d+ % (?:success|of \d+ episodes)", text)


@pytest.mark.parametrize("entry_point", ENVIRONMENTS.values())
def test_every_environment_has_its_own_docstring(entry_point):
    module, _, cls = entry_point.partition(":")
    assert "__doc__" in vars(getattr(importlib.import_module(module), cls))
