"""Learned policies meet environments, by path, by name and in experiments."""

import gymnasium as gym
import numpy as np
import pytest

import policies
import slipgym  # noqa: F401
from policies.learned import LearnedPolicy, shelf


def refused(policy, message, task="Hold", **arguments):
    env = gym.make(f"slipgym/{task}-v0", **arguments)
    try:
        with pytest.raises(ValueError, match=message):
            policy.check(env)
    finally:
        env.close()


def test_an_environment_that_means_something_else_is_refused(policy_folder):
    policy = LearnedPolicy(policy_folder())
    refused(policy, r"column 22, 'mu_s' .* in training, is missing here", friction_source="none")
    refused(policy, r"another observation: column 18 is 'reference_position'", task="LinearSlip")
    refused(policy, r"another action: column 0 is 'force_increment'", action_mode="force_increment")
    refused(policy, r"another observation: column 22 is 'wrist_pitch'", action_mode="grip_force_wrist")
    refused(policy, r"history=0: 28 numbers; .* has 84", history=2)
    refused(policy, r"120 steps per second, here are 60", frame_skip=2)
    wider = {"gripper": {"force_max": 30.0}}
    refused(
        policy, r"\(0\.6 to 30, \[N\]\) here, 'grip_force' \(0\.6 to 25, \[N\]\) in training", config=wider
    )


@pytest.mark.parametrize("arguments", [{}, {"friction_source": "true"}, {"observation_mode": "dict"}])
def test_an_environment_with_the_same_columns_fits(policy_folder, arguments):
    policy = LearnedPolicy(policy_folder())
    env = gym.make("slipgym/Hold-v0", **arguments)
    policy.check(env)
    observation, _ = env.reset(seed=0)
    env.step(policy.predict(observation)[0])
    env.close()


def test_by_path_and_by_name_it_is_the_same(policy_folder, tmp_path, monkeypatch):
    before = policies.names()
    folder = policy_folder("shelf/hold_ppo")
    monkeypatch.setattr(shelf, "SHELF", tmp_path / "shelf")
    assert set(policies.names()) == {*before, "hold_ppo"}
    observation = np.linspace(-1.0, 1.0, 28, dtype=np.float32)
    wanted, _ = policies.load(folder).predict(observation)
    for policy in (policies.make("hold_ppo"), policies.load("hold_ppo"), policies.load(str(folder))):
        np.testing.assert_array_equal(policy.predict(observation)[0], wanted)
    with pytest.raises(ValueError, match=r"'hold_ppi'.*hold_ppo"):
        policies.make("hold_ppi")
    for which in ("hold_ppo", folder):
        with pytest.raises(ValueError, match=r"unknown parameter 'force'.*none, it is learned"):
            policies.load(which, force=1.0)


def test_load_knows_the_controllers_too():
    assert policies.load("constant_force", force=3.0).force == 3.0


def test_no_shipped_policy_takes_a_controllers_name():
    from policies.registry import _CLASSES

    assert not set(shelf.shipped()) & set(_CLASSES)
