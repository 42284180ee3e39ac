"""Infos of a vector environment hold for all environments, those of a reset for the ones that were reset."""

import gymnasium as gym
import numpy as np

import slipgym  # noqa: F401


def make(**keywords):
    return gym.make_vec("slipgym/LinearSlip-v0", 3, "vector_entry_point", threads=1, **keywords)


def test_of_a_reset_only_of_those_that_were_reset():
    envs = make(autoreset_mode="Disabled")
    envs.reset(seed=0)
    mask = np.array([False, True, False])
    _, infos = envs.reset(options={"reset_mask": mask})
    np.testing.assert_array_equal(infos["_grip_force"], mask)
    np.testing.assert_array_equal(infos["reward_terms"]["_effort"], mask)
    assert infos["grip_force"][1].all()
    assert not infos["grip_force"][~mask].any()
    envs.close()
