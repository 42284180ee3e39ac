"""The controller of Explore: with whose friction it succeeds, and how fast."""

import gymnasium as gym
import numpy as np
import pytest

import policies
from policies.controllers.explore import HOLD, ExploreState
from policies.controllers.no_friction_info import NoFrictionInfo
from policies.controllers.slip_memory import SlipMemory
from policies.evaluation.play import play

N = 60
DEVIATIONS = {"observation_mode": "deviations"}


def played(policy, **arguments):
    envs = gym.make_vec("slipgym:slipgym/Explore-v0", N, "vector_entry_point", **arguments)
    found = play(envs, policy, range(N))
    envs.close()
    return found


def test_friction_is_found_out_with_the_default_estimator():
    policy = policies.make("explore")
    found = played(policy, **DEVIATIONS)
    assert found.success.mean() >= 0.9
    assert not found.dropped.any()
    true = played(policy, friction_source="true", **DEVIATIONS)
    assert true.success.all()


@pytest.mark.slow
@pytest.mark.parametrize("estimator", ["adaptive", "joint"])
@pytest.mark.parametrize("level", ["easy", "standard", "hard"])
def test_friction_is_found_out_at_all_levels(level, estimator):
    found = played(policies.make("explore"), estimator=estimator, level=level, **DEVIATIONS)
    assert found.success.mean() >= 0.8
    assert not found.dropped.any()


@pytest.mark.slow
def test_sensors_alone_find_friction_out():
    assert played(SlipMemory("explore"), friction_source="none").success.mean() >= 0.9


@pytest.mark.slow
def test_the_limit_surface_of_a_disc_does_no_harm():
    assert played(policies.make("explore"), contact="disc", **DEVIATIONS).success.mean() >= 0.9


@pytest.mark.slow
def test_without_friction_nothing_is_found_out():
    assert played(NoFrictionInfo("explore"), friction_source="none").success.mean() <= 0.05
    assert played(policies.make("explore"), friction_source="nominal", **DEVIATIONS).success.mean() <= 0.05


def test_it_rests_once_it_is_sure_and_keeps_to_the_budget():
    """Without commitments the episode goes on; the object stays as it is."""
    policy, config = policies.make("explore"), {"tasks": {"explore": {"commitment": 1e-3}}}
    envs = gym.make_vec(
        "slipgym:slipgym/Explore-v0",
        N,
        config=config,
        autoreset_mode="Disabled",
        **DEVIATIONS,
    )
    observations, info = envs.reset(seed=list(range(N)))
    state, slips = None, []
    for _ in range(359):
        actions, state = policy.predict(observations, state)
        observations, _, _, _, info = envs.step(actions)
        slips.append(info["slip"].copy())
    envs.close()
    memory = ExploreState(*state[0].T)
    assert (memory.phase == HOLD).mean() >= 0.95
    moved = np.abs(np.array(slips[-60:]) - slips[-1]).max(axis=(0, 2))
    assert np.mean(moved < 1e-5) >= 0.95
    assert info["violated"].mean() <= 0.1
