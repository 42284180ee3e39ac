"""What infos tell is what the records hold, after a reset, a step and a restore."""

import gymnasium as gym
import numpy as np
import pytest

from slipgym.envs.told import SHAPES, field


def check(loop):
    """Compare all that is told with the arrays it is told from."""
    plant, episode = loop.plant, loop.episode
    records = {
        "true": loop.truth[:, :3],
        "estimated": loop.estimated[:, :3],
        "estimated_per_finger": loop.per_finger,
        "slip": plant.world["slip"],
        "slip_twist": plant.world["slip_twist"],
        "contact_wrench": plant.pads["wrench"],
        "grip_force": plant.fingers["force"],
        "reference": episode["reference"],
        "is_success": episode["success"],
        "dropped": episode["dropped"],
        "time": episode["step"] * loop.step_time,
    }
    assert set(records) == set(SHAPES)
    for name, values in records.items():
        np.testing.assert_array_equal(field(loop.told, name), values, err_msg=name)


@pytest.mark.parametrize("engine", ["bullet", "planar"])
def test_of_one_environment(make, env_id, engine):
    env, other = make(env_id, engine=engine), make(env_id, engine=engine)
    _, info = env.reset(seed=0)
    other.reset(seed=1)
    check(env._loop)
    kept = info["grip_force"].copy()
    for k in range(5):
        _, _, _, _, later = env.step(np.array([-0.99 + 0.1 * k], dtype=np.float32))
        check(env._loop)
    np.testing.assert_array_equal(info["grip_force"], kept)
    assert not np.array_equal(later["grip_force"], kept)
    other.set_state(env.get_state())
    check(other._loop)


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_of_a_batch(mode):
    envs = gym.make_vec("slipgym/Hold-v0", num_envs=5, autoreset_mode=mode).unwrapped
    envs.reset(seed=0, options={"rows": [{"duration": 0.1}] + [None] * 4})
    check(envs._loop)
    begun = False
    for _ in range(40):
        _, _, _, _, infos = envs.step(np.full((5, 1), -0.9, dtype=np.float32))
        check(envs._loop)
        np.testing.assert_array_equal(infos["slip"], field(envs._loop.told, "slip"))
        begun |= infos["time"][0] < infos["time"][1]
    assert begun
    envs.close()
