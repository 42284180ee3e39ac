"""The pages hang together: links lead somewhere, and every page can be reached from README.md."""

import ast
import re
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted([*(ROOT / "docs").rglob("*.md"), *ROOT.glob("*.md")])
PAGE_IDS = [str(page.relative_to(ROOT)) for page in PAGES]
LINK = re.compile(r"\[(?:[^][]|\[[^]]*\])*\]\(([^)\s]+)\)")
OUTSIDE = ("http://", "https://", "mailto:")


def prose(page: Path) -> str:
    """A page without its code."""
    text = re.sub(r"^```.*?^```$", "", page.read_text(), flags=re.DOTALL | re.MULTILINE)
    text = re.sub(r"^(?:    .*\n)+", "", text, flags=re.MULTILINE)
    return re.sub(r"`[^`\n]*`", "", text)


def links(page: Path) -> list[str]:
    return [target for target in LINK.findall(prose(page)) if not target.startswith(OUTSIDE)]


@cache
def anchors(page: Path) -> set[str]:
    """The anchors that GitHub gives the headings of a page."""
    text = re.sub(r"^```.*?^```$", "", page.read_text(), flags=re.DOTALL | re.MULTILINE)
    headings = re.findall(r"^#+ (.+)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-") for heading in headings}


def target(page: Path, link: str) -> Path:
    return (page.parent / link.partition("#")[0]).resolve() if not link.startswith("#") else page


@pytest.mark.parametrize("page", PAGES, ids=PAGE_IDS)
def test_links_lead_somewhere(page):
    assert [link for link in links(page) if not target(page, link).exists()] == []


@pytest.mark.parametrize("page", PAGES, ids=PAGE_IDS)
def test_anchors_are_headings(page):
    found = [(target(page, link), link) for link in links(page) if "#" in link]
    assert [link for to, link in found if link.partition("#")[2] not in anchors(to)] == []


@pytest.mark.parametrize("page", PAGES, ids=PAGE_IDS)
def test_python_on_a_page_is_python(page):
    for block in re.findall(r"^```python.*?\n(.*?)^```$", page.read_text(), re.DOTALL | re.MULTILINE):
        ast.parse(block)


def test_every_page_can_be_reached_from_the_readme():
    reached, waiting = set(), [ROOT / "README.md"]
    while waiting:
        page = waiting.pop()
        if page.suffix == ".md" and page not in reached:
            reached.add(page)
            waiting += [to for to in (target(page, link) for link in links(page)) if to.is_file()]
    readable = [page for page in PAGES if page.parent != ROOT / "docs/api"]  # which are of the site alone
    assert [str(page.relative_to(ROOT)) for page in readable if page not in reached] == []


def test_every_picture_is_shown():
    shown = "".join(page.read_text(encoding="utf-8") for page in PAGES)
    pictures = [
        path for folder in ("images", "learned") for path in (ROOT / "docs" / folder).glob("*.[pg][ni][gf]")
    ]
    assert len(pictures) > 20
    assert [path.name for path in pictures if f"{path.parent.name}/{path.name})" not in shown] == []


def test_a_broken_link_is_found(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("# A page, and more\n\n[here](#a-page-and-more) [`there`](gone.md) `[code](no.md)`\n")
    assert [link for link in links(page) if not target(page, link).exists()] == ["gone.md"]
    assert anchors(page) == {"a-page-and-more"}
