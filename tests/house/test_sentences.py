"""Pages, modules and public names say what they do: no first line that is a noun clause, no long paragraph.

`python tests/house/test_sentences.py` prints what is wrong.
"""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
LONGEST = 600
"""Characters of a paragraph, list item or table row of a page."""
CLAUSE = re.compile(r"(?:What|How|Whether|Who|Why|Where|When|Which)\b")
"""First word of a noun clause in place of a sentence."""
PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")])
PACKAGES = ("slipgym", "estimator", "policies")
MODULES = sorted(
    path for package in (*PACKAGES, "scripts", "lab") for path in ROOT.glob(f"{package}/**/*.py")
)


def name(place: Path) -> str:
    return place.relative_to(ROOT).as_posix()


def blocks(page: str) -> list[str]:
    """Paragraphs, list items and table rows of a page without its code, each on one line."""
    text = re.sub(r"^```.*?^```$|^    [^\n]*$|<!--.*?-->", "", page, flags=re.DOTALL | re.MULTILINE)
    parts = re.split(r"\n\s*\n|\n(?=\||- |\d+\. |#)", text)
    return [" ".join(part.split()) for part in parts if part.strip()]


def first_line(page: str) -> str:
    """The first sentence of a page below its title and pictures."""
    return next((block for block in blocks(page) if not block.startswith(("#", "!", "|"))), "")


def faults_of_page(page: str) -> list[str]:
    found = [f"{len(block)} characters: {block[:60]}" for block in blocks(page) if len(block) > LONGEST]
    opening = first_line(page)
    return found + ([f"first line: {opening[:60]}"] if CLAUSE.match(opening) else [])


def faults_of_module(source: str) -> list[str]:
    line = (ast.get_docstring(ast.parse(source)) or "").partition("\n")[0]
    return [f"first line: {line}"] if CLAUSE.match(line) else []


def public(source: str) -> Iterator[tuple[str, str]]:
    """Name and first line of the docstring of each class and function without a leading underscore."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.ClassDef | ast.FunctionDef) and not node.name.startswith("_"):
            yield node.name, (ast.get_docstring(node) or "").partition("\n")[0]


def faults(place: Path) -> list[str]:
    text = place.read_text(encoding="utf-8")
    return faults_of_page(text) if place.suffix == ".md" else faults_of_module(text)


@pytest.mark.parametrize("page", PAGES, ids=name)
def test_a_page_has_short_paragraphs_and_begins_with_a_sentence(page):
    assert faults(page) == []


def test_a_module_begins_with_a_sentence():
    assert {name(module): faults(module) for module in MODULES if faults(module)} == {}


def test_a_public_class_or_function_begins_with_a_sentence():
    clauses = [
        f"{name(module)}: {called}: {line}"
        for module in MODULES
        if module.relative_to(ROOT).parts[0] in PACKAGES
        for called, line in public(module.read_text(encoding="utf-8"))
        if CLAUSE.match(line) and not line.startswith("Whether ")
    ]
    assert clauses == []


def test_faults_are_found():
    long = "word " * 130
    page = f"# Title\n\nHow it works.\n\n| a | {long} |\n\n```text\n{long}\n```\n\n- {long}\n"
    assert [fault.split(":")[0].split()[-1] for fault in faults_of_page(page)] == [
        "characters",
        "characters",
        "line",
    ]
    assert faults_of_page("# Title\n\nThis page is short.\n") == []
    assert faults_of_module('"""What is done."""') == ["first line: What is done."]
    assert faults_of_module('"""Does it."""') == []
    assert list(public('def f():\n    """How it is."""\n\n\ndef _g():\n    pass\n')) == [("f", "How it is.")]
    after_a_command = "# Title\n\nRun\n\n    slipgym demo\n\n" + long
    assert faults_of_page(after_a_command) == [f"{len(long.strip())} characters: {long[:60]}"]


if __name__ == "__main__":
    for place in (*PAGES, *MODULES):
        for fault in faults(place):
            print(f"{name(place)}: {fault}")
