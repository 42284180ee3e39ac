"""Pages and docstrings use the field's words (docs/glossary.md), not those that were given up for them.

`NOT_YET` holds pages and folders (with those inside them) that still have such words. It should only become
shorter: `python tests/house/test_words.py` prints where they are.
"""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
RETIRED = {
    "told": "given, known, info",
    "tells": "says, reports, info",
    "happenings": "disturbances",
    "equipment": "hardware randomization",
    "sight": "observation buffers",
    "starter": "episode sampler",
    "rooms": "files, folders, buffers",
    "judge": "evaluate_step, evaluates",
    "judged": "evaluated",
    "unaware": "without friction information",
    "shelf": "pretrained policies",
    "portrait": "screenshot",
    "film": "video",
    "films": "videos",
    "keeper": "training callback",
    "batched core": "vector environment, planar engine",
    "literal text": "as published",
    "manners": "interface",
}
PATTERN = re.compile(r"\b(" + "|".join(RETIRED).replace(" ", r"\s+") + r")\b", re.IGNORECASE)
PAGES = [
    page for page in sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")]) if "CHANGELOG" not in page.name
]
FOLDERS = sorted(
    {
        path.parent
        for package in ("slipgym", "estimator", "policies", "lab", "scripts")
        for path in ROOT.glob(f"{package}/**/*.py")
    }
)
NOT_YET: set[str] = set()


def prose(page: Path) -> str:
    """A page without its code."""
    text = re.sub(r"^```.*?^```$", "", page.read_text(), flags=re.DOTALL | re.MULTILINE)
    return re.sub(r"`[^`]*`|\]\([^)]*\)", "", text)


def docstrings(source: str) -> Iterator[str]:
    """The docstrings of a module, its classes, functions and attributes, without code in backquotes."""
    for node in ast.walk(ast.parse(source)):
        if (
            isinstance(node, ast.Expr)
            and isinstance(node.value, ast.Constant)
            and isinstance(node.value.value, str)
        ):
            yield re.sub(r"`[^`]*`", "", node.value.value)


def retired(texts: list[str]) -> list[str]:
    return sorted({" ".join(found.lower().split()) for text in texts for found in PATTERN.findall(text)})


def retired_in(place: Path) -> list[str]:
    if place.is_file():
        return retired([prose(place)])
    return retired([text for path in sorted(place.glob("*.py")) for text in docstrings(path.read_text())])


def name(place: Path) -> str:
    return place.relative_to(ROOT).as_posix()


def clean(place: Path) -> bool:
    """Whether a page or folder has to use the field's words already."""
    return not any(f"{name(place)}/".startswith(f"{left}/") for left in NOT_YET)


@pytest.mark.parametrize("place", [place for place in (*PAGES, *FOLDERS) if clean(place)], ids=name)
def test_a_page_or_folder_uses_the_fields_words(place):
    found = retired_in(place)
    assert found == [], "; ".join(f"{word!r}: {RETIRED[word]}" for word in found)


def test_the_list_of_what_is_left_names_places_that_exist():
    assert [place for place in NOT_YET if not (ROOT / place).exists()] == []


def test_a_retired_word_is_found():
    source = (
        '"""What is told."""\nX = 1\n"""A `told` name; retold."""\ndef f():\n    """A\n    batched  core."""'
    )
    assert retired(list(docstrings(source))) == ["batched core", "told"]


if __name__ == "__main__":
    for place in (*PAGES, *FOLDERS):
        if words := retired_in(place):
            print(f'    "{name(place)}",  # {", ".join(words)}')
