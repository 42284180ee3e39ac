"""What an episode says: spaces, info, rewards, ends."""

import math

import gymnasium as gym
import numpy as np
import pytest

HARDEST, LIGHTEST = np.float32([1.0]), np.float32([-1.0])
ROOM = {  # from pad centre to edge, less the pad's radius [m]
    "slipgym/LinearSlip-v0": 0.065,
    "slipgym/RotationalSlip-v0": 0.005,
    "slipgym/Hinge-v0": 0.010,
    "slipgym/PlanarSlip-v0": 0.065,
    "slipgym/Hold-v0": 0.065,
    "slipgym/FragileHold-v0": 0.065,
    "slipgym/Carry-v0": 0.065,
    "slipgym/Explore-v0": 0.065,
    "slipgym/PivotTo-v0": 0.010,
}
SHAPES = {
    "true": (3,),
    "estimated": (3,),
    "true_per_finger": (2, 3),
    "estimated_per_finger": (2, 3),
    "slip": (3,),
    "slip_twist": (3,),
    "contact_wrench": (2, 3),
    "grip_force": (2,),
    "reference": (3,),
}


def finish(env: gym.Env, action: np.ndarray) -> list[tuple]:
    steps = []
    while not steps or not (steps[-1][2] or steps[-1][3]):
        steps.append(env.step(action))
    return steps


@pytest.mark.parametrize("source", ["estimated", "true", "nominal", "none"])
def test_observations_stay_in_the_space_through_a_drop(make, env_id, source):
    env = make(env_id, friction_source=source)
    observation, _ = env.reset(seed=0, options={"object_mass": 0.4})
    assert env.observation_space.contains(observation)
    steps = finish(env, LIGHTEST)
    falling_on = [env.step(LIGHTEST) for _ in range(240)]
    for observation, reward, *_ in steps + falling_on:
        assert env.observation_space.contains(observation)
        assert math.isfinite(reward)


@pytest.mark.parametrize(
    "options",
    [{"initial_force": 0.6}, {"object_mass": 0.01}, {"object_mass": 5.0}, {"mu_s": 5.0, "mu_c": 5.0}],
)
def test_observations_stay_in_the_space_for_extreme_options(make, env_id, options):
    env = make(env_id)
    said = [env.reset(seed=0, options=options)[0]]
    rng = np.random.default_rng(0)
    said += [env.step(rng.uniform(-1.0, 1.0, 1))[0] for _ in range(100)]
    assert all(env.observation_space.contains(observation) for observation in said)


def test_the_smallest_force_drops_the_object(make, env_id):
    env = make(env_id)
    heavy = (
        {"object_mass": 0.1, "mu_c": 0.3} if env_id == "slipgym/PivotTo-v0" else {}
    )  # its own is too light
    env.reset(seed=0, options=heavy)
    steps = finish(env, LIGHTEST)
    *_, terminated, truncated, info = steps[-1]
    assert (terminated, truncated) == (True, False)
    assert info["dropped"] is True
    assert info["is_success"] is False
    assert np.hypot(*info["slip"][:2]) > ROOM[env_id]  # a pad has reached an edge
    assert info["reward_terms"]["drop"] == -1.0
    assert all(step[4]["reward_terms"]["drop"] == 0.0 for step in steps[:-1])


def test_the_largest_force_holds_and_the_episode_truncates_by_itself(make, env_id):
    env = make(env_id)
    slightly = {"turn": 0.1} if env_id == "slipgym/Hinge-v0" else {}  # further, and gravity turns the object
    env.reset(seed=0, options={"duration": 1.0, **slightly})
    steps = finish(env, HARDEST)
    *_, terminated, truncated, info = steps[-1]
    assert (terminated, truncated) == (False, True)
    assert info["time"] == pytest.approx(len(steps) / 120)
    assert np.abs(info["slip"]).max() < 1e-4
    assert info["is_success"] is (env.spec.id == "slipgym/Hold-v0")


def test_an_outer_time_limit_cuts_earlier(env_id):
    env = gym.make(env_id, max_episode_steps=10, action_mode="grip_force")
    env.reset(seed=0)
    flags = [env.step(HARDEST)[2:4] for _ in range(10)]
    assert flags == [(False, False)] * 9 + [(False, True)]
    env.close()


def test_info_keeps_its_contract(make, env_id):
    env = make(env_id)
    for info in (env.reset(seed=0)[1], env.step(HARDEST)[4]):
        assert {name: value.shape for name, value in info.items() if name in SHAPES} == SHAPES
        assert set(info) == {*SHAPES, "reward_terms", "time", "is_success", "violated", "dropped", "finished"}
        assert tuple(info["reward_terms"]) == env.task.term_names
        assert type(info["is_success"]) is type(info["dropped"]) is bool
        assert type(info["time"]) is float
        np.testing.assert_array_equal(info["estimated"], info["estimated_per_finger"].mean(axis=0))


def test_step_returns_builtin_types(make, env_id):
    env = make(env_id)
    env.reset(seed=0)
    observation, reward, terminated, truncated, info = env.step(HARDEST)
    assert observation.dtype == np.float32
    assert [type(value) for value in (reward, terminated, truncated, info)] == [float, bool, bool, dict]
    assert all(type(value) is float for value in info["reward_terms"].values())


def test_what_is_returned_is_the_callers(make, env_id):
    env, twin = make(env_id), make(env_id)
    observation, info = env.reset(seed=0)
    twin.reset(seed=0)
    for _ in range(5):
        for array in (observation, *(value for value in info.values() if isinstance(value, np.ndarray))):
            array[...] = 1e9
        info["reward_terms"].clear()
        result = env.step(HARDEST)
        assert repr(result) == repr(twin.step(HARDEST))
        observation, info = result[0], result[4]


@pytest.mark.parametrize("frame_skip", [1, 4])
def test_the_reward_is_the_sum_of_its_terms(make, env_id, frame_skip):
    env = make(env_id, frame_skip=frame_skip)
    env.reset(seed=0, options={"object_mass": 0.4})
    rng = np.random.default_rng(1)
    steps = [env.step(rng.uniform(-1.0, 0.0, 1)) for _ in range(30)] + finish(env, LIGHTEST)
    for _, reward, _, _, info in steps:
        assert reward == sum(info["reward_terms"].values())


def test_frame_skip_repeats_single_steps(make, env_id):
    skipping, single = make(env_id, frame_skip=3), make(env_id)
    options = {"duration": 0.5}
    assert repr(skipping.reset(seed=0, options=options)) == repr(single.reset(seed=0, options=options))
    rng, over = np.random.default_rng(2), False
    while not over:
        action = rng.uniform(-0.5, 1.0, 1)
        observation, reward, *flags, info = skipping.step(action)
        parts = []
        while len(parts) < 3 and not (parts and (parts[-1][2] or parts[-1][3])):
            parts.append(single.step(action))
        np.testing.assert_array_equal(observation, parts[-1][0])
        assert reward == pytest.approx(sum(part[1] for part in parts), rel=1e-12)
        assert flags == list(parts[-1][2:4])
        last = parts[-1][4]
        assert repr({**info, "reward_terms": None}) == repr({**last, "reward_terms": None})
        over = any(flags)


def test_frame_skip_stops_at_a_drop(make, env_id):
    env = make(env_id, frame_skip=50)
    env.reset(seed=0, options={"object_mass": 0.3})  # PivotTo's own object is too light to fall
    terminated, truncated, info = False, False, {}
    while not (terminated or truncated):  # a support may bear the object at first
        begun = info.get("time", 0.0)
        _, reward, terminated, truncated, info = env.step(LIGHTEST)
    assert terminated
    assert info["reward_terms"]["drop"] == -1.0
    assert info["time"] - begun < 49 / 120
    assert reward > -4.0  # one violation and one drop


def test_the_friction_source_fills_the_last_columns(make, env_id):
    observed = {}
    for source in ("estimated", "true", "nominal", "none"):
        env = make(env_id, friction_source=source, estimator="rls")
        observed[source], info = env.reset(seed=0)
        if source == "true":
            np.testing.assert_allclose(observed[source][-6:-3], info["true"], rtol=1e-6)
    nominal = env.config.nominal
    r = env.settings.radius or nominal.r
    np.testing.assert_allclose(observed["nominal"][-6:-3], [nominal.mu_s, nominal.mu_c, r], rtol=1e-6)
    np.testing.assert_allclose(observed["estimated"][-6:], [1.5, 1.3, 0.02, 0, 0, 0], rtol=1e-6)
    for source in ("true", "nominal"):
        assert observed[source][-3:].tolist() == [1.0, 1.0, 1.0]
        np.testing.assert_array_equal(observed[source][:-6], observed["none"])
