"""The batch behind Stable-Baselines3's interface is a DummyVecEnv of the same environments, bit for bit."""

from copy import deepcopy

import gymnasium as gym
import numpy as np
import pytest

import slipgym  # noqa: F401

vec_env = pytest.importorskip("stable_baselines3.common.vec_env")
import policies  # noqa: E402
from policies.training.adapter import SlipVecEnv, TaskEnd  # noqa: E402

LINEAR = "slipgym/LinearSlip-v0"
BRIEF = {"frame_skip": 8, "config": {"tasks": {"hold": {"duration": 2.0}}}}
SHORT = {"config": {"tasks": {"linear_slip": {"duration": 0.2, "settle": 0.1, "hold": 0.1}}}}
KINDS = {
    "flat": (LINEAR, SHORT),
    "randomized groups": (LINEAR, {**SHORT, "observation_mode": "dict", "randomization": "train"}),
    "history": (LINEAR, {**SHORT, "history": 2, "frame_skip": 3}),
    "wrist": (
        "slipgym/Hold-v0",
        {
            "action_mode": "grip_force_wrist",
            "frame_skip": 8,
            "config": {"tasks": {"hold": {"duration": 2.0}}},
        },
    ),
}


@pytest.fixture
def make():
    made = []

    def make(num_envs=3, env_id=LINEAR, **keywords):
        made.append(policies.make_vec_env(env_id, num_envs, **{"threads": 1, **SHORT, **keywords}))
        return made[-1]

    yield make
    for envs in made:
        envs.close()


def dummy(n, env_id, seed, **keywords):
    def one():
        return TaskEnd(gym.make(env_id, engine="planar", disable_env_checker=True, **keywords))

    envs = vec_env.VecMonitor(vec_env.DummyVecEnv([one] * n))
    envs.seed(seed)
    return envs


def equal(a, b):
    """Whether nested infos and observations are the same in type and every bit."""
    if isinstance(a, dict):
        return isinstance(b, dict) and a.keys() == b.keys() and all(equal(a[key], b[key]) for key in a)
    if isinstance(a, np.ndarray):
        return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()
    return type(a) is type(b) and a == b


def without_clock(info):
    """An info without the time on the wall at which the episode ended."""
    return {**info, "episode": {key: info["episode"][key] for key in ("r", "l")}}


def actions(envs, steps, seed=0):
    """Random ones; the first environment lets the box fall."""
    drawn = np.random.default_rng(seed).uniform(-1, 1, (steps, envs.num_envs, *envs.action_space.shape))
    drawn[:, 0] = -1.0
    return drawn.astype(np.float32)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("threads", "limit"), [(1, None), (2, None), (1, 10)])
def test_equals_a_dummy_vec_env(make, kind, threads, limit):
    env_id, keywords = KINDS[kind]
    told = {"threads": threads, "max_episode_steps": limit, "privileged": True}
    ours = make(3, env_id, seed=7, **{"config": None, **told, **keywords})
    theirs = dummy(3, env_id, 7, max_episode_steps=limit, **keywords)
    assert ours.observation_space == theirs.observation_space
    assert ours.action_space == theirs.action_space
    assert equal(ours.reset(), dict(found) if isinstance(found := theirs.reset(), dict) else found)
    assert all(map(equal, ours.venv.reset_infos, theirs.venv.reset_infos))
    seen = set()
    for action in actions(ours, 180):
        found, wanted = ours.step(action), theirs.step(action)
        for a, b in zip(found[:3], wanted[:3], strict=True):
            assert equal(a, dict(b) if isinstance(b, dict) else b)
        for done, a, b in zip(found[2], found[3], wanted[3], strict=True):
            assert a == {} if not done else equal(without_clock(a), without_clock(b))
            seen |= {a["TimeLimit.truncated"]} if done else set()
        assert all(map(equal, ours.venv.reset_infos, theirs.venv.reset_infos))
    theirs.close()
    assert True in seen if limit else seen == {False}


def test_options_and_seeds_are_used_once(make):
    ours, theirs = make(2, seed=1), dummy(2, LINEAR, 1, **SHORT)
    for envs in (ours, theirs):
        envs.set_options([{"object_mass": 0.35}, {}])
    assert equal(ours.reset(), theirs.reset())
    assert [box.mass == 0.35 for box in ours.env.simulation.boxes] == [True, False]
    assert equal(ours.reset(), theirs.reset())
    assert [box.mass == 0.35 for box in ours.env.simulation.boxes] == [False, False]
    theirs.close()


def test_what_was_returned_stays_as_it_was(make):
    envs = make(seed=0)
    envs.reset()
    found = [envs.step(action) for action in actions(envs, 40)]
    before = deepcopy(found)
    for action in actions(envs, 40):
        envs.step(action)
    for one, copy in zip(found, before, strict=True):
        assert all(map(equal, one[:3], copy[:3]))
        assert all(map(equal, one[3], copy[3]))
        assert len({id(info) for info in one[3]}) == 3


def test_attributes_and_methods(make):
    envs = make()
    batch = envs.unwrapped
    assert envs.get_attr("columns", [0, 2]) == [batch.env.columns] * 2
    assert envs.get_attr("action_space", 1) == [envs.action_space]
    assert envs.get_attr("render_mode") == [None] * 3
    assert envs.has_attr("config")
    assert not envs.has_attr("nothing")
    batch.set_attr("label", "a")
    assert envs.get_attr("label", -1) == ["a"]
    calls = []
    batch.set_attr("note", lambda one, more=0: calls.append(one + more) or len(calls), range(3))
    assert envs.env_method("note", 5) == [1] * 3
    assert envs.env_method("note", 5, more=2, indices=[2, 0, -2]) == [2] * 3
    assert calls == [5, 7]
    assert envs.env_is_wrapped(gym.Wrapper, [1, 2]) == [False, False]


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda envs: envs.get_attr("columns", 3), "indices: 3 must be a whole number from 0 to 2"),
        (lambda envs: envs.env_is_wrapped(gym.Wrapper, [-4]), "indices: -4 must"),
        (lambda envs: envs.set_attr("label", "a", 0), "indices = 0: all 3 environments share .*'label'"),
        (lambda envs: envs.env_method("reset", indices=[0, 1]), "all 3 environments share the method"),
        (lambda envs: envs.step(np.zeros((2, 1), dtype=np.float32)), "shape"),
    ],
)
def test_refuses(make, call, words):
    envs = make()
    envs.reset()
    with pytest.raises(ValueError, match=words):
        call(envs.unwrapped)


def test_a_step_needs_a_reset(make):
    with pytest.raises(RuntimeError, match="reset"):
        make().step(np.zeros((3, 1), dtype=np.float32))


@pytest.mark.parametrize("mode", ["NextStep", "Disabled"])
def test_another_autoreset_mode_is_refused(mode):
    batch = gym.make_vec(LINEAR, 2, "vector_entry_point", autoreset_mode=mode)
    with pytest.raises(ValueError, match=f"'{mode}' must be 'SameStep'"):
        SlipVecEnv(batch)
    batch.close()


def test_pictures_are_tiled(make):
    envs = make(render_mode="rgb_array", render_rows=(0, 2))
    envs.reset()
    first, second = envs.get_images()
    height, width, _ = first.shape
    tiled = envs.render()
    assert tiled.shape[0] * tiled.shape[1] == 2 * height * width
    assert np.array_equal(tiled[:height, :width], first)
    assert np.array_equal(tiled[-height:, -width:], second)


def test_closing_twice_is_harmless(make):
    envs = make()
    envs.close()
    envs.close()
    with pytest.raises(RuntimeError, match="closed"):
        envs.reset()
