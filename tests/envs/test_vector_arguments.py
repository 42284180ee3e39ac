"""What a batch refuses, and how it says so."""

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

from slipgym.envs.vector_env import SlipVectorEnv

ID = "slipgym/LinearSlip-v0"
ZERO = np.zeros((3, 1), np.float32)


@pytest.fixture
def env():
    made = gym.make_vec(ID, num_envs=3)
    yield made
    made.close()


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({"colour": 1}, TypeError, "unknown keyword argument 'colour'; valid: .*threads"),
        ({"engine": "bullet"}, ValueError, "runs on the planar engine alone.*vectorization_mode"),
        ({"threads": 0}, ValueError, "threads = 0 must be None or a whole number >= 1"),
        ({"threads": True}, ValueError, "threads = True"),
        ({"render_mode": "human"}, ValueError, "render_mode 'human'; valid: depth_array, rgb_array"),
        ({"render_mode": "rgb_array", "render_rows": (3,)}, ValueError, "render_rows: 3 must .* 0 to 2"),
        ({"render_mode": "rgb_array", "render_rows": 0}, ValueError, "render_rows = 0 must be a list"),
        ({"render_mode": "rgb_array", "render_rows": ()}, ValueError, r"render_rows = \(\) must be a list"),
        ({"autoreset_mode": "Sometimes"}, ValueError, "autoreset_mode 'Sometimes'; valid: .*SameStep"),
        ({"frame_skip": 0}, ValueError, "frame_skip = 0"),
        ({"estimator": "none"}, ValueError, "estimator"),
        ({"num_envs": 0}, ValueError, "num_envs = 0 must be a whole number >= 1"),
    ],
)
def test_refuses_arguments(arguments, error, message):
    with pytest.raises(error, match=message):
        SlipVectorEnv("LinearSlip", **{"num_envs": 3, **arguments})


def test_refuses_unknown_tasks():
    with pytest.raises(ValueError, match=r"task 'Juggle'; valid: .*Hinge"):
        SlipVectorEnv("Juggle")


def test_takes_the_engine_it_has():
    env = gym.make_vec(ID, num_envs=2, engine="planar", autoreset_mode="SameStep")
    assert env.metadata["autoreset_mode"] is AutoresetMode.SAME_STEP
    assert env.spec.id == ID
    env.close()


@pytest.mark.parametrize(
    ("seed", "message"),
    [
        (-1, "seed = -1 of environment 0"),
        ([1, 2], "2 seeds for 3 environments"),
        ([1, 2.5, 3], "seed = 2.5 of environment 1"),
        ("one", "seed = 'one' must be"),
        (True, "seed = True must be"),
        (0.5, "seed = 0.5 must be"),
    ],
)
def test_refuses_seeds(env, seed, message):
    with pytest.raises(ValueError, match=message):
        env.reset(seed=seed)


@pytest.mark.parametrize(
    ("mask", "error", "message"),
    [
        ([True, False, True], TypeError, "must be a numpy array of booleans"),
        (np.ones(3), TypeError, "must be a numpy array of booleans"),
        (np.ones(2, dtype=bool), ValueError, r"must have shape \(3,\), got \(2,\)"),
        (np.zeros(3, dtype=bool), ValueError, "at least one True"),
    ],
)
def test_refuses_masks(env, mask, error, message):
    with pytest.raises(error, match=message):
        env.reset(options={"reset_mask": mask})


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"rows": [{}, {}]}, r"options\['rows'\] must be a list of 3 mappings"),
        ({"rows": "abcd"}, r"options\['rows'\] must be a list of 3 mappings"),
        ({"rows": [None, {"weight": 1}, None]}, r"options\['rows'\]\[1\].*weight"),
        ({"rows": [None, 7, None]}, r"options\['rows'\]\[1\].*mapping"),
        ({"weight": 1.0}, "unknown option 'weight'"),
        (3, "options = 3 must be a mapping"),
    ],
)
def test_refuses_options(env, options, message):
    with pytest.raises(ValueError, match=message):
        env.reset(options=options)


def test_a_row_whose_options_contradict_each_other_needs_another_reset(env):
    env.reset(seed=0)
    with pytest.raises(ValueError, match="must be at least mu_c"):
        env.reset(options={"rows": [None, {"mu_s": 0.1, "mu_c": 0.2}, None]})
    with pytest.raises(RuntimeError, match=r"environments \[1, 2\] have no episode"):
        env.step(ZERO)
    env.reset(options={"reset_mask": np.array([False, True, True])})
    env.step(ZERO)


@pytest.mark.parametrize(
    ("actions", "message"),
    [
        (np.zeros((2, 1)), r"actions must have shape \(3, 1\) .*grip_force.*got \(2, 1\)"),
        (np.zeros(3), r"got \(3,\)"),
        ([[0.0], [np.nan], [0.0]], r"actions\[1, 0\] \(grip_force\) = nan must be finite"),
        ([["a"], ["b"], ["c"]], "must be an array of numbers"),
    ],
)
def test_refuses_actions(env, actions, message):
    env.reset(seed=0)
    with pytest.raises(ValueError, match=message):
        env.step(actions)


def test_steps_and_pictures_need_a_reset():
    env = gym.make_vec(ID, num_envs=3, render_mode="rgb_array", render_rows=[0, 1], autoreset_mode="Disabled")
    with pytest.raises(RuntimeError, match=r"environments \[0, 1, 2\] have no episode"):
        env.step(ZERO)
    env.reset(options={"reset_mask": np.array([True, False, False])})
    with pytest.raises(RuntimeError, match=r"environments \[1, 2\] have no episode"):
        env.step(ZERO)
    with pytest.raises(RuntimeError, match="environment 1 has no object yet"):
        env.render()
    env.reset()
    assert len(env.render()) == 2
    env.close()


def test_an_episode_that_is_over_does_not_go_on():
    env = gym.make_vec(ID, num_envs=3, frame_skip=60, autoreset_mode="Disabled")
    env.reset(seed=0)
    over = np.zeros(3, dtype=bool)
    while not over.any():
        _, _, terminated, truncated, _ = env.step(ZERO)
        over = terminated | truncated
    with pytest.raises(RuntimeError, match="have no episode"):
        env.step(ZERO)
    env.close()


def test_an_episode_that_ends_in_its_last_step_is_truncated_too():
    """The end cuts that step short; Gymnasium's TimeLimit counts it."""
    arguments = {"frame_skip": 4, "max_episode_steps": 6}
    batch = gym.make_vec(ID, num_envs=2, autoreset_mode="Disabled", **arguments)
    single = gym.make(ID, disable_env_checker=True, engine="planar", **arguments)
    drop = {"material": "wood"}
    batch.reset(seed=3, options=drop), single.reset(seed=3, options=drop)
    for step in range(6):
        _, _, terminated, truncated, _ = batch.step(np.full((2, 1), -1.0, np.float32))
        *_, ended, cut, _ = single.step(np.full(1, -1.0, np.float32))
        assert (bool(terminated[0]), bool(truncated[0])) == (ended, cut), step
        if ended or cut:
            break
    assert (ended, cut) == (True, True)
    batch.close(), single.close()


@pytest.mark.parametrize("threads", [1, 2])
def test_a_closed_environment_says_so(threads):
    env = gym.make_vec(ID, num_envs=3, threads=threads)
    env.reset(seed=0)
    env.step(ZERO)
    env.close()
    env.close()
    for call in (env.reset, lambda: env.step(ZERO), env.render, env.get_state):
        with pytest.raises(RuntimeError, match="closed; make a new one"):
            call()


@pytest.mark.parametrize("threads", [1, 3])
def test_a_number_that_is_not_finite_is_named_with_its_row(threads):
    env = gym.make_vec(ID, num_envs=5, threads=threads)
    env.reset(seed=0)
    zero = np.zeros((5, 1), np.float32)
    env.step(zero)
    episode = env.simulation.episode
    episode["pushes"][3], episode["push_end"][3, 0] = 1, episode["steps"][3]
    episode["push_wrench"][3, 0] = np.nan, 0.0, 0.0
    with pytest.raises(FloatingPointError, match=r"^environment 3: object_x is nan at t = 0\.0166667 s; "):
        env.step(zero)
    with pytest.raises(RuntimeError, match=r"environments \[0, 1, 2, 3, 4\] have no episode"):
        env.step(zero)
    env.reset(seed=0)
    env.step(zero)
    env.close()


def test_rows_that_began_in_a_step_that_failed_need_a_reset_too():
    env = gym.make_vec(ID, num_envs=3, threads=1).unwrapped
    env.reset(seed=0, options={"rows": [{"duration": 0.1, "settle": 0.0, "hold": 0.0}, None, None]})
    over = False
    while not over:
        _, _, terminated, truncated, _ = env.step(ZERO)
        over = (terminated | truncated)[0]
    episode = env.simulation.episode
    episode["pushes"][2], episode["push_end"][2, 0] = 1, episode["steps"][2]
    episode["push_wrench"][2, 0] = np.nan, 0.0, 0.0
    with pytest.raises(FloatingPointError, match="environment 2"):
        env.step(ZERO)
    with pytest.raises(RuntimeError, match=r"environments \[0, 1, 2\] have no episode"):
        env.step(ZERO)
    env.close()
