"""On a pad that shears, an object swings after every slip; "adaptive" does not take that for slip."""

import gymnasium as gym
import numpy as np
import pytest

import policies


@pytest.mark.parametrize("compliance", [1e-4, 2e-4])
def test_swinging_after_a_slip_is_no_slip(compliance):
    n, policy = 8, policies.make("linear_slip")
    pad = {"shear_compliance": compliance}
    env = gym.make_vec("slipgym:slipgym/LinearSlip-v0", num_envs=n, config={"contact": {"pad": pad}})
    observations, _ = env.reset(seed=5, options={"duration": 2.0})
    state, starts, error = None, np.ones(n, bool), np.full(n, np.nan)
    while np.isnan(error).any():
        actions, state = policy.predict(observations, state=state, episode_start=starts)
        observations, _, terminated, truncated, infos = env.step(actions)
        starts = terminated | truncated
        ended = infos["estimated"][:, 1] / infos["true"][:, 1] - 1.0  # (mu_s, mu_c, r)
        error = np.where(np.isnan(error) & starts, ended, error)
    env.close()
    # a swing reads a force between zero and the limit; one sample in five would be a tenth
    assert np.median(abs(error)) < 0.1
