"""`end_at_violation`, `load_columns` and the privileged group: both engines, one environment and many."""

import gymnasium as gym
import numpy as np
import pytest

import slipgym  # noqa: F401
from slipgym.envs.load_part import LOAD

ENGINES = pytest.mark.parametrize("engine", ["planar", "bullet"])
FRAGILE = "slipgym/FragileHold-v0"


def privileged(env, observation):
    """Name -> value of the privileged group."""
    names = (column.name for column in env.unwrapped.privileged_columns)
    return dict(zip(names, observation["privileged"].tolist(), strict=True))


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


@pytest.mark.quick_cases("planar")
@ENGINES
def test_the_privileged_group_holds_what_an_episode_drew(engine):
    arguments = {"observation_mode": "dict", "randomization": "lab", "sensors": "lab", "level": "hard"}
    env = gym.make("slipgym/Carry-v0", engine=engine, disable_env_checker=True, **arguments)
    _, info = env.reset(seed=0)
    drawn, forces, allowed = info["drawn"], [], 0.0
    for _ in range(60):
        observation, *_, info = env.step(np.float32([-0.6]))
        forces.append(info["grip_force"].mean())
        allowed = info["reference"][0] * env.unwrapped.simulation.episode["steps"][0]
    truth = privileged(env, observation)
    shared = "load_exponent", "radius_exponent", "cop_lever", "shear_compliance", "creep", "aging"
    own = "finger_radius", "force_gain"
    for name in (*shared, "stribeck_velocity", "sigma_0", "friction_drift"):
        assert truth[name] == pytest.approx(drawn[name], rel=1e-5, abs=1e-9), name
    assert truth["friction_axis_x"] == pytest.approx(1.0 + drawn["anisotropy"])
    assert truth["dead_time"] == pytest.approx(drawn["dead_time"], abs=1e-3)
    ratio = drawn["finger_radius_1"] / drawn["finger_radius_2"]
    assert truth["r_1"] / truth["r_2"] == pytest.approx(ratio, rel=1e-5)
    for f in "12":
        assert truth[f"force_gain_{f}"] == pytest.approx(drawn[f"{own[1]}_{f}"])
        assert truth[f"cop_x_{f}"] == pytest.approx(drawn[f"cop_offset_x_{f}"], rel=1e-5)
        assert truth[f"lag_{f}"] == pytest.approx(drawn["lag"] * drawn[f"finger_lag_{f}"], rel=1e-5)
    assert truth["grip_limit"] == pytest.approx(info["reference"][0])
    assert truth["least_grip"] == pytest.approx(info["reference"][2])
    assert truth["grip_spent"] == pytest.approx(sum(forces) / allowed, rel=1e-5)
    assert 0.0 < truth["least_grip_now"] <= 1.1 * truth["least_grip"]
    assert truth["jump_time"] == 0.0
    env.close()


def test_the_privileged_group_names_the_time_of_a_jump_and_the_largest_slip():
    jump = {"kind": "friction_jump", "time": {"choices": [2.0]}, "factor": {"choices": [0.7]}}
    jump["probability"] = 1.0
    arguments = {"randomization": {"disturbances": [jump]}, "observation_mode": "dict"}
    env = gym.make("slipgym/Hold-v0", engine="planar", disable_env_checker=True, **arguments)
    observation, _ = env.reset(seed=0)
    truth = privileged(env, observation)
    assert truth["jump_time"] == pytest.approx(2.0, abs=0.01)
    assert truth["jump_factor"] == pytest.approx(0.7)
    assert truth["least_grip"] == truth["grip_spent"] == 0.0  # without grip_limit
    largest = 0.0
    for _ in range(60):
        observation, *_, info = env.step(np.float32([-1.0]))
        largest = max(largest, np.hypot(*info["slip"][:2]))
    assert largest > 0.0
    assert privileged(env, observation)["largest_slip"] == pytest.approx(min(largest, 1.0))
    env.close()
