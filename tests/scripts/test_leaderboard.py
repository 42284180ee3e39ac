"""The command lines of the leaderboard and of the velocity profile."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("command", "words", "picture"),
    [
        (["scripts/leaderboard.py", "--quick"], "| 1 |", "leaderboard.png"),
        (["scripts/reproduce.py", "profile", "--seeds", "1"], "| rotational |", "realistic.png"),
    ],
)
def test_the_command_prints_its_tables_and_where_to_look(command, words, picture, tmp_path):
    done = subprocess.run(
        [sys.executable, *command, "--output", tmp_path, "--seed", "1"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    assert words in done.stdout
    assert Path(done.stdout.split()[-1]).name == picture
    assert Path(done.stdout.split()[-1]).is_file()
