"""The pages about adding things: their files are imported, their examples print what the pages say."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
MODULES = {"adding_a_task": "slide_to_line", "adding_an_estimator": "ratios", "adding_a_policy": "grips"}


def blocks(page: str, language: str) -> list[str]:
    text = (ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8")
    return re.findall(rf"```{language}\n(.*?)```", text, re.DOTALL)


@pytest.mark.quick_cases("adding_a_task")
@pytest.mark.parametrize("page", MODULES)
def test_the_examples_print_what_the_page_says(page, tmp_path):
    """In a process of their own, warnings as errors."""
    file, use = blocks(page, "python")
    (printed,) = blocks(page, "text")
    (tmp_path / f"{MODULES[page]}.py").write_text(file, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", use],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), str(ROOT)])},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == printed
