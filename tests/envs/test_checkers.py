"""Gymnasium's and Stable-Baselines3's checkers find nothing; warnings are errors here."""

import json
import math

import gymnasium as gym
import pytest
from gymnasium.utils.env_checker import check_env

from slipgym.registration import ENVIRONMENTS

SOURCES = ("estimated", "true", "nominal", "none")


@pytest.mark.quick_tasks
@pytest.mark.parametrize("source", SOURCES)
def test_gymnasium_checker(env_id, source):
    env = gym.make(env_id, friction_source=source, render_mode="rgb_array")
    check_env(env.unwrapped)
    env.close()


@pytest.mark.quick_cases("slipgym/LinearSlip-v0-estimated", "slipgym/Hold-v0-none")
@pytest.mark.parametrize("source", SOURCES)
def test_stable_baselines_checker(make, env_id, source):
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    checker.check_env(make(env_id, friction_source=source, render_mode="rgb_array"), warn=True)


def test_spec_survives_json(env_id):
    arguments = {
        "friction_source": "true",
        "estimator": {"name": "rls", "heuristic": False},
        "sensors": "ideal",
        "frame_skip": 2,
        "config": {"object": {"mass": 0.3, "size": [0.06, 0.02, 0.1]}},
    }
    env = gym.make(env_id, **arguments)
    text = env.spec.to_json()
    again = gym.make(gym.envs.registration.EnvSpec.from_json(text))
    assert again.spec.kwargs == arguments
    assert json.loads(again.spec.to_json()) == json.loads(text)
    assert again.unwrapped.config.object.mass == 0.3
    env.close()
    again.close()


def test_make_needs_no_import(python):
    printed = python(
        "-c",
        f"import gymnasium as gym\nfor name in {list(ENVIRONMENTS)}:\n"
        "    env = gym.make(f'slipgym:{name}')\n    env.reset(seed=0)\n"
        "    print(env.step(env.action_space.sample())[1])\n    env.close()",
    )
    rewards = [float(line) for line in printed.splitlines()]
    assert len(rewards) == len(ENVIRONMENTS)
    assert all(math.isfinite(reward) for reward in rewards)
