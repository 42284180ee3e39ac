"""The wrappers that everyone uses."""

from functools import partial

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.vector import AsyncVectorEnv, SyncVectorEnv
from gymnasium.wrappers import RecordEpisodeStatistics, RecordVideo

from slipgym.registration import ENVIRONMENTS

IDS = tuple(ENVIRONMENTS)


def actions(steps: int, envs: int) -> np.ndarray:
    return np.random.default_rng(0).uniform(-0.5, 1.0, (steps, envs, 1)).astype(np.float32)


@pytest.mark.parametrize(
    ("vector", "env_id"),
    [(SyncVectorEnv, name) for name in IDS]
    + [pytest.param(partial(AsyncVectorEnv, context="spawn"), IDS[0], marks=pytest.mark.slow)],
)
def test_vector_environments_equal_single_ones(make, env_id, vector):
    envs = vector([partial(gym.make, f"slipgym:{env_id}", action_mode="grip_force") for _ in range(2)])
    singles = [make(env_id) for _ in range(2)]
    options = {"duration": 1.0}
    observations, _ = envs.reset(seed=[3, 4], options=options)
    alone = [env.reset(seed=seed, options=options)[0] for env, seed in zip(singles, (3, 4), strict=True)]
    np.testing.assert_array_equal(observations, alone)
    for action in actions(40, 2):
        observations, rewards, _, _, infos = envs.step(action)
        results = [env.step(a) for env, a in zip(singles, action, strict=True)]
        np.testing.assert_array_equal(observations, [result[0] for result in results])
        np.testing.assert_array_equal(rewards, [result[1] for result in results])
        np.testing.assert_array_equal(infos["slip"], [result[4]["slip"] for result in results])
    envs.close()


def test_vector_environments_go_on_after_an_episode(env_id):
    envs = SyncVectorEnv([partial(gym.make, env_id, action_mode="grip_force")] * 2)
    envs.reset(seed=0, options={"duration": 0.5})
    ended = np.zeros(2, dtype=int)
    for _ in range(300):
        observations, _, terminated, truncated, _ = envs.step(np.full((2, 1), 1.0, np.float32))
        ended += terminated | truncated
        assert np.isfinite(observations).all()
    assert (ended >= 1).all()
    envs.close()


def test_episode_statistics(env_id):
    env = RecordEpisodeStatistics(gym.make(env_id, action_mode="grip_force"))
    env.reset(seed=0, options={"duration": 0.5})
    total, over = 0.0, False
    while not over:
        _, reward, terminated, truncated, info = env.step(np.float32([0.3]))
        total, over = total + reward, terminated or truncated
    assert info["episode"]["r"] == pytest.approx(total)
    assert info["episode"]["l"] == round(info["time"] * 120)
    env.close()


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
@pytest.mark.quick_cases("slipgym/LinearSlip-v0")
def test_record_video_writes_a_film(env_id, tmp_path):
    pytest.importorskip("moviepy")
    bare = gym.make(env_id, render_mode="rgb_array", frame_skip=4, action_mode="grip_force")
    env = RecordVideo(bare, str(tmp_path / "films"), disable_logger=True)
    assert env.metadata["render_fps"] == 30
    env.reset(seed=0, options={"duration": 0.5})
    over = False
    while not over:
        _, _, terminated, truncated, _ = env.step(np.float32([0.3]))
        over = terminated or truncated
    env.close()
    (film,) = tmp_path.glob("films/*.mp4")
    assert film.stat().st_size > 1000
