"""Each file of docs/results has a declaration and a head, and no page has figures of its own."""

import importlib
import importlib.util
import re
from pathlib import Path

import pytest
import typer

from lab.results import files
from lab.results.declarations import RESULTS

DOCS = files.ROOT / "docs"
PAGES = [page for page in sorted(DOCS.rglob("*.md")) if page != files.INDEX]
LINK = re.compile(r"\]\(((?:\.\./)*results/\w+\.txt)\)")
TABLE = re.compile(r"(?:^\|.*\n)+", re.MULTILINE)
BLOCK = re.compile(r"(```python\n(?:.*\n)*?```\s+)?```(?:text)?\n((?:.*\n)*?)```")
NUMBER = r"[+−-]?\d+(?:\.\d+)?"
MEASURED = re.compile(rf"{NUMBER}(?:\s*%)?(?:\s*[\[(]{NUMBER}(?:,| to ) ?{NUMBER}[\])])?")
"""A figure, also with its interval."""
FEWEST = 8
"""Figures that make a table of results; a table of a few constants has fewer."""
TESTED = {"records.md", "rewards.md"}
"""Pages with a report or a table of constants that a test of the page holds to the code."""


def figures(page: str) -> list[str]:
    """First lines of the tables and text blocks of a page that hold measured figures.

    A table does if at least half of its cells, without the first column, and `FEWEST` of them are figures; a
    table with a name of the code in each row is a reference. A fenced block does if it has as many numbers
    with a point, unless it follows the Python example that prints it.
    """
    found = []
    for table in TABLE.findall(re.sub(r"```.*?```", "", page, flags=re.DOTALL)):
        head, _, *rows = table.splitlines()
        cells = [cell.strip(" *") for row in rows for cell in row.strip("|").split("|")[1:]]
        measured = [cell for cell in cells if MEASURED.fullmatch(cell)]
        if len(measured) >= max(FEWEST, 0.5 * len(cells)) and not all("`" in row for row in rows):
            found.append(head)
    for example, text in BLOCK.findall(page):
        if not example and len(re.findall(r"\d\.\d", text)) >= FEWEST:
            found.append(text.partition("\n")[0])
    return found


def name(page: Path) -> str:
    return page.relative_to(DOCS).as_posix()


def test_every_file_has_a_declaration_and_every_declaration_a_file():
    stored = {path.name for path in files.FOLDER.iterdir()} - {files.INDEX.name}
    assert stored == {files.path(result).name for result in RESULTS}


@pytest.mark.parametrize("result", RESULTS, ids=lambda result: result.name)
def test_a_file_begins_with_its_head(result):
    text = files.path(result).read_text(encoding="utf-8")
    if text == files.awaited(result):
        return
    found = re.search(
        r"^printed: (\d{4}-\d\d-\d\d), commit ([0-9a-f]{7,40}(?: \+ changes)?)$", text, re.MULTILINE
    )
    assert found, "the head has no date and commit"
    libraries = re.search(r"^with: +(.+)$", text, re.MULTILINE)[1]
    assert text.startswith(files.head(result, found[2], found[1], libraries))
    assert text == files.aligned(text)


def test_the_index_is_that_of_the_declarations():
    assert files.INDEX.read_text(encoding="utf-8") == files.index()


@pytest.mark.parametrize("page", PAGES, ids=name)
def test_a_page_shows_results_that_exist(page):
    shown = LINK.findall(page.read_text(encoding="utf-8"))
    assert [link for link in shown if not (page.parent / link).is_file()] == []


@pytest.mark.parametrize("result", RESULTS, ids=lambda result: result.name)
def test_the_page_of_a_result_shows_it(result):
    text = (DOCS / result.page).read_text(encoding="utf-8")
    shown = re.search(rf"^\[[^]]+\]\((?:\.\./)*results/{result.name}\.txt\)$", text, re.MULTILINE)
    assert shown


@pytest.mark.parametrize("page", [page for page in PAGES if name(page) not in TESTED], ids=name)
def test_a_page_has_no_figures_of_its_own(page):
    assert figures(page.read_text(encoding="utf-8")) == []


def test_figures_are_found():
    row = "| LinearSlip | 100.0 | 3 (1 to 5) | 0.31 [0.30, 0.32] | −4 % |\n"
    table = "| task | a | b | c | d |\n| --- | --- | --- | --- | --- |\n" + 2 * row
    text = "```text\n" + 4 * "step 0.12  0.13\n" + "```\n"
    example = "```python\nprint(1)\n```\n\n"
    assert figures(f"# Page\n\n{table}\n{text}") == ["| task | a | b | c | d |", "step 0.12  0.13"]
    assert figures(example + text) == []
    assert (
        figures(
            "| name | default | meaning |\n|---|---|---|\n" + 20 * "| `r0` | 0.01 | Start value of r. |\n"
        )
        == []
    )


@pytest.mark.parametrize("result", RESULTS, ids=lambda result: result.name)
def test_a_command_is_understood(result):
    pytest.importorskip("lab.commands")
    for command, *words in result.arguments:
        places = [f"{place}.commands.{command.replace('-', '_')}" for place in ("policies", "lab")]
        (module,) = [place for place in places if importlib.util.find_spec(place)]
        app = typer.main.get_command(importlib.import_module(module).app)
        with app.make_context(command, list(words)) as context:
            if isinstance(app, typer.main.TyperGroup):
                inner = app.get_command(context, words[0])
                assert inner is not None, words[0]
                inner.make_context(words[0], words[1:])
