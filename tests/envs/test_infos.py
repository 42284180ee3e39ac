"""Infos hold the values of the records after a reset, a step and a restore."""

import gymnasium as gym
import numpy as np
import pytest

from slipgym.envs.infos import FLAGS, NUMBERS


def records(simulation):
    """Infos of all environments, from the arrays of the simulation."""
    plant, episode = simulation.plant, simulation.episode
    return {
        "true": simulation.ground_truth[:, :3],
        "true_per_finger": episode["present_friction"],
        "estimated": simulation.estimated[:, :3],
        "estimated_per_finger": simulation.per_finger,
        "slip": plant.world["slip"],
        "slip_twist": plant.world["slip_twist"],
        "contact_wrench": plant.pads["wrench"],
        "grip_force": plant.fingers["force"],
        "reference": episode["reference"],
        "time": episode["step"] * simulation.step_time,
        "is_success": episode["success"] != 0,
        "dropped": episode["dropped"] != 0,
        "violated": episode["violated"] != 0,
        "finished": episode["step"] >= episode["steps"],
    }


def check(simulation, infos):
    """Compare the infos of one environment or of all with the arrays of the simulation."""
    wanted, episode = records(simulation), simulation.episode
    assert {info.name for info in (*NUMBERS, *FLAGS)} == set(wanted)
    pairs = [(name, infos[name], values) for name, values in wanted.items()]
    for k, name in enumerate(simulation.task.term_names):
        values = episode["terms"][:, k] * (episode["step"] > 0)  # of no step after a reset
        pairs.append((f"reward_terms.{name}", infos["reward_terms"][name], values))
    for name, given, values in pairs:
        found = np.asarray(given)
        np.testing.assert_array_equal(found, values.reshape(found.shape), err_msg=name)
        assert found.dtype == values.dtype, name


@pytest.mark.parametrize("engine", ["bullet", "planar"])
def test_of_one_environment(make, env_id, engine):
    env, other = make(env_id, engine=engine), make(env_id, engine=engine)
    _, info = env.reset(seed=0)
    other.reset(seed=1)
    check(env.simulation, info)
    kept = info["grip_force"].copy()
    for k in range(5):
        _, _, _, _, later = env.step(np.array([-0.99 + 0.1 * k], dtype=np.float32))
        check(env.simulation, later)
    np.testing.assert_array_equal(info["grip_force"], kept)
    assert not np.array_equal(later["grip_force"], kept)
    other.set_state(env.get_state())
    restored, *_ = other._report()
    for name, values in later.items():
        if name != "reward_terms":  # of a step that another environment made
            np.testing.assert_array_equal(restored[name], values, err_msg=name)


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_of_a_batch(mode):
    envs = gym.make_vec("slipgym/Hold-v0", num_envs=5, autoreset_mode=mode).unwrapped
    _, infos = envs.reset(seed=0, options={"rows": [{"duration": 0.1}] + [None] * 4})
    check(envs.simulation, infos)
    begun = False
    for _ in range(40):
        kept = infos["slip"].copy(), infos["reward_terms"]["effort"].copy()
        _, _, _, _, later = envs.step(np.full((5, 1), -0.9, dtype=np.float32))
        check(envs.simulation, later)
        np.testing.assert_array_equal(infos["slip"], kept[0])
        np.testing.assert_array_equal(infos["reward_terms"]["effort"], kept[1])
        begun |= later["time"][0] < later["time"][1]
        infos = later
    assert begun
    envs.close()
