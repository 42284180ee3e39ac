"""The notebooks of examples/ run, and show what they print."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
NOTEBOOKS = sorted(EXAMPLES.glob("*.ipynb"))


def cells(path, kind):
    return [cell for cell in json.loads(path.read_text())["cells"] if cell["cell_type"] == kind]


def test_there_are_three_and_each_installs_slipgym_where_it_is_missing():
    assert len(NOTEBOOKS) == 3
    (first,) = {"".join(cells(path, "code")[0]["source"]) for path in NOTEBOOKS}
    assert re.search(r"^if find_spec\(.slipgym.\) is None:.*\n.*slipgym\[eval\]", first, re.MULTILINE)


@pytest.mark.quick_cases("1_first_rollout")
@pytest.mark.parametrize("path", NOTEBOOKS, ids=[path.stem for path in NOTEBOOKS])
def test_it_runs_and_prints_what_it_shows(path):
    code = "\n\n".join("".join(cell["source"]) for cell in cells(path, "code"))
    outputs = [output for cell in cells(path, "code") for output in cell["outputs"]]
    shown = "".join("".join(output["text"]) for output in outputs if output["output_type"] == "stream")
    pytest.importorskip("matplotlib")
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=EXAMPLES,
        env={**os.environ, "MPLBACKEND": "Agg"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == shown.split()
    assert any("image/png" in output.get("data", {}) for output in outputs)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=[path.stem for path in NOTEBOOKS])
def test_its_links_lead_somewhere(path):
    words = "".join("".join(cell["source"]) for cell in cells(path, "markdown"))
    for link in re.findall(r"\]\(([^)#]+)\)", words):
        assert (EXAMPLES / link).is_file(), link
