"""Lists of names on pages are those of the registries: a list of most of them has all, and counts are right.

`python tests/house/test_lists.py` prints what is wrong.
"""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

import estimator
import policies
from slipgym.config.load import names
from slipgym.contact.pressure import PRESSURES
from slipgym.envs.actions import ACTION_MODES
from slipgym.envs.arguments import FRICTION_SOURCES, OBSERVATION_MODES
from slipgym.registration import ENVIRONMENTS
from slipgym.tasks import find

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted([ROOT / "README.md", *ROOT.glob("docs/**/*.md")])
TASKS = {find(name).name for name in ENVIRONMENTS}
LEARNED = {name for name in policies.names() if name.endswith(("_scratch", "_memory"))}


def stems(folder: str) -> set[str]:
    """Names of the YAML files of a folder of configs/."""
    return {path.stem for path in (ROOT / "configs" / folder).glob("*.yaml")}


LISTS = {
    "tasks": TASKS,
    "estimators": set(estimator.names()),
    "policies learned from nothing": {name for name in LEARNED if name.endswith("_scratch")},
    "policies with a memory": {name for name in LEARNED if name.endswith("_memory")},
    "randomizations": set(names("randomization")),
    "sensors": set(names("sensors")),
    "materials": set(names("materials")),
    "studies": stems("studies"),
    "action modes": set(ACTION_MODES),
    "observation modes": set(OBSERVATION_MODES),
    "friction sources": set(FRICTION_SOURCES),
    "pressures": set(PRESSURES),
}
"""What is listed -> its names."""
CHOSEN = {"friction sources"}
"""Lists of which sentences name a part."""
COMPLETE = {
    ("README.md", "tasks"),
    ("docs/estimator.md", "estimators"),
    ("docs/learned.md", "policies learned from nothing"),
    ("docs/learned.md", "policies with a memory"),
    ("docs/randomization.md", "randomizations"),
    ("docs/sensors.md", "sensors"),
    ("docs/study.md", "studies"),
    ("docs/study.md", "friction sources"),
    ("docs/modes.md", "action modes"),
    ("docs/modes.md", "observation modes"),
    ("docs/rewards.md", "tasks"),
    ("docs/contact.md", "pressures"),
}
"""(page, list) that the page is the place for."""


COUNTS = {
    ("docs/comparison.md", r"tasks \| (\d+), all"): len(TASKS),
    ("docs/comparison.md", r"(\d+) estimators, scalar"): len(estimator.names()),
}
"""(page, pattern of a number) -> the number."""
JOIN = re.compile(r"\s*(?:,|;|\band\b|\bor\b|,\s*and\b|,\s*or\b)\s*")
NAME = r"[\"`]?\w+[\"`]?"
ENUMERATION = re.compile(rf"{NAME}(?:(?:{JOIN.pattern}){NAME})+")


def without_code(page: str) -> str:
    """A page without its blocks of code, and links as their text."""
    text = re.sub(r"^```.*?^```$|^    [^\n]*$", "", page, flags=re.DOTALL | re.MULTILINE)
    return re.sub(r"\[([^][]+)\]\([^)]+\)", r"\1", text)


def lists(page: str) -> Iterator[set[str]]:
    """Words of each enumeration in a sentence, and of the first column of each table."""
    text = without_code(page)
    for sentence in ENUMERATION.findall(text):
        yield {word.strip('"`') for word in JOIN.split(sentence)}
    for _, rows in re.findall(r"^(\|.*\n\|[ :|-]+\n)((?:\|.*\n)+)", text, re.MULTILINE):
        yield {
            word
            for first in re.findall(r"^\| *([^|]*)", rows, re.MULTILINE)
            for word in re.findall(r"\w+", first)
        }


def incomplete(page: str) -> list[str]:
    """Lists of a page that have nothing but most of the names of a registry, and what each lacks."""
    return [
        f"{what}: {', '.join(sorted(known - words))}"
        for words in lists(page)
        for what, known in LISTS.items()
        if what not in CHOSEN and words < known and len(words) > len(known) / 2
    ]


def name(page: Path) -> str:
    return page.relative_to(ROOT).as_posix()


@pytest.mark.parametrize("page", PAGES, ids=name)
def test_a_list_of_most_names_has_all(page):
    assert incomplete(page.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize(("page", "what"), sorted(COMPLETE))
def test_the_page_of_a_list_has_all_its_names(page, what):
    assert any(LISTS[what] <= words for words in lists((ROOT / page).read_text(encoding="utf-8")))


def test_the_default_action_modes_are_those_of_the_tasks():
    page = (ROOT / "docs/modes.md").read_text(encoding="utf-8")
    (listed,) = re.findall(
        r"the task's default applies: (.*?), *\n? *the others \"grip_force\"", page, re.DOTALL
    )
    own = {
        task.name: task.action_mode for task in map(find, ENVIRONMENTS) if task.action_mode != "grip_force"
    }
    assert dict(re.findall(r'(\w+) "(\w+)"', listed)) == own


def test_counts_are_those_of_the_registries():
    for (page, pattern), count in COUNTS.items():
        assert re.findall(pattern, (ROOT / page).read_text(encoding="utf-8")) == [str(count)], page


def test_a_missing_name_is_found():
    page = "`rls`, [`joint`](a.md), `disc` and `ukf` fit.\n\n| name |\n| --- |\n| `rls`, `ukf` |\n| joint |\n"
    assert incomplete(page) == ["estimators: adaptive", "estimators: adaptive, disc"]
    assert incomplete("# All but `rls` and `ukf`.") == []


if __name__ == "__main__":
    for page in PAGES:
        for fault in incomplete(page.read_text(encoding="utf-8")):
            print(f"{name(page)}: {fault}")
