"""The command lines of the leaderboard and of the velocity profile."""

import subprocess
import sys
from pathlib import Path

import pytest

from lab.commands.imperfections import one_imperfection
from policies.leaderboard.imperfections import IMPERFECTIONS
from slipgym.config import load

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("command", "words", "picture"),
    [
        (["leaderboard", "--quick"], "| 1 |", "leaderboard.png"),
        (["reproduce", "profile", "--seeds", "1"], "| rotational |", "realistic.png"),
    ],
)
def test_the_command_prints_its_tables_and_where_to_look(command, words, picture, tmp_path):
    printed = call(*command, "--output", tmp_path, "--seed", "1")
    assert words in printed
    assert Path(printed.split()[-1]).name == picture
    assert Path(printed.split()[-1]).is_file()


def test_each_imperfection_of_the_laboratory_stands_alone():
    cases = one_imperfection()
    assert list(cases) == ["realistic", *IMPERFECTIONS, "lab"]
    tilt = load(sensors="lab").sensors.force_torque.tilt
    assert cases["tilt"]["config"] == {"sensors": {"force_torque": {"tilt": tilt}}}


def call(*command):
    done = subprocess.run(
        [sys.executable, "-m", "slipgym", *map(str, command)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout
