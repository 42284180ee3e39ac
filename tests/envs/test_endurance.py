"""A million random steps: nothing breaks, nothing leaks."""

import gymnasium as gym
import numpy as np
import psutil
import pytest

from slipgym.registration import ENVIRONMENTS

STEPS = 1_000_000
CHECKS = 20


def play(step, steps: int) -> list[float]:
    """Resident memory [MiB] at `CHECKS` times of so many steps."""
    process, memory = psutil.Process(), []
    for k in range(steps):
        step()
        if (k + 1) % (steps // CHECKS) == 0:
            memory.append(process.memory_info().rss / 2**20)
    return memory


def assert_flat(memory: list[float]) -> None:
    """Of a leak of 100 bytes a step, 10 MiB would show in the second half of each task's share."""
    assert max(memory[CHECKS // 2 :]) - memory[CHECKS // 2] < 5.0, memory


@pytest.mark.slow
@pytest.mark.parametrize("env_id", ENVIRONMENTS)
def test_random_actions_with_everything_drawn(env_id):
    env = gym.make(env_id, randomization="eval_ood", action_mode="grip_force_wrist", disable_env_checker=True)
    env.action_space.seed(0)
    env.reset(seed=0)

    def step():
        observation, reward, terminated, truncated, _ = env.step(env.action_space.sample())
        assert np.isfinite(reward)
        assert np.isfinite(observation).all()
        if terminated or truncated:
            env.reset()

    try:
        assert_flat(play(step, STEPS // len(ENVIRONMENTS)))
    finally:
        env.close()


@pytest.mark.slow
@pytest.mark.parametrize("env_id", ENVIRONMENTS)
def test_a_batch_too(env_id):
    n = 100
    env = gym.make_vec(env_id, num_envs=n, randomization="eval_ood", action_mode="grip_force_wrist")
    env.reset(seed=0)
    rng = np.random.default_rng(0)

    def step():
        actions = rng.uniform(-1.0, 1.0, env.action_space.shape).astype(np.float32)
        observations, rewards, *_ = env.step(actions)
        assert np.isfinite(rewards).all()
        assert np.isfinite(observations).all()

    try:
        assert_flat(play(step, STEPS // n))
    finally:
        env.close()
