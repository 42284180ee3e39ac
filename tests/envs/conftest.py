import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

from slipgym.registration import ENVIRONMENTS
from tests.envs.printing import exactly

IDS = tuple(ENVIRONMENTS)
ROOT = Path(__file__).resolve().parents[2]


CARRYING = {f"slipgym/{name}-v0" for name in ("FragileHold", "Carry", "Explore", "PivotTo")}
"""Tasks that draw their friction from a range; most begin on a support, and the wrist moves.

What is tested for every task is tested for these with the slow tests; tests/tasks has their own.
"""


@pytest.fixture(params=[pytest.param(each, marks=[pytest.mark.slow] * (each in CARRYING)) for each in IDS])
def env_id(request) -> str:
    return request.param


@pytest.fixture(params=[each for each in IDS if each not in CARRYING])
def hanging_id(request) -> str:
    """Ids of tasks whose object hangs in the grip from the start and is of a material."""
    return request.param


@pytest.fixture
def make() -> Iterator[Callable[..., gym.Env]]:
    """Makes bare environments, acted on by the grip force alone, and closes them after the test."""
    made = []

    def factory(env_id: str = IDS[0], **arguments: Any) -> gym.Env:
        env = gym.make(env_id, **{"action_mode": "grip_force", **arguments}).unwrapped
        made.append(env)
        return env

    yield factory
    for env in made:
        env.close()


@pytest.fixture
def make_vec() -> Iterator[Callable[..., gym.vector.VectorEnv]]:
    """Makes batches, acted on by the grip force alone, and closes them after the test."""
    made = []

    def factory(env_id: str = IDS[0], **arguments: Any) -> gym.vector.VectorEnv:
        env = gym.make_vec(env_id, **{"action_mode": "grip_force", **arguments})
        made.append(env)
        return env

    yield factory
    for env in made:
        env.close()


@pytest.fixture
def python() -> Callable[..., str]:
    """Runs a fresh interpreter in the repository, warnings as errors, and returns what it printed."""

    def run(*arguments: str) -> str:
        command = [sys.executable, "-W", "error", *arguments]
        done = subprocess.run(
            command,
            cwd=ROOT,
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run


@pytest.fixture(autouse=True)
def exact_printing() -> Iterator[None]:
    with exactly():
        yield


@pytest.fixture
def play() -> Callable[..., list[str]]:
    """Plays random actions; one line per step that spells every bit of what the environment said."""

    def trace(env: gym.Env, seed: int = 0, steps: int = 60, options: dict | None = None) -> list[str]:
        said = [repr(env.reset(seed=seed, options=options))]
        actions = np.random.default_rng(seed).uniform(-1.0, 1.0, (steps, 1)).astype(np.float32)
        for action in actions:
            said.append(repr(env.step(action)))
        return said

    return trace
