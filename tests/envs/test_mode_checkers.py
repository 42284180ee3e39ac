"""Every environment in every pair of modes: checkers, wrappers, processes."""

from functools import partial
from itertools import cycle, product

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AsyncVectorEnv, SyncVectorEnv
from gymnasium.wrappers import FrameStackObservation, RecordEpisodeStatistics

from slipgym.envs.actions import ACTION_MODES
from slipgym.envs.arguments import OBSERVATION_MODES

pytestmark = pytest.mark.quick_tasks

PAIRS = tuple(product(ACTION_MODES, OBSERVATION_MODES))
QUICK = [
    f"slipgym/{task}-v0-{action}-{observation}"
    for task in ("LinearSlip", "PlanarSlip", "Hold")
    for action, observation in zip(ACTION_MODES, cycle(OBSERVATION_MODES))
]
"""Every mode in three tasks; the other pairs are slow."""
FULL = {"action_mode": "grip_force_wrist", "observation_mode": "dict", "history": 2}


@pytest.mark.quick_cases(*QUICK)
@pytest.mark.parametrize(("action_mode", "observation_mode"), PAIRS)
def test_gymnasium_checker(make, env_id, action_mode, observation_mode):
    check_env(make(env_id, action_mode=action_mode, observation_mode=observation_mode, history=1))


@pytest.mark.quick_cases(*(each for each in QUICK if "LinearSlip" in each))
@pytest.mark.parametrize(("action_mode", "observation_mode"), PAIRS)
def test_stable_baselines_checker(make, env_id, action_mode, observation_mode):
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    env = make(env_id, action_mode=action_mode, observation_mode=observation_mode, history=1)
    checker.check_env(env, warn=True)


VECTORS = {
    "sync": SyncVectorEnv,
    "spawn": partial(AsyncVectorEnv, context="spawn"),
    "forkserver": partial(AsyncVectorEnv, context="forkserver"),
}


@pytest.mark.parametrize("vector", VECTORS.values(), ids=VECTORS)
@pytest.mark.quick_cases("forkserver")
def test_vector_environments_equal_single_ones(make, vector):
    env_id = "slipgym/Hinge-v0"
    envs = vector([partial(gym.make, f"slipgym:{env_id}", **FULL) for _ in range(2)])
    single = make(env_id, **FULL)
    observations, _ = envs.reset(seed=[3, 4])
    alone, _ = single.reset(seed=4)
    for action in np.random.default_rng(0).uniform(-1.0, 1.0, (5, 2, 4)).astype(np.float32):
        for group, values in alone.items():
            np.testing.assert_array_equal(observations[group][1], values)
        observations = envs.step(action)[0]
        alone = single.step(action[1])[0]
    envs.close()


@pytest.mark.parametrize("observation_mode", OBSERVATION_MODES)
def test_wrappers(env_id, observation_mode):
    arguments = {**FULL, "observation_mode": observation_mode}
    env = FrameStackObservation(RecordEpisodeStatistics(gym.make(env_id, **arguments)), 3)
    observation, _ = env.reset(seed=0, options={"duration": 0.5})
    over = False
    while not over:
        assert env.observation_space.contains(observation)
        observation, _, terminated, truncated, info = env.step(np.float32([1.0, 0.1, -0.1, 0.2]))
        over = terminated or truncated
    assert info["episode"]["l"] == round(info["time"] * 120)
    env.close()


def test_spec_survives_json(env_id):
    env = gym.make(env_id, **FULL)
    again = gym.make(gym.envs.registration.EnvSpec.from_json(env.spec.to_json()))
    assert again.spec.kwargs == FULL
    assert again.observation_space == env.observation_space
    assert again.action_space == env.action_space
    env.close()
    again.close()
