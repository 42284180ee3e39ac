"""Memory of an environment of a batch, and very many of them."""

import subprocess
import sys
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest

from slipgym.benchmarking.run import bytes_per_environment
from slipgym.contact.records import CELL_FIELDS

ROOT = Path(__file__).resolve().parents[2]
ID = "slipgym/Hold-v0"


def measured(n=10, **arguments):
    env = gym.make_vec(ID, num_envs=n, **arguments)
    total = bytes_per_environment(env)
    env.close()
    return total


def test_every_environment_takes_as_much():
    few, many = measured(randomization="train"), measured(100, randomization="train")
    assert few == pytest.approx(many, rel=0.01)  # the parameters of the estimators are shared


@pytest.mark.slow
def test_cells_and_history_come_on_top():
    env = gym.make_vec(ID, num_envs=1)
    columns = len(env.columns)
    env.close()
    assert measured(history=3) - measured() == 3 * 4 * columns
    few, many = (measured(contact="distributed", config={"contact": {"cells": k}}) for k in (3, 5))
    more = (many - few) / (2 * 8 * CELL_FIELDS)
    assert more == pytest.approx(round(more), abs=1e-9)
    assert more > 0
    assert many > few > measured()


@pytest.mark.slow
def test_a_hundred_thousand_environments_at_once():
    """About 3 GB; the last row is the scalar environment with its seed."""
    n, zero = 100_000, np.zeros(1, np.float32)
    env = gym.make_vec(ID, num_envs=n)
    one = gym.make(ID, engine="planar").unwrapped
    observations, _ = env.reset(seed=0)
    expected, _ = one.reset(seed=n - 1)
    np.testing.assert_array_equal(observations[-1], expected)
    assert len(np.unique(observations, axis=0)) == n
    for _ in range(3):
        observations, rewards, *_ = env.step(np.tile(zero, (n, 1)))
        expected, reward, *_ = one.step(zero)
        np.testing.assert_array_equal(observations[-1], expected)
        assert rewards[-1] == reward
    assert np.isfinite(rewards).all()
    env.close()
    one.close()


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="Linux alone says so")
def test_an_environment_with_pybullet_takes_tens_of_megabytes():
    """In a new process: what other tests have freed would be used again."""
    command = "from lab.benchmarking.memory import bytes_with_pybullet as f; print(f(count=5))"
    done = subprocess.run([sys.executable, "-c", command], cwd=ROOT, capture_output=True, check=True)
    assert 10.0 < float(done.stdout) / 2**20 < 60.0
