"""`slipgym warmup` compiles for other processors into a folder, as a wheel carries it."""

import json
import os
import subprocess
import sys

import pytest
from typer.testing import CliRunner

from estimator._numba import folders
from policies.commands.warmup import app


def test_an_unknown_processor_is_refused(tmp_path):
    done = CliRunner().invoke(app, ["--target", "x86-64-v9", "--into", str(tmp_path)])
    assert done.exit_code == 2
    assert "x86-64-v4" in done.output
    assert list(tmp_path.iterdir()) == []


STEP = """
import sys, pathlib
from estimator._numba import folders
folders.SHIPPED = pathlib.Path(sys.argv[1])
import gymnasium as gym
envs = gym.make_vec("slipgym:slipgym/Hold-v0", num_envs=1)
envs.reset(seed=0)
envs.step(envs.action_space.sample())
"""


@pytest.mark.slow
def test_a_store_for_other_processors_is_used(tmp_path):
    store, empty = tmp_path / "store", tmp_path / "empty"
    done = CliRunner().invoke(
        app, ["--target", folders.TARGET, "--into", str(store), "--task", "hold", "--engine", "planar"]
    )
    assert done.exit_code == 0, done.output
    assert json.loads((store / folders.ABOUT).read_text()) == {**folders.versions(), "target": folders.TARGET}
    assert (store / "slipgym" / "envs").is_dir()
    if folders.runs_shipped():
        variables = {**os.environ, "NUMBA_CACHE_DIR": str(empty)}
        subprocess.run([sys.executable, "-c", STEP, str(store)], env=variables, check=True)
        assert list(empty.rglob("*.nbc")) == []
