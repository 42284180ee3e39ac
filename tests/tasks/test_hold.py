"""Hold: the least grip of an episode, and the mean grip that `grip_limit` allows."""

import gymnasium as gym
import numpy as np
import pytest

import slipgym  # noqa: F401
from slipgym.config.level import load_level
from slipgym.tasks import TASKS

ID, N, STEPS = "slipgym/Hold-v0", 12, 960
FALL = {
    "kind": "friction_jump",
    "probability": 1.0,
    "time": {"uniform": [2.0, 6.0]},
    "factor": {"uniform": [0.5, 0.8]},
}


def made(**arguments):
    return gym.make_vec(ID, N, friction_source="true", autoreset_mode="Disabled", **arguments)


def normalized(force):
    """Actions of a grip force (n,) [N]."""
    return (2.0 * (force - 0.6) / (25.0 - 0.6) - 1.0).astype(np.float32)[:, np.newaxis]


def played(envs, force):
    """Constant grips (n,) [N] to the end: success, step of the first violation (or none), mean grip."""
    success, first, spent = np.zeros(N, bool), np.full(N, STEPS + 1), np.zeros(N)
    for k in range(1, STEPS + 1):
        *_, info = envs.step(normalized(force))
        success = info["is_success"]
        first = np.where(info["violated"], np.minimum(first, k), first)
        if k > 120:
            spent += info["grip_force"].mean(axis=1)
    return success, first, spent / (STEPS - 120)


def test_the_least_grip_is_the_peak_need_of_a_firm_grip_with_the_friction_after_a_fall():
    envs = made(level={"settings": {"grip_limit": 2.0}, "randomization": {"disturbances": [FALL]}})
    _, info = envs.reset(seed=0)
    allowed, least = info["reference"][:, 0], info["reference"][:, 1]
    before, peak, first = info["true"][:, 0].copy(), np.zeros(N), np.zeros(N)
    for _ in range(STEPS):
        *_, info = envs.step(np.ones((N, 1), np.float32))
        f_x, f_y, tau = info["contact_wrench"].mean(axis=1).T
        mu_s, _, r = info["true"].T
        load = np.sqrt(f_x**2 + f_y**2 + (tau / r) ** 2)
        peak, first = np.maximum(peak, load / mu_s), np.maximum(first, load / before)
    envs.close()
    assert (mu_s < 0.81 * before).all()
    np.testing.assert_allclose(least, peak, rtol=2e-3)
    np.testing.assert_allclose(allowed, 2.0 * least)
    assert (least > 1.05 * first).any()


@pytest.mark.parametrize(("place", "solved"), [(1.05, True), (1.45, True), (1.55, False)])
def test_a_constant_grip_succeeds_between_least_and_allowed_grip(place, solved):
    envs = made(config={"tasks": {"hold": {"grip_limit": 1.5}}})
    _, info = envs.reset(seed=0)
    least = info["reference"][:, 1].copy()
    success, first, mean = played(envs, place * least)
    envs.close()
    np.testing.assert_allclose(mean, place * least, rtol=1e-2)
    assert success.all() if solved else not success.any()
    if not solved:  # as soon as the sum exceeds what the whole episode allows
        np.testing.assert_allclose(first, 120 + (STEPS - 120) * 1.5 / place, rtol=1e-2)


def test_without_a_limit_a_firm_grip_succeeds_and_nothing_is_computed():
    envs = made()
    _, info = envs.reset(seed=0)
    np.testing.assert_array_equal(info["reference"], 0.0)
    success, first, _ = played(envs, np.full(N, 25.0))
    envs.close()
    assert success.all()
    assert (first > STEPS).all()


def test_the_grip_counts_from_its_start_on_and_once_a_control_step(hand):
    state = hand("Hold", grip_limit=2.0, grip_limit_start=0.5)
    assert state.episode["grip_counted"] == 60
    state.episode["grip_budget"] = 2 * 4.0
    state.episode["steps"] = 62
    for step, spent in ((1, 0.0), (60, 0.0), (61, 5.0), (61, 5.0)):
        state.evaluate(step)
        assert state.episode["grip_sum"] == spent
    assert not state.episode["violated"]
    assert state.evaluate(62)["violated"] == -1.0  # 10 N of 8 N
    assert not state.episode["success"]


def test_a_start_after_the_end_leaves_every_grip_out(hand):
    state = hand("Hold", grip_limit=1.0, grip_limit_start=100.0)
    state.episode["grip_limit"] = 1e-3
    state.evaluate(STEPS)
    assert state.episode["success"]


def test_the_policy_does_not_see_the_limit():
    seen = []
    for limit in (1.0, 100.0):
        envs = made(config={"tasks": {"hold": {"grip_limit": limit}}})
        observation, _ = envs.reset(seed=3)
        seen.append([observation])
        for _ in range(30):
            seen[-1].append(envs.step(np.zeros((N, 1), np.float32))[0])
        envs.close()
    np.testing.assert_array_equal(*seen)


def test_the_levels_limit_the_grip():
    task = TASKS["Hold"]
    limits = [
        load_level(name, task.key).level.settings.get("grip_limit") for name in ("easy", "standard", "hard")
    ]
    assert limits[0] is None
    assert 1.0 < float(limits[2] or 0.0) < float(limits[1] or 0.0)


@pytest.mark.parametrize("wrong", [0.5, 101.0, "firm"])
def test_a_wrong_limit_is_an_error_that_names_it(wrong):
    with pytest.raises(ValueError, match=r"tasks\.hold\.grip_limit"):
        made(config={"tasks": {"hold": {"grip_limit": wrong}}})
