"""The value of a task's own end is 0; after a user's limit the episode goes on for the critic."""

import runpy
import sys
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest

pytest.importorskip("stable_baselines3")
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import DummyVecEnv

import policies
from policies.training import vector
from policies.training.adapter import TaskEnd

SHORT = {"config": {"tasks": {"linear_slip": {"duration": 0.2, "settle": 0.1, "hold": 0.1}}}}
EXAMPLE = Path(__file__).parents[3] / "examples" / "libraries" / "ppo.py"
VALUE, GAMMA, STEPS = 5.0, 0.9, 64
"""What the critic says of every state; the task has 48 steps."""


def batch(**limit):
    return policies.make_vec_env("slipgym/LinearSlip-v0", 2, threads=1, **SHORT, **limit)


def scalar(**limit):
    keywords = {"engine": "planar", "disable_env_checker": True, **SHORT, **limit}
    return DummyVecEnv([lambda: TaskEnd(gym.make("slipgym/LinearSlip-v0", **keywords))] * 2)


def trained(**limit):
    """The environments of a run; it has none but the task's own end."""
    return vector.scalar("linear_slip", 2, [{}], False, engine="planar", **SHORT)


@pytest.mark.parametrize(
    ("make", "limit"), [(batch, None), (batch, 20), (scalar, None), (scalar, 20), (trained, None)]
)
def test_stable_baselines_adds_a_value_after_a_users_limit_alone(make, limit):
    envs = make(**{"max_episode_steps": limit} if limit else {})
    rewards, ends = [], []
    model = PPO("MlpPolicy", envs, n_steps=STEPS, batch_size=STEPS, gamma=GAMMA, gae_lambda=0.0, seed=0)
    with torch.no_grad():
        model.policy.value_net.weight.zero_()
        model.policy.value_net.bias.fill_(VALUE)
    step_wait = envs.step_wait

    def noted():
        returned = step_wait()
        rewards.append(returned[1].copy())
        ends.append(returned[2].copy())
        return returned

    envs.step_wait, model.train = noted, lambda: None
    model.learn(1)
    rewards, ends = np.array(rewards), np.array(ends)
    targets = model.rollout_buffer.returns
    assert ends.any()
    value = GAMMA * VALUE if limit else 0.0
    np.testing.assert_allclose(targets[ends], rewards[ends] + value, atol=1e-5)
    np.testing.assert_allclose(targets[~ends], rewards[~ends] + GAMMA * VALUE, atol=1e-5)
    envs.close()


@pytest.mark.parametrize("limit", [None, 8])
def test_the_single_file_does_so_too(limit, monkeypatch):
    made = gym.make_vec
    limits = {"max_episode_steps": limit} if limit else {}
    monkeypatch.setattr(gym, "make_vec", lambda name, **given: made(name, **given | SHORT | limits))
    monkeypatch.setattr(sys, "argv", ["ppo.py", "8192"])
    threads = torch.get_num_threads()
    found = runpy.run_path(str(EXAMPLE))["data"]
    torch.set_num_threads(threads)
    at_ends = found["next"][found["ended"]]
    assert len(at_ends)
    valued = (at_ends != 0.0).float().mean().item()
    assert valued > 0.5 if limit else valued == 0.0  # some drop the box before
