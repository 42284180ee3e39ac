"""The benchmark of learning measures what it says; how fast things are is not tested."""

import json
import os
import subprocess
import sys
from pathlib import Path
from time import process_time

import pytest

pytest.importorskip("stable_baselines3")
from lab.benchmarking import learning as benchmark
from lab.benchmarking import sample_cost

ROOT = Path(__file__).resolve().parents[3]
LINEAR = "slipgym/LinearSlip-v0"


def test_shares_of_a_step():
    figures = {figure.name: figure.value for figure in benchmark.shares(LINEAR, 4, 30)}
    step, adapter = figures["SlipVectorEnv.step, n = 4"], figures["SlipVecEnv, n = 4"]
    assert min(figures.values()) > 0.0
    assert figures["SlipVecEnv, n = 4, share"] == pytest.approx(adapter / (step + adapter))
    assert set(figures) >= {"VecMonitor, n = 4"}


def test_ppo_in_both():
    figures = {figure.name: figure.value for figure in benchmark.learning(LINEAR, 2, rollout=512)}
    assert 0.0 < figures["PPO in a batch of 256, share of the environments"] < 1.0
    assert min(figures.values()) > 0.0


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({}, {"policy in rollouts", "forward pass", "backward pass", "optimiser"}),
        ({"algorithm": "privileged_ppo"}, {"actor and critic in rollouts", "update"}),
    ],
)
def test_parts_of_a_sample(monkeypatch, small, changes, named):
    config = small(num_envs=4, vary={"distance": [0.02, 0.03]}, **changes)
    monkeypatch.setattr(sample_cost.files, "load", lambda name: config)
    start = process_time()
    figures = {figure.name: figure.value for figure in sample_cost.sample_cost("test", 3)}
    available = 1e6 * (process_time() - start) / (3 * 16 * 4)  # per sample of the measured updates
    total = figures.pop("test, sum")
    parts = {name.removeprefix("test, ") for name in figures}
    assert {"environments", "adapter", "monitor", "normalisation", "evaluation"} | named <= parts
    assert total == pytest.approx(sum(figures.values()))
    of_updates = total - figures["test, evaluation"]  # an evaluation is divided by other samples
    assert 0.0 < of_updates < available
    assert 0.0 < figures["test, evaluation"] * config.evaluation.every / (3 * 16 * 4) < available - of_updates


@pytest.mark.slow
def test_the_script_runs(tmp_path):
    path = tmp_path / "figures.json"
    command = [sys.executable, "-m", "slipgym", "benchmark-parts", "learning", "--pairs", "2", "--json", path]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    found = json.loads(path.read_text())
    names = [figure["name"] for figure in found["figures"]]
    assert len(names) == len(set(names))
    configurations = {"linear_slip_plain", "linear_slip_scratch", "fragile_hold_memory"}
    assert {f"{name}, sum" for name in configurations} < set(names)
    assert all(name in done.stdout for name in names)
    assert "torch" in found["machine"]
