"""Checkers find nothing in the batch and in its scalar twin; Gymnasium's vector wrappers work on it."""

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode
from gymnasium.wrappers import vector as wrappers

from tests.vector_checker import check_vector_env

pytestmark = pytest.mark.quick_tasks

CHECKED = zip(("LinearSlip", "PlanarSlip", "Hold"), AutoresetMode, strict=True)
"""Each mode in one task; the other cases are slow."""
FULL = {
    "observation_mode": "dict",
    "history": 1,
    "randomization": "train",
    "action_mode": "grip_force_wrist",
    "contact": "ellipsoid",
}


def test_gymnasium_checker_of_the_planar_engine(make, env_id):
    check_env(make(env_id, engine="planar", render_mode="rgb_array"))


@pytest.mark.quick_cases(*(f"slipgym/{task}-v0-{mode}" for task, mode in CHECKED))
@pytest.mark.parametrize("mode", AutoresetMode)
def test_vector_checker(env_id, mode):
    check_vector_env(
        lambda n, mode: gym.make_vec(env_id, num_envs=n, autoreset_mode=mode, frame_skip=60), modes=[mode]
    )


@pytest.mark.slow
@pytest.mark.parametrize("arguments", [{"frame_skip": 5}, {"frame_skip": 10, "threads": 2, **FULL}])
def test_vector_checker_on_long_episodes_in_all_modes(env_id, arguments):
    check_vector_env(lambda n, mode: gym.make_vec(env_id, num_envs=n, autoreset_mode=mode, **arguments))


def test_statistics_of_episodes():
    env = wrappers.RecordEpisodeStatistics(gym.make_vec("slipgym/Hold-v0", num_envs=3, frame_skip=60))
    env.reset(seed=0)
    total, lengths = np.zeros(3), np.zeros(3, dtype=int)
    for _ in range(40):
        *_, rewards, terminated, truncated, infos = env.step(np.full((3, 1), 0.5, np.float32))
        total, lengths = total + rewards, lengths + 1
        over = terminated | truncated
        if over.any():
            break
    np.testing.assert_array_equal(infos["_episode"], over)
    np.testing.assert_array_equal(infos["episode"]["l"][over], lengths[over])
    np.testing.assert_allclose(infos["episode"]["r"][over], total[over], rtol=1e-12)
    env.close()


@pytest.mark.parametrize(
    "wrap",
    [
        wrappers.NormalizeObservation,
        wrappers.NormalizeReward,
        wrappers.DictInfoToList,
        lambda env: wrappers.ClipReward(env, -0.1, 0.1),
        lambda env: wrappers.RescaleAction(env, np.float32(0.0), np.float32(2.0)),
        wrappers.FlattenObservation,
    ],
)
def test_gymnasiums_vector_wrappers(wrap):
    env = wrap(gym.make_vec("slipgym/Hold-v0", num_envs=2, frame_skip=10))
    observations, infos = env.reset(seed=0)
    for _ in range(3):
        observations, rewards, *_, infos = env.step(env.action_space.sample())
        assert env.observation_space.shape == observations.shape
        assert np.isfinite(rewards).all()
    assert len(infos) == 2 or "true" in infos
    env.close()


def test_pictures_of_chosen_rows():
    arguments = {"frame_skip": 1, "render_mode": "rgb_array"}
    env = gym.make_vec("slipgym/Hinge-v0", num_envs=4, render_rows=[2, 0], **arguments)
    env.reset(seed=5)
    one = gym.make("slipgym/Hinge-v0", engine="planar", **arguments).unwrapped
    one.reset(seed=7)
    for _ in range(4):
        env.step(np.zeros((4, 1), np.float32))
        one.step(np.zeros(1, np.float32))
    pictures = env.render()
    assert len(pictures) == 2
    np.testing.assert_array_equal(pictures[0], one.render())
    assert (pictures[0] != pictures[1]).any()
    env.close()
    one.close()


def test_no_pictures_without_a_mode_and_depths_with_theirs():
    env = gym.make_vec("slipgym/Hold-v0", num_envs=2)
    env.reset(seed=0)
    assert env.render() is None
    env.close()
    env = gym.make_vec("slipgym/Hold-v0", num_envs=2, render_mode="depth_array", render_rows=[1])
    env.reset(seed=0)
    (depth,) = env.render()
    assert depth.dtype == np.float32
    assert depth.ndim == 2
    env.close()
