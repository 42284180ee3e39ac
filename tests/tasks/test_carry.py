"""Carry: the least grip of the plan, the plan ahead, and the grip that the economy allows."""

import gymnasium as gym
import numpy as np
import pytest

import slipgym  # noqa: F401
from slipgym.tasks import TASKS
from slipgym.tasks.carry import AHEAD

ID, N = "slipgym/Carry-v0", 12
NAMES = [column.name for column in TASKS["Carry"].columns]


@pytest.fixture(scope="module")
def firm():
    """Episodes in the firmest grip: least grip for the true load, observations (steps, n, ...), infos."""
    envs = gym.make_vec(ID, N, friction_source="true", autoreset_mode="Disabled")
    observations, infos, need = [], [], []
    observed, info = envs.reset(seed=0)
    steps = envs.unwrapped.simulation.episode["steps"].copy()
    running = np.ones(N, bool)
    for k in range(steps.max()):
        observations.append(observed[:, 18 : 18 + len(NAMES)])
        infos.append({key: np.array(info[key]) for key in ("reference", "true", "is_success")})
        observed, _, terminated, truncated, info = envs.step(np.ones((N, 1), np.float32))
        f_x, f_y, tau = info["contact_wrench"].mean(axis=1).T
        mu_s, _, r = info["true"].T
        need.append(np.where(k < steps, np.sqrt(f_x**2 + f_y**2 + (tau / r) ** 2) / mu_s, np.nan))
        running &= ~(terminated | truncated)
        if not running.all():
            break
    envs.close()
    return steps, np.array(observations), infos, np.array(need)


def test_the_mean_and_largest_least_grip_are_those_of_the_true_load(firm):
    """The shortest episode is compared to its end."""
    steps, _, infos, need = firm
    row = steps.argmin()
    assert len(need) == steps[row]
    allowed, mean, peak = infos[0]["reference"][row]
    assert peak == pytest.approx(np.nanmax(need[:, row]), rel=1e-3)
    # the load at the end of a control step against that in its middle
    assert mean == pytest.approx(np.maximum(need[:, row], 0.6).mean(), rel=1e-2)
    assert allowed == pytest.approx(1.6 * mean)


def test_the_plan_ahead_is_what_the_wrist_does(firm):
    _, observed, _, _ = firm
    at = {name: k for k, name in enumerate(NAMES)}
    for axis in ("x", "z"):
        speed = observed[:, :, at[f"wrist_velocity_{axis}"]]
        done = np.diff(speed, axis=0) * 120.0
        for ahead in AHEAD:
            steps = round(120 * ahead)
            said = observed[:, :, at[f"planned_acceleration_{axis}_{1e3 * ahead:.0f}"]]
            np.testing.assert_allclose(said[: len(done) - steps], done[steps:], atol=2e-3)
        assert np.abs(done).max() > 1.0


def test_the_largest_grip_uses_up_what_the_economy_allows():
    envs = gym.make_vec(ID, N, friction_source="true", autoreset_mode="Disabled")
    _, info = envs.reset(seed=1)
    allowed = info["reference"][:, 0]
    steps, spent = envs.unwrapped.simulation.episode["steps"], np.zeros(N)
    for _ in range(60):
        *_, info = envs.step(np.ones((N, 1), np.float32))
        spent += info["grip_force"].mean(axis=1)
        np.testing.assert_array_equal(info["violated"], spent > steps * allowed)
    envs.close()
    assert info["violated"].any()


def test_the_speed_of_the_wrist_is_the_tasks_own():
    for given, expected in ((None, 0.5), (0.8, 0.8)):
        env = gym.make(ID, engine="planar", config={"tasks": {"carry": {"wrist_speed": given}}}).unwrapped
        env.reset(seed=0)
        assert env.simulation.episode["wrist_speed_max"] == expected
        fastest = 0.0
        for _ in range(300):
            env.step(np.ones(1, np.float32))
            fastest = max(fastest, abs(env.simulation.plant.world["wrist_velocity"][0, 0]))
        env.close()
        assert 0.9 * expected < fastest <= expected + 1e-12


def test_the_grip_is_counted_once_a_control_step(hand):
    state = hand("Carry")
    state.episode["grip_budget"] = 2 * 4.0
    state.evaluate(1)
    state.evaluate(1)
    assert state.episode["grip_sum"] == 5.0
    state.episode["steps"] = 2
    state.evaluate(2)
    assert state.episode["violated"]  # 10 N of 8 N
