"""Saved, restored, copied and pickled environments go on bit for bit."""

import copy
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

pytestmark = pytest.mark.quick_tasks

ACTIONS = np.random.default_rng(0).uniform(-1.0, 0.3, (120, 1)).astype(np.float32)
CONTINUE = """
import pickle, sys
from tests.envs.printing import exactly
env, actions = pickle.load(sys.stdin.buffer)
with exactly():
    print([repr(env.step(a)) for a in actions])
env.close()
"""


def go_on(env, actions) -> list[str]:
    return [repr(env.step(action)) for action in actions]


@pytest.fixture(params=["bullet", "planar"])
def engine(request) -> str:
    return request.param


@pytest.fixture
def midway(make, env_id, engine):
    """An environment in the middle of an episode, its object slipping."""
    env = make(env_id, engine=engine)
    env.reset(seed=4, options={"object_mass": 0.3, "com_offset": (0.004, 0.01)})
    for action in ACTIONS[:60]:
        env.step(action)
    return env


def test_going_back_again_and_again(midway):
    state = midway.get_state()
    first = go_on(midway, ACTIONS[60:])
    for _ in range(2):
        midway.set_state(state)
        assert go_on(midway, ACTIONS[60:]) == first


@pytest.mark.slow
def test_fifty_random_moments(make, env_id, engine):
    rng = np.random.default_rng(1)
    env, other = (make(env_id, engine=engine) for _ in range(2))
    for episode in range(50):
        env.reset(seed=episode)
        for action in rng.uniform(-1.0, 0.5, (rng.integers(1, 120), 1)):
            env.step(action)
        state = env.get_state()
        actions = rng.uniform(-1.0, 0.5, (40, 1))
        said = go_on(env, actions)
        other.set_state(pickle.loads(pickle.dumps(state)))
        assert go_on(other, actions) == said


def test_into_another_environment_and_its_next_episode(make, env_id, engine, midway):
    other = make(env_id, engine=engine, render_mode="rgb_array")
    other.reset(seed=8)
    other.set_state(midway.get_state())
    assert go_on(other, ACTIONS[60:]) == go_on(midway, ACTIONS[60:])
    assert repr(other.reset()) == repr(midway.reset())


@pytest.mark.parametrize("duplicate", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
def test_copies_have_a_world_of_their_own(midway, duplicate):
    twin = duplicate(midway)
    assert go_on(twin, ACTIONS[60:]) == go_on(midway, ACTIONS[60:])
    midway.close()
    twin.step(ACTIONS[0])
    assert twin.spec == midway.spec
    twin.close()


@pytest.mark.quick_cases("slipgym/LinearSlip-v0-planar", "slipgym/Hold-v0-bullet")
def test_in_another_process(midway, env_id, engine, exact_printing):
    if (engine == "bullet") != (env_id == "slipgym/Hold-v0"):
        pytest.skip("one process a task is enough")
    content = pickle.dumps((midway, ACTIONS[60:]))
    root = Path(__file__).resolve().parents[2]
    done = subprocess.run(
        [sys.executable, "-c", CONTINUE], input=content, capture_output=True, cwd=root, check=True
    )
    assert done.stdout.decode().strip() == repr(go_on(midway, ACTIONS[60:]))


def test_before_the_first_reset_and_after_closing(make, env_id, engine):
    fresh = make(env_id, engine=engine)
    twin = pickle.loads(pickle.dumps(fresh))
    assert repr(twin.reset(seed=1)) == repr(fresh.reset(seed=1))
    fresh.close()
    with pytest.raises(RuntimeError, match="closed"):
        fresh.get_state()
    with pytest.raises(RuntimeError, match="closed"):
        copy.deepcopy(fresh).reset()
    twin.close()


def test_refuses_the_state_of_another_kind(make, env_id, engine, midway):
    state = midway.get_state()
    with pytest.raises(ValueError, match=r"physics\.gravity = 9\.81, here 1\.62"):
        make(env_id, engine=engine, config={"physics": {"gravity": 1.62}}).set_state(state)
    with pytest.raises(ValueError, match="another friction_source: 'estimated', here 'none'"):
        make(env_id, engine=engine, friction_source="none").set_state(state)
    other = "planar" if engine == "bullet" else "bullet"
    with pytest.raises(ValueError, match=f"another engine: '{engine}', here '{other}'"):
        make(env_id, engine=other).set_state(state)
    with pytest.raises(TypeError, match="get_state"):
        make(env_id).set_state({})
