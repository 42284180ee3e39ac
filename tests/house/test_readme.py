"""The README's examples run as they are printed."""

import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)


def test_there_are_examples():
    assert len(EXAMPLES) >= 3


@pytest.mark.parametrize(
    "example", EXAMPLES, ids=[re.findall(r"import (\w+)", text)[-1] for text in EXAMPLES]
)
def test_example_runs(example):
    done = subprocess.run(
        [sys.executable, "-c", example], cwd=ROOT, capture_output=True, text=True, check=False
    )
    if find_spec("pybullet") is None and "needs PyBullet" in done.stderr:
        pytest.skip("needs PyBullet")
    assert done.returncode == 0, done.stderr
