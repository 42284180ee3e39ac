"""Both scripts from a terminal, and the environment's own estimates from its record."""

import os
import subprocess
import sys
from pathlib import Path

import gymnasium as gym
import numpy as np
import pandas as pd
import pytest

import policies
from estimator import records
from policies.evaluation.sensor_record import record_sensors, save_record

ROOT = Path(__file__).resolve().parents[2]
SHIPPED = ROOT / "examples" / "linear_slip_wood.csv.gz"
OPTIONS = {"duration": 0.6, "distance": 0.01, "settle": 0.1, "hold": 0.1}


def call(folder, script, *arguments, path=ROOT):
    environment = {**os.environ, "PYTHONPATH": str(path), "COLUMNS": "100"}
    return subprocess.run(
        [sys.executable, ROOT / "scripts" / script, *map(str, arguments)],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize(
    ("script", "words"),
    [
        ("estimate", ("--columns", "--velocity", "--estimator", "--set", "--allow-gaps", "--output")),
        ("record", ("--velocity", "--finger", "--seed", "--material", "--option")),
    ],
)
def test_help_teaches(invoke, script, words):
    done = invoke(script, "--help")
    assert done.exit_code == 0, done.stderr
    for word in (*words, "Examples", "docs/records.md"):
        assert word in done.stdout


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["nowhere.csv"], "no such file"),
        ([SHIPPED, "--estimator", "rlss"], "unknown estimator 'rlss'; valid: adaptive, disc, joint, rls"),
        ([SHIPPED, "--estimator", "gru"], '"gru" is part of the laboratory'),
        ([SHIPPED, "--set", "lambda=0.9"], "unknown parameter lambda"),
        ([SHIPPED, "--set", "n_a"], "must be name=value"),
        ([SHIPPED, "--columns", "nowhere.yaml"], "nowhere.yaml"),
    ],
)
def test_mistakes_are_explained_and_leave_nothing(tmp_path, invoke, arguments, message):
    done = invoke("estimate", *arguments)
    assert done.exit_code == 2
    assert message in " ".join(done.stderr.split())
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("missing", ["typer", "pandas"])
def test_a_missing_extra_says_how_to_install_it(tmp_path, missing):
    (tmp_path / f"{missing}.py").write_text(f"raise ModuleNotFoundError('none', name={missing!r})")
    done = call(tmp_path, "estimate.py", SHIPPED, path=f"{tmp_path}{os.pathsep}{ROOT}")
    assert done.returncode != 0
    assert f"{missing} is not installed: pip install 'slipgym[cli]'" in " ".join(done.stderr.split())
    assert "Traceback" not in done.stderr


@pytest.mark.slow  # the scripts in processes of their own; the tests below call what they call
def test_from_an_episode_to_estimates(tmp_path):
    options = [word for name, value in OPTIONS.items() for word in ("--option", f"{name}={value}")]
    files = "forces.parquet", "--velocity", "velocities.csv"
    done = call(tmp_path, "record.py", "LinearSlip", "linear_slip", *files, "--finger", "2", *options)
    assert done.returncode == 0, done.stderr
    done = call(tmp_path, "estimate.py", *files, "--set", "memory=0.5", "--output", "out")
    assert done.returncode == 0, done.stderr
    (run,) = (tmp_path / "out").iterdir()
    assert run.name.startswith("forces__")
    assert {path.suffix for path in run.iterdir()} == {".csv", ".parquet", ".md", ".png"}
    assert str(run / "estimates.png") in done.stdout
    assert "mu_c" in done.stdout


def test_an_error_while_writing_leaves_nothing(tmp_path, monkeypatch):
    from slipgym.atomic_io import new_folder

    def broken(self, *arguments, **keywords):
        raise OSError("disk full")

    result = records.estimate(records.load(SHIPPED))
    monkeypatch.setattr(pd.DataFrame, "to_csv", broken)
    with pytest.raises(OSError, match="disk full"), new_folder(tmp_path / "run") as folder:
        records.write(result, folder)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "finger"), [("disc", 1), ("disc", 2), ("rls", 1), ("joint", 2), ("ukf", 1), ("adaptive", 1)]
)
def test_a_record_gives_the_environments_own_estimates(tmp_path, name, finger):
    """A record begins after the grasp, in which only "adaptive" learns: it stays within one deviation."""
    keywords = {
        "estimator": name,
        "material": "wood",
        "config": {"contact": {"cop_offset": [[0.002, 0.0], [0.0, -0.001]]}},
    }
    frame = record_sensors("LinearSlip", "linear_slip", finger, seed=3, options=OPTIONS, **keywords)
    frame.to_parquet(tmp_path / "log.parquet")
    result = records.estimate(records.load(tmp_path / "log.parquet"), name)
    env = gym.make("slipgym:slipgym/LinearSlip-v0", **keywords)
    policy, state, over = policies.make("linear_slip"), None, False
    observation, _ = env.reset(seed=3, options=OPTIONS)
    estimated = []
    while not over:
        action, state = policy.predict(observation, state=state)
        observation, _, terminated, truncated, info = env.step(action)
        estimated.append(info["estimated_per_finger"][finger - 1])
        over = terminated or truncated
    env.close()
    ours = np.column_stack([result.estimates[value] for value in ("mu_s", "mu_c", "r")])
    if name == "adaptive":
        stated = np.column_stack([result.estimates[f"sd_{value}"] for value in ("mu_s", "mu_c", "r")])
        assert (np.abs(ours - estimated) < stated).all()
    else:
        np.testing.assert_allclose(ours, estimated, rtol=1e-9)
    assert result.estimates[-1]["updates_mu_c"] > 0


@pytest.mark.parametrize(("name", "library"), [("log.h5", "h5py"), ("log.mcap", "mcap")])
def test_a_record_in_one_file_closes_bit_for_bit(tmp_path, name, library):
    pytest.importorskip(library)
    frame = record_sensors("LinearSlip", "linear_slip", 1, seed=3, options=OPTIONS, material="wood")
    for file in (name, "log.parquet"):
        save_record(frame, tmp_path / file)
    ours, plain = (records.estimate(records.load(tmp_path / file)) for file in (name, "log.parquet"))
    np.testing.assert_array_equal(ours.estimates, plain.estimates)
    np.testing.assert_array_equal(ours.samples.truth, plain.samples.truth)
    with pytest.raises(ValueError, match="holds both streams already"):
        save_record(frame, tmp_path / name, tmp_path / "velocity.csv")


def test_the_fingers_of_a_mapping_have_a_folder_each(tmp_path, invoke):
    (tmp_path / "two.yaml").write_text("fingers: {left: {}, right: {f_y: {sign: -1}, v_y: {sign: -1}}}")
    done = invoke("estimate", SHIPPED, "--columns", tmp_path / "two.yaml", "--output", tmp_path / "out")
    assert done.exit_code == 0, done.stderr
    (run,) = (tmp_path / "out").iterdir()
    left, right = (pd.read_parquet(run / finger / "estimates.parquet") for finger in ("left", "right"))
    np.testing.assert_array_equal(left["f_y"], -right["f_y"])
    assert "Finger left" in done.stdout
    assert str(run / "right" / "summary.md") in done.stdout
    (tmp_path / "two.yaml").write_text("fingers: {left: {}, right: {f_n: Fz}}")
    done = invoke("estimate", SHIPPED, "--columns", tmp_path / "two.yaml", "--output", tmp_path / "out")
    assert done.exit_code == 2
    assert "finger right: linear_slip_wood.csv.gz: f_n: no column 'Fz'" in " ".join(done.stderr.split())
    assert len(list((tmp_path / "out").iterdir())) == 1


def test_a_record_of_nothing_known_is_refused():
    with pytest.raises(ValueError, match="did you mean 'linear_slip'"):
        record_sensors("LinearSlp", "linear_slip")
    with pytest.raises(ValueError, match="must be 1 or 2"):
        record_sensors("LinearSlip", "linear_slip", finger=3)
