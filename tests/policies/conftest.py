import math
from typing import Any, NamedTuple

import gymnasium as gym
import numpy as np
import pytest

import policies
import slipgym  # noqa: F401
from policies.evaluation.experiment import Experiment
from slipgym.config.yaml_model import validate


@pytest.fixture
def small():
    """Makes small experiments: two short trials of a sliding grip in each of eight cells."""

    def make(**changes):
        values = {
            "name": "small",
            "task": "LinearSlip",
            "trials": 2,
            "materials": ["wood", "case"],
            "options": {"duration": 0.2, "settle": 0.05, "hold": 0.05},
            "vary": {"distance": [0.01, 0.02]},
            "policies": [{"name": "constant_force", "parameters": {"force": 2.0}}],
            "friction": [{"source": "estimated"}, {"source": "true"}],
        }
        return validate({**values, **changes}, Experiment, "test")

    return make


class Played(NamedTuple):
    """Outcome of n episodes."""

    success: float
    """Share of those that were solved."""
    grip: float
    """Mean grip force [N]."""


def _play(env_id: str, policy: Any, n: int, seed: int, **keywords: Any) -> Played:
    """Share of solved episodes and mean grip force of n episodes; row i has the seed `seed` + i."""
    modes = policies.modes(policy)
    envs = gym.make_vec(f"slipgym:{env_id}", n, threads=1, **{**modes, **keywords})
    observations, _ = envs.reset(seed=seed)
    running, solved, state = np.ones(n, bool), np.zeros(n, bool), None
    force, steps = np.zeros(n), np.zeros(n)
    while running.any():
        actions, state = policy.predict(observations, state)
        observations, _, terminated, truncated, infos = envs.step(actions)
        force += running * infos["grip_force"].mean(axis=1)
        steps += running
        solved |= running & infos["is_success"] & (terminated | truncated)
        running &= ~(terminated | truncated)
    envs.close()
    found = Played(float(solved.mean()), float((force / steps).mean()))
    error = math.sqrt(found.success * (1.0 - found.success) / n)
    print(f"\n{found.success:.1%} +- {error:.1%} solved of {n}, grip {found.grip:.2f} N: {keywords}", end="")
    return found


@pytest.fixture
def play_batch():
    """Plays a batch of episodes and prints its outcome; `pytest -s` shows it."""
    return _play
