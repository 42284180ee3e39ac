"""The commands of docs/afternoon.md lead from a laboratory's log to a policy that commands its gripper.

The laboratory is simulated: the page knows neither its gripper nor the names, units and signs of its log.
"""

import os
import re
import shlex
import socket
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

from estimator.live import read
from estimator.records import load_columns
from lab.simulated_gripper import draw_gripper, simulated_log
from policies.commands.front import application
from slipgym.config import load
from slipgym.identification import read_log

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs/afternoon.md").read_text(encoding="utf-8")
COMMANDS = re.findall(r"^    slipgym (.+)$", PAGE, re.MULTILINE)
SHORTER = {
    "train": "--set budget=2048 num_envs=64 evaluation.episodes=4 privileged_ppo.n_minibatches=2",
    "evaluate": "--trials 2",
}
GRIPPER = draw_gripper(7)
NAMES = ("stamp [ms]", "grip_cmd", "arm_vx [mm/s]", "arm_vy [mm/s]", "arm_wz [deg/s]", "Fx", "Fy", "Fz",
         "Mz [N mm]", "slip_x [mm/s]", "slip_y [mm/s]", "slip_rate [deg/s]")  # fmt: skip
FACTORS = np.array([1e3, 1, -1e3, -1e3, -np.degrees(1), 1, 1, -1, 1e3, 1e3, 1e3, np.degrees(1)])


@pytest.fixture(scope="module")
def log():
    return simulated_log(GRIPPER, 7)


@pytest.fixture
def bench(log, tmp_path, monkeypatch):
    """A folder with nothing but the log, where the commands run."""
    t = 1.7e5 + np.arange(len(log.command)) / log.rate
    rows = np.column_stack([t, log.command, log.motion, log.readings]) * FACTORS
    np.savetxt(tmp_path / "log.csv", rows, fmt="%.12g", delimiter=",", header=",".join(NAMES), comments="")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def call(words):
    name, *words = shlex.split(words)
    done = CliRunner().invoke(application(name), words)
    assert done.exit_code == 0, f"{name} {words}\n{done.output}"
    return done.output


def test_the_page_has_all_steps():
    names = [each.split()[0] for each in COMMANDS]
    assert names == ["map", "estimate", "identify", "train", "evaluate", "export-policy", "live"]


def test_map_finds_the_laboratorys_names_units_and_signs(bench, log):
    printed = call(COMMANDS[0])
    assert COMMANDS[1] in printed
    assert COMMANDS[2].startswith("identify log.csv --columns mapping.yaml")
    assert "identify log.csv --columns mapping.yaml" in printed
    found = read_log("log.csv", load_columns("mapping.yaml"))
    for name in ("command", "motion", "readings"):
        np.testing.assert_allclose(getattr(found, name), getattr(log, name), rtol=1e-9, atol=1e-12)
    assert found.rate == pytest.approx(log.rate)
    assert "mu_c" in call(COMMANDS[1])


@pytest.mark.parametrize("key", ["motion_x", "motion_omega", "tau", "v_y"])
def test_a_wrong_sign_is_refused(bench, key):
    call(COMMANDS[0])
    mapping = yaml.safe_load(Path("mapping.yaml").read_text())
    mapping[key]["sign"] = -mapping[key].get("sign", 1)
    Path("mapping.yaml").write_text(yaml.safe_dump(mapping))
    with pytest.raises(ValueError, match=rf"{key}.*sign"):
        read_log("log.csv", load_columns("mapping.yaml"))


def test_names_of_the_laboratory_without_a_mapping(bench):
    done = CliRunner().invoke(application("identify"), ["log.csv"])
    assert done.exit_code == 2
    assert "--columns" in done.output


def run(words, folder):
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "200"}
    command = [sys.executable, "-m", "slipgym", *shlex.split(words)]
    return subprocess.Popen(
        command, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


@pytest.mark.slow
def test_the_whole_afternoon(bench):
    printed = {}
    for words in COMMANDS[:-1]:
        name = words.split()[0]
        done = run(f"{in_runs(words)} {SHORTER.get(name, '')}", bench)
        printed[name], errors = done.communicate()
        assert done.returncode == 0, f"{words}\n{printed[name]}\n{errors}"
    assert "The model fits this log" in printed["identify"]
    found = load("my_gripper/gripper.yaml")
    assert found.materials["identified"].mu_c == pytest.approx(GRIPPER.values["mu_c"], rel=0.05)
    assert "solved" in printed["evaluate"]
    assert Path("policy.onnx").stat().st_size > 1000
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as door:
        door.bind(("127.0.0.1", 0))
        port = door.getsockname()[1]
    client = (ROOT / "examples/live/client.py").read_text(encoding="utf-8").replace("7741", str(port))
    server = run(f"{in_runs(COMMANDS[-1])} --port {port} --seconds 60", bench)
    assert "listening" in server.stderr.readline()
    answered = subprocess.run([sys.executable, "-c", client, "3"], capture_output=True, text=True, check=True)
    server.send_signal(2)  # Ctrl-C
    report, errors = server.communicate()
    assert server.returncode == 0, errors
    assert "grip " in answered.stdout
    assert "velocity 2: received" in report
    assert sum(line.get("status") == "ok" and "command" in line for line in read("run.jsonl")) > 20


def in_runs(words):
    """A command with the name of the run's folder."""
    names = [path.name for path in Path("runs/mine").glob("*")]
    return words.replace("hold__privileged_ppo__TIME", names[0]) if names else words
