"""The examples of the three tutorials print what the pages say."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = ("first_policy", "first_controller", "first_estimate")


@pytest.mark.parametrize("page", PAGES)
def test_the_example_prints_what_the_page_says(page, monkeypatch, capsys):
    text = (ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8")
    ((code, printed),) = re.findall(r"```python\n(.*?)```\n\n```text\n(.*?)```", text, re.DOTALL)
    monkeypatch.chdir(ROOT)
    exec(compile(code, page, "exec"), {})
    assert capsys.readouterr().out == printed
