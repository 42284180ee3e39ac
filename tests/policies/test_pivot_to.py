"""The controller of PivotTo: what friction is worth to it, closed loop, and the model that it acts on."""

import gymnasium as gym
import numpy as np
import pytest

import policies
from policies.controllers.no_friction_info import NoFrictionInfo
from policies.controllers.pivot_to import Motion
from policies.evaluation.play import play
from policies.stepping import steps

ID, N = "slipgym:slipgym/PivotTo-v0", 60


def solved(policy, source, level):
    envs = gym.make_vec(ID, N, "vector_entry_point", friction_source=source, level=level)
    found = play(envs, policy, range(1000, 1000 + N))
    envs.close()
    return found.success.mean()


def test_friction_decides():
    assert solved(policies.make("pivot_to"), "true", "hard") >= 0.95
    assert solved(policies.make("pivot_to"), "estimated", "hard") >= 0.8
    assert solved(policies.make("pivot_to"), "nominal", "hard") <= 0.5
    assert solved(NoFrictionInfo("pivot_to"), "none", "hard") <= 0.5


@pytest.mark.slow
@pytest.mark.parametrize(("source", "least"), [("true", 0.95), ("estimated", 0.9)])
def test_the_easy_level_needs_estimates_alone(source, least):
    assert solved(policies.make("pivot_to"), source, "easy") >= least


@pytest.mark.slow
def test_it_is_so_with_pybullet():
    policy, successes = policies.make("pivot_to"), 0
    env = gym.make(ID, friction_source="true")
    for seed in range(10):
        observation, _ = env.reset(seed=seed)
        *_, last = steps(env, policy, observation)
        successes += last.info["is_success"]
    env.close()
    assert successes == 10


def test_either_way_is_the_same():
    """Without noise a goal and its mirror image take the same grip, and mirrored strokes."""
    policy, runs = policies.make("pivot_to"), []
    for sign in (1.0, -1.0):
        env = gym.make(ID, engine="planar", friction_source="true", sensors="ideal")
        observation, info = env.reset(seed=0, options={"angle": 0.9 * sign})
        state, over, strokes = None, False, []
        while not over:
            action, state = policy.predict(observation, state)
            strokes.append(action)
            observation, _, terminated, truncated, info = env.step(action)
            over = terminated or truncated
        env.close()
        assert info["is_success"]
        runs.append(np.array(strokes))
    np.testing.assert_allclose(runs[0][:, 0], runs[1][:, 0], atol=1e-2)
    np.testing.assert_allclose(runs[0][:, 1], -runs[1][:, 1], atol=1e-2)


def test_the_stroke_goes_as_long_as_the_energy_is_missing():
    """A pendulum with the model's length and friction that has just enough energy arrives at its goal."""
    policy = policies.make("pivot_to", arrive=0.0)
    length, loose, gravity, goal = policy._length, 3.0, policy.config.physics.gravity, 1.1
    start = Motion(*np.array([[goal], [0.0], [0.0], [0.0], [1.0], [loose]]))
    rate = np.sqrt(2.0 * policy._missing(start) / length)
    angle, dt = 0.0, 1e-5
    while rate > 0.0:
        rate = rate - dt * (gravity * np.sin(angle) + loose) / length
        angle = angle + dt * rate
    assert angle == pytest.approx(goal, abs=1e-3)
