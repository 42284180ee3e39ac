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
from policies.training import checkpoints, files, folder, run
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


def whole_and_broken(config, tmp_path, monkeypatch):
    """Folders of a run, and of the same run that is killed at its checkpoint of 64 steps and resumed."""
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
    return whole, broken


@pytest.mark.parametrize(
    ("algorithm", "chosen"),
    [
        ("ppo", {}),
        ("ppo", {"ppo": {"n_steps": 16, "batch_size": 16, "n_epochs": 1, "use_sde": True}}),
        pytest.param("recurrent_ppo", {}, marks=pytest.mark.slow),
        pytest.param("sac", {}, marks=pytest.mark.slow),
        pytest.param("tqc", {}, marks=pytest.mark.slow),
    ],
    ids=["ppo", "ppo-sde", "recurrent_ppo", "sac", "tqc"],
)
def test_a_resumed_run_is_equal_bit_for_bit(small, tmp_path, monkeypatch, algorithm, chosen):
    config = small(
        algorithm=algorithm,
        **chosen,
        spread=True,
        derived={"grip": {"f_n_1": 0.5, "f_n_2": 0.5}} if algorithm == "ppo" else {},
    )
    whole, broken = whole_and_broken(config, tmp_path, monkeypatch)
    assert folder.read_curve(broken) == folder.read_curve(whole)
    assert [row.steps for row in folder.read_curve(whole)] == [0, 32, 64, 96]
    ends = [checkpoints.last(path) for path in (whole, broken)]
    for end in ends:
        assert end["record"].pop("seconds") > 0
        assert end["record"].pop("cpu_seconds") > 0
    assert differing(*ends) == []
    assert differing(*(checkpoints.read(checkpoints.best(path)) for path in (whole, broken))) == []


@pytest.mark.parametrize("memory", [0, 4])
def test_a_resumed_run_with_stages_is_equal_bit_for_bit(small, tmp_path, monkeypatch, memory):
    """The curriculum moves on between the checkpoint and the interruption, and after it."""
    stages = [{"tasks": {"linear_slip": {"tolerance": t}}} for t in (0.05, 0.02)]
    config = small(
        algorithm="privileged_ppo",
        budget=128,
        privileged_ppo={
            "n_steps": 16,
            "n_epochs": 2,
            "n_minibatches": 2,
            "memory": memory,
            "critic_first": 1,
            "curriculum": {"stages": stages, "success": 0.0, "episodes": 3},
        },
    )
    ends = [checkpoints.last(path) for path in whole_and_broken(config, tmp_path, monkeypatch)]
    assert ends[0]["learner"]["counters"]["stage"] == 2
    for end in ends:
        end["record"].pop("seconds"), end["record"].pop("cpu_seconds")
    assert differing(*ends) == []


def test_a_run_goes_on_without_the_policy_that_it_started_from(small, tmp_path, monkeypatch):
    """Its path is relative, and nothing is there any more."""
    chosen = {"n_steps": 16, "n_epochs": 1, "n_minibatches": 1}
    folder.begin(tmp_path / "first", small(algorithm="privileged_ppo", privileged_ppo=chosen, budget=32), 0)
    run.train(tmp_path / "first", progress=False)
    monkeypatch.chdir(tmp_path)
    config = small(algorithm="privileged_ppo", privileged_ppo={**chosen, "start": "first/policy"})
    save = checkpoints.save

    def save_and_leave(path, steps, state, keep):
        save(path, steps, state, keep)
        if steps == 64 and (tmp_path / "first").exists():
            (tmp_path / "first").rename(tmp_path / "elsewhere")
            raise Killed

    folder.begin(tmp_path / "second", config, 0)
    monkeypatch.setattr(checkpoints, "save", save_and_leave)
    with pytest.raises(Killed):
        run.train(tmp_path / "second", progress=False)
    assert run.train(tmp_path / "second", progress=False)["steps"] == 96


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
    checkpoints.write(path, {"version": 1})
    with monkeypatch.context() as patch:
        patched(patch, dying_at(number))
        with pytest.raises(Killed):
            checkpoints.write(path, {"version": 2})
    assert checkpoints.read(path) == {"version": 2 if number == 3 else 1}
    checkpoints.write(path, {"version": 3})
    assert checkpoints.read(path) == {"version": 3}


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


def script(*arguments, cwd):
    """`scripts/train.py` as a process of its own; what it complains about is in the file "errors"."""
    command = [sys.executable, ROOT / "scripts" / "train.py", *map(str, arguments)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    with (cwd / "errors").open("w") as errors:
        return subprocess.Popen(command, cwd=cwd, env=environment, stdout=errors, stderr=errors)


def waited(process, *, until=lambda: False):
    """Time until something is so, or the process has ended [s]."""
    start = time.monotonic()
    while process.poll() is None and not until():
        time.sleep(0.01)
    return time.monotonic() - start


def evaluations(path) -> int:
    """Lines of the killed run's curve."""
    return sum(len(curve.read_bytes().splitlines()) for curve in path.glob("killed/*/estimated__2/curve.csv"))


@pytest.mark.slow
def test_ten_kills_at_random_moments_lose_nothing_but_an_interval(small, tmp_path):
    (tmp_path / "mine.yaml").write_text(files.text(small(budget=9600)))
    begin = ("mine.yaml", "--seeds", "2", "--output")
    process = script(*begin, "whole", cwd=tmp_path)
    to_first = waited(process, until=lambda: any(tmp_path.glob("whole/*/*/curve.csv")))
    between = waited(process) / 300
    assert process.returncode == 0, (tmp_path / "errors").read_text()
    (whole,) = tmp_path.glob("whole/*/estimated__2")
    rows = folder.read_curve(whole)
    assert len(rows) == 301

    random, kills, steps = np.random.default_rng(0), 0, 0
    while kills < 10:
        begun = list(tmp_path.glob("killed/*/estimated__2/run.yaml"))
        process = script(*(("--resume", begun[0].parent) if begun else (*begin, "killed")), cwd=tmp_path)
        kills, more = kills + 1, max(int(random.integers(-5, 20)), 0)  # evaluations; of 300 at most 200
        goal = evaluations(tmp_path) + more
        waited(process, until=lambda goal=goal: evaluations(tmp_path) >= goal)
        time.sleep(random.uniform(0.0, 5.0 * between if more else to_first))
        process.send_signal(signal.SIGKILL)
        assert process.wait() == -signal.SIGKILL, (tmp_path / "errors").read_text()
        for killed in tmp_path.glob("killed/*/estimated__2"):
            seen, state = folder.read_curve(killed), checkpoints.last(killed)
            kept = state["record"]["curve"] if state else []
            assert seen == rows[: len(seen)]
            assert len(seen) - 1 <= len(kept) <= len(seen) or state is None
            assert (state["learner"]["counters"]["num_timesteps"] if state else 0) >= steps
            steps = state["learner"]["counters"]["num_timesteps"] if state else 0
    assert 0 < steps < 9600

    process = script("--resume", killed, cwd=tmp_path)
    assert process.wait() == 0, (tmp_path / "errors").read_text()
    for name in ("curve.csv", "run.yaml", "policy/policy.json", "policy/weights.safetensors"):
        assert (killed / name).read_bytes() == (whole / name).read_bytes(), name
    ends = [checkpoints.last(path) for path in (whole, killed)]
    for end in ends:
        assert end["record"].pop("seconds") > 0
        assert end["record"].pop("cpu_seconds") > 0
    assert differing(*ends) == []
    assert differing(*(checkpoints.read(checkpoints.best(path)) for path in (whole, killed))) == []


def test_a_run_that_another_version_began_goes_on(small, tmp_path):
    """Its optimiser was not the fused one, and its record has no CPU time."""
    path = tmp_path / "run"
    folder.begin(path, small(budget=64), 0)
    config, seed = folder.order(path)
    run.train(path, progress=False)
    state = checkpoints.last(path)
    state["record"].pop("cpu_seconds")
    state["record"]["ended"] = ""
    for group in state["learner"]["parameters"]["policy.optimizer"]["param_groups"]:
        assert group["fused"]
        group["fused"] = None
    other = tmp_path / "other"
    folder.begin(other, changed(config, {"budget": 96}), seed)
    checkpoints.write(checkpoints.best(other), checkpoints.read(checkpoints.best(path)))
    checkpoints.save(other, 64, state, keep=2)
    assert run.train(other, progress=False)["steps"] == 96
    groups = checkpoints.last(other)["learner"]["parameters"]["policy.optimizer"]["param_groups"]
    assert [group["fused"] for group in groups] == [None]
