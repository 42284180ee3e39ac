"""A fresh process prints nothing but slipgym's own message about compiling."""

import subprocess
import sys

import pytest

from slipgym._numba import compiled
from slipgym.envs import bullet_simulation

CODE = """
import gymnasium as gym
env = gym.make("slipgym:slipgym/LinearSlip-v0")
env.reset(seed=0)
env.step(env.action_space.sample())
env.close()
"""


def test_the_engine_prints_no_banner():
    done = subprocess.run([sys.executable, "-c", CODE], capture_output=True, text=True, check=True)
    assert done.stdout == ""
    lines = [line for line in done.stderr.splitlines() if not line.startswith("slipgym: compiling")]
    assert lines == []


@pytest.mark.parametrize("closed", ["1>&-", "2>&-", "1>&- 2>&-"])
def test_closed_streams_do_no_harm(closed):
    code = "import slipgym.world.quiet_pybullet as q; q.p.connect(q.p.DIRECT)"
    assert subprocess.run(f"'{sys.executable}' -c '{code}' {closed}", shell=True).returncode == 0


def test_the_first_reset_explains_why_it_takes_long(make, monkeypatch):
    said = []

    def patience(what):
        said.append(what)
        return compiled.patience(what, after=60.0)

    env = make("slipgym/LinearSlip-v0")
    monkeypatch.setattr(bullet_simulation, "patience", patience)
    env.reset(seed=0)
    assert said == ["the reset of LinearSlip with PyBullet"]
    env.step([0.0])
    env.reset()
    assert said[1:] == []  # the stages of a step were compiled with the environment
