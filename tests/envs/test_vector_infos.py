"""Infos of a vector environment hold for all environments; the former argument that chose some only warns."""

import gymnasium as gym
import numpy as np
import pytest

import slipgym  # noqa: F401


def make(**keywords):
    return gym.make_vec("slipgym/LinearSlip-v0", 3, "vector_entry_point", threads=1, **keywords)


@pytest.mark.parametrize("value", ["all", "ends"])
def test_the_former_argument_warns_and_changes_nothing(value):
    with pytest.warns(DeprecationWarning, match="infos is gone"):
        envs = make(infos=value)
    other = make()
    actions = np.full((3, 1), -0.9, dtype=np.float32)
    for each in (envs, other):
        each.reset(seed=0)
    mine, wanted = envs.step(actions)[4], other.step(actions)[4]
    assert mine.keys() == wanted.keys()
    np.testing.assert_array_equal(mine["slip"], wanted["slip"])
    assert mine["_slip"].all()
    envs.close()
    other.close()


def test_an_unknown_choice_is_refused():
    with pytest.raises(ValueError, match=r"infos.*'some'.*all, ends"):
        make(infos="some")


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
