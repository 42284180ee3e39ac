"""A run that is interrupted and resumed is the run that was not interrupted."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("stable_baselines3")
from policies.training import checkpoints, folder, plain, run
from policies.training.files import changed

ROOT = Path(__file__).resolve().parents[3]


class Killed(BaseException):
    """Stands for a kill: nothing catches it."""


def differing(one, other, at=""):
    """Where two trees of plain data differ, bit for bit."""
    if isinstance(one, np.ndarray) and isinstance(other, np.ndarray):
        if one.dtype.names:  # field by field: the bytes between fields mean nothing
            return [f for name in one.dtype.names for f in differing(one[name], other[name], f"{at}/{name}")]
        return [] if one.dtype == other.dtype and one.tobytes() == other.tobytes() else [at]
    if hasattr(one, "__dataclass_fields__"):
        return differing(vars(one), vars(other), at)
    if isinstance(one, dict):
        assert one.keys() == other.keys(), at
        return [found for key in one for found in differing(one[key], other[key], f"{at}/{key}")]
    if isinstance(one, list | tuple):
        assert len(one) == len(other), at
        return [found for k in range(len(one)) for found in differing(one[k], other[k], f"{at}/{k}")]
    return [] if one == other else [at]


@pytest.mark.parametrize(
    "algorithm",
    [
        "ppo",
        pytest.param("recurrent_ppo", marks=pytest.mark.slow),
        pytest.param("sac", marks=pytest.mark.slow),
        pytest.param("tqc", marks=pytest.mark.slow),
    ],
)
def test_a_resumed_run_is_equal_bit_for_bit(small, tmp_path, monkeypatch, algorithm):
    config = small(algorithm=algorithm)
    whole, broken = tmp_path / "whole", tmp_path / "broken"
    folder.begin(whole, config, 3)
    run.train(whole, progress=False)

    folder.begin(broken, config, 3)
    save = checkpoints.save

    def save_and_die(path, steps, state, keep):
        save(path, steps, state, keep)
        if steps == 64:
            raise Killed

    monkeypatch.setattr(checkpoints, "save", save_and_die)
    with pytest.raises(Killed):
        run.train(broken, progress=False)
    monkeypatch.undo()
    assert folder.result(broken) is None
    run.train(broken, progress=False)

    assert folder.read_curve(broken) == folder.read_curve(whole)
    assert [row.steps for row in folder.read_curve(whole)] == [0, 32, 64, 96]
    ends = [checkpoints.last(path) for path in (whole, broken)]
    for end in ends:
        assert end["record"].pop("seconds") > 0
    assert differing(*ends) == []
    assert differing(*(plain.read(checkpoints.best(path)) for path in (whole, broken))) == []


def test_the_comparison_notices_one_bit(small, tmp_path):
    path = tmp_path / "run"
    folder.begin(path, small(budget=32), 0)
    run.train(path, progress=False)
    one, other = checkpoints.last(path), checkpoints.last(path)
    weights = other["learner"]["parameters"]["policy"]["action_net.weight"]["tensor"]
    weights[0, 0] = np.nextafter(weights[0, 0], np.float32(1))
    assert differing(one, other) == ["/learner/parameters/policy/action_net.weight/tensor"]


CALLS = ((os, "fsync"), (os, "replace"), (Path, "unlink"), (Path, "open"))
"""The file operations of a run."""


def patched(patch, before):
    """Calls `before` ahead of every file operation."""
    for owner, name in CALLS:
        original = getattr(owner, name)

        def operation(*arguments, original=original, **keywords):
            before()
            return original(*arguments, **keywords)

        patch.setattr(owner, name, operation)


def dying_at(number):
    """Raises at call `number`, counted from 0."""
    left = [number]

    def before():
        left[0] -= 1
        if left[0] < 0:
            raise Killed

    return before


@pytest.mark.parametrize("number", range(4))
def test_a_file_is_the_old_one_or_the_new_one(tmp_path, monkeypatch, number):
    path = tmp_path / "file"
    plain.write(path, {"version": 1})
    with monkeypatch.context() as patch:
        patched(patch, dying_at(number))
        with pytest.raises(Killed):
            plain.write(path, {"version": 2})
    assert plain.read(path) == {"version": 2 if number == 3 else 1}
    plain.write(path, {"version": 3})
    assert plain.read(path) == {"version": 3}


@pytest.mark.slow
def test_a_kill_at_any_file_operation_changes_nothing(small, tmp_path, monkeypatch):
    config, counted = small(budget=32, ppo={"n_steps": 8, "batch_size": 16, "n_epochs": 1}), []
    config = changed(config, {"evaluation.every": 16, "checkpoints.every": 16})
    monkeypatch.setattr("matplotlib.figure.Figure.savefig", lambda figure, path, **_: Path(path).touch())
    whole, again = tmp_path / "whole", tmp_path / "again"
    for path in (whole, again):
        folder.begin(path, config, 1)
    run.train(whole, progress=False)  # the first run of a process also reads what is then cached
    with monkeypatch.context() as patch:
        patched(patch, lambda: counted.append(1))
        run.train(again, progress=False)
    assert len(counted) > 30
    for number in range(len(counted)):
        path = tmp_path / str(number)
        folder.begin(path, config, 1)
        with monkeypatch.context() as patch:
            patched(patch, dying_at(number))
            with pytest.raises(Killed):
                run.train(path, progress=False)
        run.train(path, progress=False)
        assert folder.read_curve(path) == folder.read_curve(whole)
        assert folder.result(path)["best"] == folder.result(whole)["best"]


@pytest.mark.slow
def test_a_killed_process_loses_at_most_an_interval(small, tmp_path):
    config = small(budget=960)
    whole, killed = tmp_path / "whole", tmp_path / "killed"
    for path in (whole, killed):
        folder.begin(path, config, 2)
    run.train(whole, progress=False)
    code = (
        f"import pathlib; from policies.training import run; run.train(pathlib.Path({str(killed)!r}), False)"
    )
    random, kills = np.random.default_rng(0), 0
    for _ in range(5):
        process = subprocess.Popen([sys.executable, "-c", code], cwd=ROOT)
        before = len(folder.read_curve(killed))
        while process.poll() is None and len(folder.read_curve(killed)) <= before + 2:
            time.sleep(0.02)
        time.sleep(random.uniform(0.0, 0.3))
        seen = folder.read_curve(killed)
        process.send_signal(signal.SIGKILL)
        kills += process.wait() == -signal.SIGKILL
        state = checkpoints.last(killed)
        kept = state["record"]["curve"] if state else []
        assert len(seen) - len(kept) <= 1 + (state is None)
        assert seen[: len(kept)] == folder.read_curve(whole)[: len(kept)]
    assert kills >= 3
    run.train(killed, progress=False)
    assert folder.read_curve(killed) == folder.read_curve(whole)
    assert folder.result(killed)["steps"] == 960
