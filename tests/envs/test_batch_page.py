"""The examples of docs/batch.md print what the page says."""

import contextlib
import inspect
import io
import re
from pathlib import Path

import pytest

from slipgym.envs.vector_env import SlipVectorEnv

PAGE = (Path(__file__).parents[2] / "docs" / "batch.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"```python\n(.*?)```\n\n```text\n(.*?)```", PAGE, re.DOTALL)


@pytest.mark.parametrize(("code", "printed"), EXAMPLES, ids=["batch", "rows"])
def test_the_examples_print_what_the_page_says(code, printed):
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        exec(compile(code, "docs/batch.md", "exec"), {})
    assert out.getvalue() == printed


def test_the_page_has_its_examples():
    assert len(EXAMPLES) == PAGE.count("```python") == 2
    for name in ("threads", "autoreset_mode", "render_rows", "num_envs"):
        assert f"| `{name}` |" in PAGE
        assert name in inspect.signature(SlipVectorEnv).parameters
