"""The examples and commands of the three tutorials print what the pages say."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
EPISODES = 4
"""Episodes of a hundred by which another processor may differ."""


def page(name: str) -> str:
    return (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8")


def blocks(text: str, language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", text, re.DOTALL)


@pytest.mark.parametrize("name", ["first_policy", "first_estimate"])
def test_the_example_prints_what_the_page_says(name, monkeypatch, capsys):
    ((code, printed),) = re.findall(r"```python\n(.*?)```\n\n```text\n(.*?)```", page(name), re.DOTALL)
    monkeypatch.chdir(ROOT)
    exec(compile(code, name, "exec"), {})
    assert capsys.readouterr().out == printed


@pytest.fixture
def controller(tmp_path) -> Path:
    """A folder with the files of docs/first_controller.md."""
    text = page("first_controller")
    (tmp_path / "my_pi.py").write_text(blocks(text, "python")[0], encoding="utf-8")
    (tmp_path / "my_pi.yaml").write_text(blocks(text, "yaml")[0], encoding="utf-8")
    return tmp_path


def run(folder: Path, *words: str) -> str:
    """The output of a Python process in a folder."""
    done = subprocess.run(
        [sys.executable, *words],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": f"{folder}{os.pathsep}{ROOT}"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_first_controller_slides_as_the_page_says(controller):
    _, use = blocks(page("first_controller"), "python")
    assert run(controller, "-c", use) == blocks(page("first_controller"), "text")[0]


@pytest.mark.slow
def test_friction_is_worth_to_the_first_controller_what_the_page_says(controller):
    commands = re.findall(r"^    slipgym (evaluate --policy .+)$", page("first_controller"), re.MULTILINE)
    printed = blocks(page("first_controller"), "text")[1].splitlines()
    for command, line in zip(commands, printed, strict=True):
        solved = [
            int(re.search(r"solved (\d+)", each)[1])
            for each in (line, run(controller, "-m", "slipgym", *command.split()))
        ]
        assert solved[1] == pytest.approx(solved[0], abs=EPISODES), command


@pytest.mark.slow
def test_the_experiment_of_the_first_controller_runs(controller):
    run(controller, "-m", "slipgym", "evaluate", "my_pi.yaml", "--trials", "1")
    assert list(controller.glob("runs/my_pi__*/tracking_stiff_PI.png"))
