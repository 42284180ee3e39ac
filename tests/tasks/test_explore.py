"""Explore: the guess and its score, the budget of slip, commitment, and the radius from a range."""

import math

import gymnasium as gym
import numpy as np
import pytest

import slipgym  # noqa: F401
from slipgym.tasks import TASKS
from slipgym.tasks.explore import MARGIN, SCRATCH

ID = "slipgym/Explore-v0"
TRUE = 0.6, 0.4, 0.01


@pytest.fixture
def state(hand):
    """An object that hangs at rest in the first control step, with the guess right and vague."""
    made = hand("Explore")
    episode = made.episode
    episode["mu_s"], episode["mu_c"], episode["r"] = TRUE
    episode["finger_friction"] = episode["jump_factor"] = episode["region_factor"] = 1.0
    episode["jump_step"] = 10**9
    episode["guess"] = *TRUE, 0.1, 0.1, 0.1
    made.world["mass"], made.world["gravity"], made.world["axes"] = 0.2, 9.81, (1.0, 0.0)
    made.evaluate(0)
    return made


def test_the_log_score_of_a_guess(state):
    state.episode["guess"] = 1.1 * TRUE[0], TRUE[1], TRUE[2] / 1.2, 0.05, 0.02, 0.1
    terms = state.evaluate(1)
    errors, deviations = (math.log(1.1), 0.0, math.log(1.2)), (0.05, 0.02, 0.1)
    pairs = zip(errors, deviations, strict=True)
    expected = np.mean([-math.log(s) - 0.5 * (e / s) ** 2 for e, s in pairs])
    assert state.episode["reference"][0] == pytest.approx(expected)
    assert terms["score"] == pytest.approx(0.5 * (expected / math.log(100.0) - 1.0))


def test_the_score_is_proper(state):
    """With errors of a deviation of 5 % the best stated deviation is 5 %."""
    rng = np.random.default_rng(0)
    errors = np.exp(0.05 * rng.standard_normal((2000, 3)))
    means = []
    for stated in (0.02, 0.035, 0.05, 0.07, 0.1):
        scores = []
        for factors in errors:
            state.episode["guess"] = *(np.array(TRUE) * factors), stated, stated, stated
            state.evaluate(1)
            scores.append(state.episode["reference"][0])
        means.append(np.mean(scores))
    assert np.argmax(means) == 2


@pytest.mark.parametrize(("factor", "regret"), [(1.0, 0.1), (1.05, 1.1 / 1.05 - 1.0), (0.9, 1.1 / 0.9 - 1.0)])
def test_the_regret_is_the_grip_over_the_least(state, factor, regret):
    state.episode["guess"][0] = factor * TRUE[0]
    state.evaluate(1)
    assert state.episode["reference"][1] == pytest.approx(regret)


def test_the_regret_counts_the_radius_where_the_weight_turns(state):
    state.episode["own"][SCRATCH.lever] = 0.01
    state.episode["guess"][2] = 0.02
    state.evaluate(1)
    assert state.episode["reference"][1] == 1.0  # too weak a grip: sqrt(1 + 1/4) of sqrt(2)
    state.episode["guess"][2] = 0.005
    state.evaluate(2)
    assert state.episode["reference"][1] == pytest.approx(MARGIN * math.sqrt(5.0 / 2.0) - 1.0)


def test_there_and_back_uses_the_budget_twice(state):
    limit = state.settings.slide_tolerance
    for step, (y, used) in enumerate(((-0.6, 0.6), (0.0, 1.2), (0.0, 1.2)), 1):
        terms = state.evaluate(step, slip=(0.0, y * limit, 0.0))
        assert state.episode["reference"][2] == pytest.approx(used)
        assert terms["violated"] == (-1.0 if step == 2 else 0.0)
        assert terms["slip"] == pytest.approx(-min(used, 1.0))
    assert state.episode["own"][SCRATCH.slid] == pytest.approx(1.2 * limit)


def test_a_turn_has_a_budget_of_its_own(state):
    state.evaluate(1, slip=(0.0, 0.0, 0.9 * state.settings.tilt_tolerance))
    assert not state.episode["violated"]
    state.evaluate(2, slip=(0.0, 0.0, 1.1 * state.settings.tilt_tolerance))
    assert state.episode["violated"]


@pytest.mark.parametrize(("error", "solved"), [(0.0, 1.0), (0.049, 1.0), (-0.051, 0.0)])
@pytest.mark.parametrize("k", range(3))
def test_a_commitment_ends_the_episode(state, k, error, solved):
    assert state.evaluate(1)["solved"] == 0.0
    assert not state.episode["ended"]
    state.episode["guess"][3:] = 0.02, 0.025, 0.01
    state.episode["guess"][k] *= 1.0 + error
    terms = state.evaluate(2)
    assert state.episode["ended"]
    assert terms["solved"] == solved
    assert terms["following"] < 0.0
    state.episode["guess"][5] = 0.026
    assert state.evaluate(3)["following"] == 0.0
    assert not state.episode["ended"]


def test_a_drop_is_no_commitment(state):
    state.episode["guess"][3:] = 0.01
    state.fingers["contact_force"] = 0.0
    terms = state.evaluate(2)
    assert not state.episode["ended"]
    assert (terms["drop"], terms["solved"], terms["following"]) == (-1.0, 0.0, 0.0)


def actions_of(env, guesses, force=0.5):
    """Actions (n, 10) that grip firmly and state guesses (n, 6): values and relative deviations."""
    columns = env.unwrapped.action_columns[4:]
    low, high = (np.array([getattr(column, end) for column in columns]) for end in ("low", "high"))
    actions = np.zeros((len(guesses), 10))
    actions[:, 0], actions[:, 4:] = force, 2.0 * (np.log(guesses) - low) / (high - low) - 1.0
    return actions.astype(np.float32)


def test_the_truth_is_a_success_in_the_first_step():
    envs = gym.make_vec(ID, 6, autoreset_mode="Disabled")
    _, info = envs.reset(seed=0)
    true, deviations = info["true"], np.full((6, 3), 0.02)
    deviations[:2] = 0.05
    guesses = np.column_stack((true, deviations))
    guesses[2, 1] *= 1.06
    _, reward, terminated, truncated, info = envs.step(actions_of(envs, guesses))
    envs.close()
    assert terminated.tolist() == [False] * 2 + [True] * 4
    assert not truncated.any()
    assert info["is_success"].tolist() == [False] * 3 + [True] * 3
    assert (reward[3:] > 9.9).all()
    np.testing.assert_allclose(info["reference"][3:, 0], -math.log(0.02), rtol=1e-4)


def test_r_comes_from_the_tasks_range():
    settings = TASKS["Explore"].settings()
    low, high = settings.radius_range
    envs = gym.make_vec(ID, 300, action_mode="grip_force")
    _, info = envs.reset(seed=0)
    radii = info["true"][:, 2]
    assert low <= radii.min() < low + 0.05 * (high - low)
    assert high - 0.05 * (high - low) < radii.max() <= high
    assert np.median(radii) == pytest.approx(0.5 * (low + high), abs=4e-4)
    assert abs(np.corrcoef(radii, info["true"][:, 1])[0, 1]) < 0.2
    _, info = envs.reset(seed=0, options={"r": 0.009})
    np.testing.assert_allclose(info["true"][:, 2], 0.009)
    envs.close()
    with pytest.raises(ValueError, match=r"tasks\.explore\.radius_range must not exceed gripper\.pad_radius"):
        gym.make(ID, config={"tasks": {"explore": {"radius_range": [0.01, 0.02]}}})


def test_without_a_guess_the_estimate_counts():
    envs = gym.make_vec(ID, 4, action_mode="grip_force", autoreset_mode="Disabled")
    envs.reset(seed=0)
    for _ in range(3):
        _, _, terminated, _, info = envs.step(np.full((4, 1), -0.2, np.float32))
    episode = envs.unwrapped.simulation.episode
    np.testing.assert_allclose(episode["guess"][:, :3], info["estimated"])
    assert not episode["guesses"].any()
    assert not terminated.any()
    envs.close()


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["planar", "bullet"])
def test_a_state_holds_the_guess_and_a_single_environment_ends_as_well(engine):
    env = gym.make(ID, engine=engine).unwrapped
    _, info = env.reset(seed=3)
    rng = np.random.default_rng(0)
    for _ in range(20):
        env.step(rng.uniform(-0.1, 1.0, 10).astype(np.float32))
    state = env.get_state()
    following = rng.uniform(-0.1, 1.0, (5, 10)).astype(np.float32)
    first = [repr(env.step(action)) for action in following]
    env.set_state(state)
    assert [repr(env.step(action)) for action in following] == first
    guess = np.array([[*info["true"], 0.02, 0.02, 0.02]])
    _, _, terminated, truncated, info = env.step(actions_of(env, guess)[0])
    assert (terminated, truncated) == (True, False)
    env.close()


@pytest.mark.slow
def test_a_row_equals_a_single_environment_through_commitments():
    envs = gym.make_vec(ID, 3, autoreset_mode="SameStep")
    single = gym.make(ID, engine="planar").unwrapped
    envs.reset(seed=[5, 6, 7])
    single.reset(seed=6)
    rng, ends = np.random.default_rng(1), 0
    for _ in range(200):
        actions = rng.uniform(-1.0, 1.0, (3, 10)).astype(np.float32)
        actions[:, 0] = 0.8
        observations, rewards, terminated, truncated, _ = envs.step(actions)
        observation, reward, done, over, _ = single.step(actions[1])
        assert (reward, done, over) == (rewards[1], terminated[1], truncated[1])
        if done or over:
            ends += 1
            observation, _ = single.reset()
        np.testing.assert_array_equal(observation, observations[1])
    assert ends > 0
    envs.close()
    single.close()
