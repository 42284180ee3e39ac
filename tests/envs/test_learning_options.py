"""`end_at_violation` and `load_columns`: both engines, one environment and many."""

import gymnasium as gym
import numpy as np
import pytest

import slipgym  # noqa: F401
from slipgym.envs.observation import LOAD

ENGINES = pytest.mark.parametrize("engine", ["planar", "bullet"])
FRAGILE = "slipgym/FragileHold-v0"


@ENGINES
@pytest.mark.parametrize("skip", [1, 4])
def test_an_episode_ends_where_success_is_lost(engine, skip):
    arguments = {"engine": engine, "frame_skip": skip, "disable_env_checker": True}
    plain, cut = gym.make(FRAGILE, **arguments), gym.make(FRAGILE, end_at_violation=True, **arguments)
    (seen, _), (same, _) = plain.reset(seed=0), cut.reset(seed=0)
    violated = over = False
    while not over:
        seen, reward, terminated, truncated, info = plain.step(np.float32([1.0]))  # breaks the object
        same, paid, over, late, told = cut.step(np.float32([1.0]))
        assert not terminated
        assert not truncated
        assert not late
        violated = info["violated"]
        assert over == violated == told["violated"]
        assert not told["finished"]
        if skip == 1:
            assert paid == reward
            np.testing.assert_array_equal(same, seen)
    assert told["reward_terms"]["violated"] == -2.0
    assert not told["is_success"]
    assert told["time"] <= info["time"]
    plain.close()
    cut.close()


def test_episodes_of_a_batch_end_there_too():
    envs = gym.make_vec(FRAGILE, 3, end_at_violation=True, autoreset_mode="SameStep")
    envs.reset(seed=0)
    ended = np.zeros(3, bool)
    for _ in range(200):
        *_, terminated, truncated, infos = envs.step(np.tile(np.float32([1.0]), (3, 1)))
        assert not truncated.any()
        if terminated.any():
            assert infos["final_info"]["violated"][terminated].all()
            assert infos["final_info"]["time"][terminated].max() < 2.0
        ended |= terminated
    assert ended.all()
    envs.close()


@ENGINES
def test_the_load_part_follows_from_the_sensors(engine):
    env = gym.make(FRAGILE, engine=engine, load_columns=True, history=1, disable_env_checker=True)
    names = [column.name for column in env.unwrapped.columns]
    assert names[-len(LOAD) :] == [reading.name for reading in LOAD]
    env.reset(seed=0)
    for k in range(120):
        observation, *_ = env.step(np.float32([-0.9 + 0.005 * k]))
        seen = dict(zip(names, observation[-len(names) :].astype(float).tolist(), strict=True))
        assert env.observation_space.contains(observation)
        assert seen["ln_grip"] == pytest.approx(np.log(seen["commanded_force"]), abs=1e-5)
        for f in "12":
            load, normal = np.hypot(seen[f"f_x_{f}"], seen[f"f_y_{f}"]), max(seen[f"f_n_{f}"], 0.1)
            assert seen[f"ln_load_{f}"] == pytest.approx(np.log(max(load, 0.01)), abs=1e-4)
            assert seen[f"load_ratio_{f}"] == pytest.approx(load / normal, rel=1e-4)
            torque = seen[f"tau_{f}"] / (normal * env.unwrapped.config.gripper.pad_radius)
            assert seen[f"torque_ratio_{f}"] == pytest.approx(torque, rel=1e-3, abs=1e-6)
    env.close()
