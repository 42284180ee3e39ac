"""FragileHold: the rehearsal of an episode's load, the support, breakage, and friction from a range."""

import gymnasium as gym
import numpy as np
import pytest

import slipgym  # noqa: F401
from slipgym.tasks import TASKS
from slipgym.tasks.carrying import ACCELERATION, VELOCITY, move_time, planned_velocity

ID = "slipgym/FragileHold-v0"
FULL = np.float32([1.0])


def needed(info):
    """Least grip for the present load of both pads, (n,) [N]."""
    f_x, f_y, tau = info["contact_wrench"].mean(axis=1).T
    mu_s, _, r = info["true"].T
    return np.sqrt(f_x**2 + f_y**2 + (tau / r) ** 2) / mu_s


@pytest.fixture
def envs():
    made = gym.make_vec(ID, 12, friction_source="true", autoreset_mode="Disabled")
    yield made
    made.close()


def test_the_rehearsal_finds_the_peak_load_of_a_firm_grip(envs):
    _, info = envs.reset(seed=0)
    peak = np.zeros(12)
    for _ in range(600):
        *_, info = envs.step(np.tile(FULL, (12, 1)))
        peak = np.maximum(peak, needed(info))
    np.testing.assert_allclose(info["reference"][:, 1], peak, rtol=1e-4)
    assert not info["is_success"].any()  # 25 N break every one


def test_the_support_bears_the_weight_and_gives_way(envs):
    _, info = envs.reset(seed=0)
    np.testing.assert_allclose(info["contact_wrench"], 0.0, atol=1e-9)
    loads = []
    for _ in range(150):
        *_, info = envs.step(np.tile(FULL, (12, 1)))
        loads.append(info["contact_wrench"][:, :, 1].sum(axis=1))
    weight = loads[144 - 1]  # the support has just gone, the wrist has not moved yet
    np.testing.assert_allclose(loads[47], 0.0, atol=1e-9)
    np.testing.assert_allclose(loads[48 + 48], 0.5 * weight, rtol=2e-2)
    assert (weight > 0.2 * 9.81 * 0.99).all()
    assert (weight < 0.5 * 9.81 * 1.01).all()


@pytest.mark.parametrize(("place", "solved"), [(0.9, False), (1.1, True), (1.4, True), (1.6, False)])
def test_a_constant_grip_succeeds_between_least_and_breaking_force(envs, place, solved):
    _, info = envs.reset(seed=0, options={"allowance": 1.5})
    force = place * info["reference"][:, 1]
    np.testing.assert_allclose(info["reference"][:, 0], 1.5 * info["reference"][:, 1])
    actions = (2.0 * (force - 0.6) / (25.0 - 0.6) - 1.0).astype(np.float32)[:, np.newaxis]
    success, over = np.zeros(12, bool), np.zeros(12, bool)
    for _ in range(600):
        *_, terminated, truncated, info = envs.step(actions)
        success |= ~over & info["is_success"]
        ended = terminated | truncated
        over |= ended
        if over.all():
            break
        if ended.any():
            envs.reset(options={"reset_mask": ended})
    assert success.all() if solved else not success.any()


def test_a_break_stays_a_violation(hand):
    state = hand("FragileHold")
    state.episode["grip_limit"] = 6.0
    state.evaluate(1)
    assert not state.episode["violated"]
    state.fingers["force"] = 6.1
    assert state.evaluate(2)["violated"] == -1.0
    state.fingers["force"] = 5.0
    assert state.evaluate(3)["violated"] == 0.0
    assert state.episode["violated"]


def test_moves_are_minimum_jerk(hand):
    state = hand("FragileHold")
    state.episode["moves"][:] = 0.0
    duration = move_time(0.1, 2.0, 10.0)
    state.episode["moves"][0] = 1.0, duration, 0.0, 0.1, 0.0
    time = np.linspace(1.0, 1.0 + duration, 20001)
    speed = np.array([planned_velocity(state.episode, t)[1] for t in time])
    assert np.trapezoid(speed, time) == pytest.approx(0.1, rel=1e-6)
    assert speed.max() == pytest.approx(VELOCITY * 0.1 / duration, rel=1e-6)
    assert np.gradient(speed, time).max() == pytest.approx(2.0, rel=1e-3)
    assert duration == pytest.approx(np.sqrt(ACCELERATION * 0.1 / 2.0))
    assert move_time(0.1, 1e9, 0.5) == pytest.approx(VELOCITY * 0.1 / 0.5)


def test_friction_comes_from_the_tasks_range():
    settings = TASKS["FragileHold"].settings()
    low, high = settings.friction_range
    with_range = gym.make_vec(ID, 300)
    _, info = with_range.reset(seed=0)
    mu_s, mu_c, _ = info["true"].T
    assert low <= mu_c.min() < 1.05 * low
    assert 0.95 * high < mu_c.max() <= high
    assert np.median(np.log(mu_c)) == pytest.approx(0.5 * np.log(low * high), abs=0.15)
    assert len(np.unique((mu_s / mu_c).round(9))) == 4  # those of the materials
    _, info = with_range.reset(seed=0, options={"mu_s": 0.4})
    np.testing.assert_allclose(info["true"][:, 0], 0.4)
    np.testing.assert_allclose(info["true"][:, 1], 0.4 * mu_c / mu_s)
    _, info = with_range.reset(seed=0, options={"material": "wood"})
    np.testing.assert_allclose(info["true"][:, 1], 0.3623)
    with_range.close()
    drawn = gym.make_vec(ID, 300, randomization={"mu_c": {"uniform": [0.5, 0.6]}})
    _, info = drawn.reset(seed=0)
    assert 0.5 <= info["true"][:, 1].min() <= info["true"][:, 1].max() <= 0.6
    drawn.close()
