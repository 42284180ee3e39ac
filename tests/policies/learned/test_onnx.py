"""A policy and its ONNX graph act alike."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from policies.learned import LearnedPolicy

ROOT = Path(__file__).resolve().parents[3]

onnx = pytest.importorskip("onnx")
runtime = pytest.importorskip("onnxruntime")


def session(folder, path):
    from policies.learned.onnx_graph import write_onnx

    write_onnx(folder, path)
    options = runtime.SessionOptions()
    options.intra_op_num_threads = 1
    return runtime.InferenceSession(path, options, providers=["CPUExecutionProvider"])


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"network": {"activation": "relu", "squash": True}},
        {"network": {"activation": "elu", "layers": []}},
        {"network": {"activation": "elu"}, "normalisation": None},
        {"action_mode": "grip_force_wrist", "task": "LinearSlip"},
    ],
)
def test_graph_and_policy_act_alike(policy_folder, tmp_path, changes):
    policy = LearnedPolicy(folder := policy_folder(**changes))
    graph = session(folder, tmp_path / "policy.onnx")
    rng, spread = np.random.default_rng(0), []
    for n in (1, 64):
        shape = (n, policy.description.environment.width)
        observations = (0.5 * rng.standard_t(3, size=shape)).astype(np.float32)
        wanted, _ = policy.predict(observations)
        (actions,) = graph.run(["action"], {"observation": observations})
        assert actions.dtype == np.float32
        # float32 sums of up to 40 products of order 1, taken in another order: roundings of 6e-8 each
        np.testing.assert_allclose(actions, wanted, atol=2e-6)
        spread.append(wanted)
    assert np.std(np.concatenate(spread)) > 0.1


def test_graph_and_policy_remember_alike(policy_folder, lstm, tmp_path):
    policy = LearnedPolicy(folder := policy_folder(**lstm))
    graph = session(folder, tmp_path / "policy.onnx")
    assert [value.name for value in graph.get_inputs()] == ["observation", "hidden", "cell"]
    state, (hidden, cell) = None, np.zeros((2, 3, 2, 5), np.float32)
    for t in range(12):
        observations = np.random.default_rng(t).normal(size=(3, 29)).astype(np.float32)
        begun = np.array([False, t == 5, t % 4 == 0])
        hidden, cell = (np.where(begun[:, None, None], np.float32(0.0), part) for part in (hidden, cell))
        wanted, state = policy.predict(observations, state, begun)
        names = ["action", "next_hidden", "next_cell"]
        inputs = {"observation": observations, "hidden": hidden, "cell": cell}
        action, hidden, cell = graph.run(names, inputs)
        for ours, theirs in ((wanted, action), (state[0], hidden), (state[1], cell)):
            np.testing.assert_allclose(theirs, ours, atol=2e-6)


def test_the_file_says_what_the_numbers_mean(policy_folder, tmp_path):
    folder, path = policy_folder(), tmp_path / "policy.onnx"
    session(folder, path)
    first = path.read_bytes()
    session(folder, path)
    assert path.read_bytes() == first
    (prop,) = onnx.load(path).metadata_props
    assert json.loads(prop.value) == json.loads((folder / "policy.json").read_text())
    assert {entry.name for entry in tmp_path.iterdir()} == {"policy", "policy.onnx"}


@pytest.mark.slow
def test_the_command_line(policy_folder, tmp_path):
    def call(policy):
        command = [sys.executable, ROOT / "scripts" / "export_policy.py", policy, "--onnx", "policy.onnx"]
        paths = {**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "100"}
        return subprocess.run(command, cwd=tmp_path, env=paths, capture_output=True, text=True, check=False)

    done = call(policy_folder())
    assert done.returncode == 0, done.stderr
    assert "policy.onnx" in done.stdout
    onnx.checker.check_model(onnx.load(tmp_path / "policy.onnx"))
    missing = call("nobody")
    assert missing.returncode == 2
    assert "no learned policy at 'nobody'" in missing.stderr
