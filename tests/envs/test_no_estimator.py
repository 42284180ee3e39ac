"""`estimator=None`: nothing is estimated, and everything else is the same, bit for bit."""

import copy
import json
import pickle

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.envs.registration import EnvSpec
from gymnasium.utils.env_checker import data_equivalence

from slipgym.envs.observation import DEVIATION_COLUMNS, FRICTION_COLUMNS

ESTIMATES = {column.name for column in (*FRICTION_COLUMNS, *DEVIATION_COLUMNS)}
INFOS = {"estimated", "estimated_per_finger"}
ENGINES = pytest.mark.parametrize("engine", ["planar", "bullet"])
STEPS = 40


def actions(env, steps=STEPS):
    shape = getattr(env, "single_action_space", env.action_space).shape
    rng = np.random.default_rng(0)
    low = np.full((steps, getattr(env, "num_envs", 1), *shape), -0.2)
    low[..., 0] = -1.0
    drawn = rng.uniform(low, 0.2).astype(np.float32)
    return drawn if hasattr(env, "num_envs") else drawn[:, 0]


def played(env, seed=3):
    """Observations (arrays), rewards and infos of the first steps; an episode that ends begins anew."""
    said = [env.reset(seed=seed)]
    for action in actions(env):
        observation, reward, terminated, truncated, info = env.step(action)
        said.append((observation, info, reward))
        if not hasattr(env, "num_envs") and (terminated or truncated):
            said.append(env.reset())
    return said


def policy_part(observation):
    return observation["policy"] if isinstance(observation, dict) else observation


def assert_alike(with_estimator, without):
    """All columns and infos that are no estimates are equal."""
    kept = [k for k, column in enumerate(with_estimator.columns) if column.name not in ESTIMATES]
    assert [with_estimator.columns[k] for k in kept] == [*without.columns]
    for one, other in zip(played(with_estimator), played(without), strict=True):
        np.testing.assert_array_equal(policy_part(one[0])[..., kept], policy_part(other[0]))
        if isinstance(one[0], dict):
            np.testing.assert_array_equal(one[0]["privileged"], other[0]["privileged"])
        assert {name.lstrip("_") for name in one[1].keys() - other[1].keys()} == INFOS
        rest = {name: value for name, value in one[1].items() if name in other[1]}
        assert data_equivalence(rest, other[1], exact=True)
        assert np.array_equal(one[2:], other[2:])


@ENGINES
@pytest.mark.quick_tasks
def test_physics_and_other_columns_are_the_same(make, env_id, engine):
    own = {"engine": engine, "sensors": "lab", "randomization": "lab", "action_mode": None}
    assert_alike(make(env_id, **own), make(env_id, estimator=None, **own))


@pytest.mark.quick_tasks
@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_a_batch_without_is_one_with(make_vec, env_id, mode):
    own = {"num_envs": 5, "autoreset_mode": mode, "randomization": "train", "action_mode": None}
    with_estimator, without = (
        make_vec(env_id, **own).unwrapped,
        make_vec(env_id, estimator=None, **own).unwrapped,
    )
    assert_alike(with_estimator, without)
    one = gym.make(env_id, engine="planar", randomization="train", estimator=None).unwrapped
    np.testing.assert_array_equal(one.reset(seed=5)[0], without.reset(seed=3)[0][2])
    one.close()


def test_infos_of_episodes_that_ended_hold_no_estimates(make_vec):
    envs = make_vec(num_envs=2, autoreset_mode="SameStep", estimator=None)
    envs.reset(seed=0)
    for _ in range(400):
        *_, infos = envs.step(np.full((2, 1), -1.0, np.float32))
        if "final_info" in infos:
            break
    assert INFOS.isdisjoint(infos)
    assert INFOS.isdisjoint(infos["final_info"])
    assert "true" in infos["final_info"]


@pytest.mark.parametrize(
    ("source", "shown"), [("estimated", False), ("none", False), ("true", True), ("nominal", True)]
)
@pytest.mark.parametrize("mode", ["flat", "deviations", "sensor", "dict"])
def test_each_mode_leaves_out_what_would_be_estimated(make, mode, source, shown):
    own = {"engine": "planar", "observation_mode": mode, "friction_source": source, "history": 1}
    env, other = make(estimator=None, **own), make(**own)
    names = {column.name for column in env.columns}
    friction = {column.name for column in FRICTION_COLUMNS}
    assert names & friction == (friction if shown and mode != "sensor" else set())
    if source != "estimated":
        assert env.columns == other.columns
        assert env.observation_space == other.observation_space
    for observation, *_ in played(env):
        assert env.observation_space.contains(observation)
    if source == "estimated":
        assert not names & ESTIMATES
    elif not any(isinstance(each[0], dict) for each in played(other)):
        for one, two in zip(played(env), played(other), strict=True):
            np.testing.assert_array_equal(one[0], two[0])


@ENGINES
def test_states_copies_and_pickles_go_on(make, engine):
    env = make(engine=engine, estimator=None, history=1)
    played(env)
    other = make(engine=engine, estimator=None, history=1)
    other.set_state(pickle.loads(pickle.dumps(env.get_state())))
    twin = copy.deepcopy(env)
    for action in actions(env)[:10]:
        said = repr(env.step(action))
        assert said == repr(other.step(action)) == repr(twin.step(action))
    twin.close()
    with pytest.raises(ValueError, match="another estimator: None, here"):
        make(engine=engine, history=1).set_state(env.get_state())


def test_states_of_a_batch_go_on(make_vec):
    envs, others = (make_vec(num_envs=3, estimator=None).unwrapped for _ in range(2))
    played(envs)
    others.set_state(envs.get_state())
    twins = copy.deepcopy(envs)
    for action in actions(envs)[:10]:
        said = repr(envs.step(action))
        assert said == repr(others.step(action)) == repr(twins.step(action))
    twins.close()


def test_a_spec_makes_the_same_environment():
    env = gym.make("slipgym/LinearSlip-v0", estimator=None)
    spec = EnvSpec.from_json(env.spec.to_json())
    assert json.loads(env.spec.to_json())["kwargs"]["estimator"] is None
    again = gym.make(spec)
    assert again.observation_space == env.observation_space
    env.close()
    again.close()


def test_estimates_are_missing_and_say_why(make):
    env = make(estimator=None)
    assert not hasattr(env.simulation, "estimator")
    with pytest.raises(AttributeError, match="this environment has estimator=None"):
        _ = env.simulation.estimator


@pytest.mark.parametrize("choice", [3, {}, {"name": None}, False])
def test_what_is_no_estimator_is_refused(make, choice):
    with pytest.raises(ValueError, match=r"must be a name, a mapping with a name, or None; valid: .*rls"):
        make(estimator=choice)


@ENGINES
def test_a_task_that_scores_the_estimate_asks_for_a_guess(engine):
    own = {"engine": engine, "estimator": None}
    message = "action_mode = 'grip_force': Explore .*estimator=None; valid: grip_force_wrist_guess"
    with pytest.raises(ValueError, match=message):
        gym.make("slipgym/Explore-v0", action_mode="grip_force", **own)
    with pytest.raises(ValueError, match=message):
        gym.make_vec("slipgym/Explore-v0", num_envs=2, action_mode="grip_force", estimator=None)
    env = gym.make("slipgym/Explore-v0", **own).unwrapped
    env.reset(seed=0)
    *_, terminated, _, info = env.step(np.zeros(10, np.float32))
    assert not terminated
    assert np.isfinite(info["reference"]).all()
    env.close()


def test_pictures_show_no_estimate(make):
    env = make(render_mode="rgb_array", estimator=None, engine="planar")
    played(env)
    assert env.render().shape == (480, 720, 3)
    assert env.discrepancies() == []
