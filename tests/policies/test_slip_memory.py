"""Controllers that remember the last slip."""

import gymnasium as gym
import numpy as np
import pytest

from policies.controllers.no_friction_info import NoFrictionInfo
from policies.controllers.rotational_slip import RotationalSlipPolicy
from policies.controllers.slip_memory import SlipMemory, combined, weight_of
from policies.evaluation.play import play

HARD = {"level": "hard", "friction_source": "none"}


def played(task, policy, n=40):
    envs = gym.make_vec(f"slipgym:slipgym/{task}-v0", n, "vector_entry_point", **HARD, **policy.modes)
    found = play(envs, policy, range(n))
    envs.close()
    return found


def test_load_over_normal_force_in_a_slip_is_remembered():
    policy = SlipMemory("hold")
    index = policy._controller.index
    width = gym.make("slipgym:slipgym/Hold-v0", engine="planar", **HARD).observation_space.shape[0]
    seen = np.zeros((1, width), np.float32)
    for f in (1, 2):
        seen[0, index[f"f_y_{f}"]], seen[0, index[f"f_n_{f}"]] = 2.0, 5.0
    _, (_, at_rest) = policy.predict(seen)
    assert at_rest[0, 0] == 0.0
    for f in (1, 2):
        seen[0, index[f"v_y_{f}"]] = -0.01
    _, state = policy.predict(seen)
    assert state[1][0, 0] == pytest.approx(0.4)
    seen[0, index["v_y_1"]] = seen[0, index["v_y_2"]] = 0.0
    action, state = policy.predict(seen, state)
    assert state[1][0, 0] == pytest.approx(0.4)
    assert action.shape == (1, 1)
    assert policy.predict(seen[0], state)[0].shape == (1,)
    _, (_, begun) = policy.predict(seen, state, np.array([True]))
    assert begun[0, 0] == 0.0


def test_it_needs_a_controller_that_reads_friction():
    with pytest.raises(ValueError, match="constant_force"):
        SlipMemory("constant_force")
    with pytest.raises(ValueError, match="speed"):
        SlipMemory("hold", speed=-1.0)


def test_an_estimate_and_the_last_slip_count_by_their_variances():
    shown, deviation = np.array([0.0, 0.4, 0.4, 0.4]), np.array([0.1, 0.0, 0.02, 1e6])
    weight = weight_of(shown, deviation, 0.02)
    np.testing.assert_allclose(weight, [0.0, 0.0, 0.5, 1.0], atol=1e-9)
    mixed = combined(np.full(4, 0.9), shown, weight)
    np.testing.assert_allclose(mixed, [0.9, 0.9, 0.6, 0.4])


def test_known_friction_is_acted_on_as_it_is():
    """With the true friction, which has no deviation, the last slip does not count."""
    found = []
    for shown in (0.0, 0.02):
        policy = RotationalSlipPolicy(shown=shown)
        envs = gym.make_vec(
            "slipgym:slipgym/RotationalSlip-v0",
            4,
            "vector_entry_point",
            friction_source="true",
            **policy.modes,
        )
        found.append(play(envs, policy, range(4)))
        envs.close()
    np.testing.assert_array_equal(found[0].reward, found[1].reward)


@pytest.mark.slow
def test_with_the_estimate_no_less_is_solved_than_with_the_memory():
    policy = RotationalSlipPolicy()
    arguments = {**HARD, **policy.modes, "friction_source": "estimated"}
    envs = gym.make_vec("slipgym:slipgym/RotationalSlip-v0", 40, "vector_entry_point", **arguments)
    found = play(envs, policy, range(40))
    envs.close()
    assert found.success.mean() >= played("RotationalSlip", SlipMemory("rotational_slip")).success.mean()


@pytest.mark.slow
@pytest.mark.parametrize(("task", "least"), [("RotationalSlip", 0.9), ("FragileHold", 0.7), ("Carry", 0.7)])
def test_a_memory_of_slips_is_worth_more_than_a_guess(task, least):
    key = {"RotationalSlip": "rotational_slip", "FragileHold": "fragile_hold", "Carry": "carry"}[task]
    assert played(task, SlipMemory(key)).success.mean() >= least
    assert played(task, NoFrictionInfo(key)).success.mean() <= least - 0.3
