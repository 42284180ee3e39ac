"""A simulation that leaves the numbers stops, says where, and can be started afresh."""

import csv
import re
import tempfile
from pathlib import Path

import numpy as np
import pytest

from slipgym.envs.nan_guard import FILES, KEPT, QUANTITIES, VARIABLE

NAMES = [quantity.name for quantity in QUANTITIES]


def stopped(env) -> str:
    """Pushes the object with a force that is no number, and returns what the environment says to it."""
    episode = env.simulation.episode
    episode["pushes"], episode["push_end"][0, 0] = 1, episode["steps"][0]
    episode["push_wrench"][0, 0] = np.nan, 0.0, 0.0
    with pytest.raises(FloatingPointError) as caught:
        env.step(np.zeros(1, np.float32))
    return str(caught.value)


def test_names_the_first_quantity_and_writes_the_last_samples(make):
    env = make()
    env.reset(seed=0)
    for _ in range(9):
        env.step(np.zeros(1, np.float32))
    message = stopped(env)
    assert re.match(r"object_x is nan at t = 0\.0833333 s; the last 10 samples are in ", message)
    path = re.search(r"in (\S+\.csv);", message)[1]
    with open(path) as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == ["time", *NAMES]
    assert len(rows) == 10
    assert all(np.isfinite(float(rows[k][name])) for k in range(9) for name in NAMES)
    lag, commanded = np.exp(-(1 / 120 - 0.004) / 0.012), 12.8
    assert float(rows[0]["grip_force_1"]) == pytest.approx(commanded + (15.0 - commanded) * lag, abs=0.01)
    assert rows[9]["disturbance_x"] == "nan"


def test_keeps_the_last_second_only(make):
    env = make(frame_skip=30)
    env.reset(seed=0)
    for _ in range(6):
        env.step(np.zeros(1, np.float32))
    assert f"the last {KEPT} samples" in stopped(env)


def test_a_folder_keeps_the_newest_files(make, tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, str(tmp_path / "dumps"))
    env = make(engine="planar")
    messages = []
    for _ in range(FILES + 3):
        env.reset(seed=0)
        messages.append(stopped(env))
    left = {str(path) for path in (tmp_path / "dumps").iterdir()}
    assert left == {re.search(r"in (\S+\.csv);", message)[1] for message in messages[-FILES:]}


def test_a_folder_of_the_user_alone_is_the_default(make, tmp_path, monkeypatch):
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    env = make(engine="planar")
    env.reset(seed=0)
    path = Path(re.search(r"in (\S+\.csv);", stopped(env))[1])
    assert path.parent.parent == tmp_path
    assert path.parent.stat().st_mode & 0o077 == 0


def test_a_folder_that_cannot_be_written_hides_nothing(make, tmp_path, monkeypatch):
    (tmp_path / "file").touch()
    monkeypatch.setenv(VARIABLE, str(tmp_path / "file"))
    env = make(engine="planar")
    env.reset(seed=0)
    assert "object_x is nan" in stopped(env)


def test_starts_afresh(make, play):
    env = make()
    env.reset(seed=0)
    stopped(env)
    with pytest.raises(RuntimeError, match="reset"):
        env.step(np.zeros(1, np.float32))
    assert play(env, seed=3) == play(make(), seed=3)
