"""The examples of docs/randomization.md run."""

import re
from pathlib import Path

import numpy as np
import pytest

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "randomization.md").read_text()


@pytest.mark.parametrize("example", re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL))
def test_the_examples_run(example, capsys):
    with np.printoptions():
        exec(compile(example, "randomization.md", "exec"), {})
    assert capsys.readouterr().out
