"""What users of Gymnasium are used to: a spec with a horizon, limits, copies that keep everything."""

import copy
import pickle
import subprocess
import sys
from types import SimpleNamespace

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.envs.registration import EnvSpec
from gymnasium.vector import AutoresetMode
from gymnasium.wrappers import TimeAwareObservation

from slipgym.envs import HoldEnv
from slipgym.envs.vector_env import SlipVectorEnv

HOLD = "slipgym/Hold-v0"
LONGER = {"tasks": {"hold": {"duration": 9.0}}}
COPIES = {
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
    "pickle": lambda env: pickle.loads(pickle.dumps(env)),
}
MAKE = {
    "scalar": lambda **more: gym.make(HOLD, engine="planar", **more).unwrapped,
    "vector": lambda **more: gym.make_vec(HOLD, num_envs=2, **more),
}


class OwnEnv(HoldEnv):
    """A user's subclass whose constructor needs an argument that slipgym does not know."""

    def __init__(self, bonus, **arguments):
        super().__init__(**arguments)
        self.bonus = bonus


class OwnVectorEnv(SlipVectorEnv):
    def __init__(self, bonus):
        super().__init__("Hold", num_envs=2)
        self.bonus = bonus


@pytest.fixture
def own_id():
    """An id of the user's with a limit of its own."""
    name = "mine/Hold-v0"
    batch = "slipgym.envs.vector_env:HoldVectorEnv"
    gym.register(name, "slipgym.envs:HoldEnv", max_episode_steps=4, vector_entry_point=batch)
    yield name
    del gym.registry[name]


def length(env) -> int:
    """Steps until an episode is truncated, of a single environment or of all of a batch."""
    env.reset(seed=0)
    for count in range(1, 3000):
        truncated = env.step(np.zeros(env.action_space.shape, np.float32))[3]
        if np.all(truncated):
            return count
    raise AssertionError("never truncated")


@pytest.mark.parametrize("arguments", [{}, {"frame_skip": 7}, {"config": LONGER}, {"max_episode_steps": 6}])
def test_a_spec_tells_the_horizon(arguments):
    env = gym.make(HOLD, engine="planar", **arguments)
    envs = gym.make_vec(HOLD, num_envs=2, **arguments)
    assert env.spec.max_episode_steps == envs.spec.max_episode_steps == length(env) == length(envs)
    wrapped = TimeAwareObservation(env, flatten=False)
    assert wrapped.observation_space["time"].high == env.spec.max_episode_steps


def test_the_horizon_of_every_task_is_its_length(env_id):
    env = gym.make(env_id, engine="planar", frame_skip=5)
    env.reset(seed=3)
    steps = env.unwrapped.simulation.episode["steps"].item()
    assert env.spec.max_episode_steps == -(-steps // 5)


def test_reset_options_lengthen_an_episode_beyond_the_horizon():
    env = gym.make(HOLD, engine="planar", frame_skip=60)
    env.reset(seed=0, options={"duration": 12.0})
    flags = [env.step(np.zeros(1, np.float32))[3] for _ in range(24)]
    assert flags == [False] * 23 + [True]


@pytest.mark.parametrize("mode", AutoresetMode)
def test_a_batch_is_limited_as_gym_make_limits_one(mode):
    """Truncated after 3 steps, again after 3, with the same numbers; time_left is that of the task."""
    envs = gym.make_vec(HOLD, num_envs=2, max_episode_steps=3, frame_skip=2, autoreset_mode=mode)
    one = gym.make(HOLD, engine="planar", max_episode_steps=3, frame_skip=2)
    seen, _ = envs.reset(seed=4)
    np.testing.assert_array_equal(seen[0], one.reset(seed=4)[0])
    for flag in (False, False, True):
        seen, _, _, truncated, infos = envs.step(np.zeros((2, 1), np.float32))
        expected, *_, cut, _ = one.step(np.zeros(1, np.float32))
        assert truncated.tolist() == [flag, flag]
        assert cut == flag
        last = infos["final_obs"][0] if flag and mode is AutoresetMode.SAME_STEP else seen[0]
        np.testing.assert_array_equal(last, expected)
    if mode is AutoresetMode.DISABLED:
        envs.reset(options={"reset_mask": np.ones(2, dtype=bool)})
    elif mode is AutoresetMode.NEXT_STEP:
        assert not envs.step(np.zeros((2, 1), np.float32))[3].any()
    flags = [envs.step(np.zeros((2, 1), np.float32))[3].all() for _ in range(3)]
    assert flags == [False, False, True]


def test_rows_that_begin_at_other_times_are_cut_at_other_times():
    envs = gym.make_vec(HOLD, num_envs=2, max_episode_steps=3, autoreset_mode="Disabled")
    envs.reset(seed=0)
    envs.step(np.zeros((2, 1), np.float32))
    envs.reset(options={"reset_mask": np.array([True, False])})
    flags = []
    for _ in range(2):
        flags.append(envs.step(np.zeros((2, 1), np.float32))[3].tolist())
    assert flags == [[False, False], [False, True]]


def test_an_own_id_has_its_limit(own_id):
    assert length(gym.make(own_id, engine="planar")) == 4
    for mode in (None, "sync"):
        more = {} if mode is None else {"engine": "planar"}
        assert length(gym.make_vec(own_id, num_envs=2, vectorization_mode=mode, **more)) == 4
    assert length(gym.make_vec(own_id, num_envs=2, max_episode_steps=2)) == 2
    free = gym.make_vec(own_id, num_envs=2, max_episode_steps=-1, frame_skip=60)
    assert free.spec.max_episode_steps == length(free) == 16


@pytest.mark.parametrize("limit", [0, -2, 1.5, True, "3"])
def test_a_limit_must_be_a_positive_whole_number(limit):
    with pytest.raises(ValueError, match=r"max_episode_steps = .* must be a whole number >= 1"):
        gym.make_vec(HOLD, max_episode_steps=limit)


@pytest.mark.parametrize(
    "arguments",
    [
        {},
        {"num_envs": np.int64(3), "frame_skip": np.int32(2), "threads": np.int64(1)},
        {"autoreset_mode": AutoresetMode.SAME_STEP, "max_episode_steps": 5},
        {"config": {"tasks": {"hold": {"duration": np.float32(2.0)}}}, "render_mode": np.str_("rgb_array")},
        {"vectorization_mode": "sync", "engine": "planar", "vector_kwargs": {"copy": False}},
    ],
)
def test_a_batch_is_made_again_of_its_spec(arguments):
    envs = gym.make_vec(HOLD, **arguments)
    again = gym.make_vec(EnvSpec.from_json(envs.spec.to_json()))
    assert again.spec == envs.spec
    assert (again.num_envs, type(again)) == (envs.num_envs, type(envs))
    envs.reset(seed=0)
    if isinstance(envs, SlipVectorEnv):
        again.set_state(envs.get_state())


def test_an_environment_is_made_again_of_its_spec():
    env = gym.make(HOLD, engine="planar", frame_skip=np.int64(3), history=np.uint8(2))
    for again in (gym.make(env.spec), env.spec.make(), EnvSpec.from_json(env.spec.to_json()).make()):
        assert again.spec == env.spec
        assert again.reset(seed=1)[0].tolist() == env.reset(seed=1)[0].tolist()


@pytest.mark.parametrize("way", COPIES)
@pytest.mark.parametrize("kind", MAKE)
@pytest.mark.parametrize("closed", [False, True])
def test_a_copy_keeps_spaces_and_what_the_user_has_set(kind, way, closed):
    env = MAKE[kind]()
    env.reset(seed=0)
    env.note, env.metadata["author"] = SimpleNamespace(text="mine"), "me"
    spaces = [name for name in vars(env) if name.endswith("_space")]
    for k, name in enumerate(spaces):
        getattr(env, name).seed(k)
        getattr(env, name).sample()
    if closed:
        env.close()
    other = COPIES[way](env)
    for name in spaces:
        mine, its = getattr(env, name).sample(), getattr(other, name).sample()
        np.testing.assert_array_equal(mine, its, err_msg=name)
    assert other.note == env.note
    assert (other.note is env.note) == (way == "copy")
    assert (other.metadata, other.spec) == (env.metadata, env.spec)
    other.metadata["author"] = "other"
    assert env.metadata["author"] == "me"


@pytest.mark.parametrize("way", COPIES)
@pytest.mark.parametrize("make", [lambda: OwnEnv(5.0, engine="planar"), lambda: OwnVectorEnv(5.0)])
def test_a_subclass_with_arguments_of_its_own_is_copied(make, way):
    env = make()
    env.reset(seed=0)
    env.me = env
    other = COPIES[way](env)
    assert (type(other), other.bonus) == (type(env), 5.0)
    assert (other.me is other) == (way != "copy")
    action = np.zeros(env.action_space.shape, np.float32)
    np.testing.assert_array_equal(env.step(action)[0], other.step(action)[0])


def test_a_mapping_inside_itself_is_refused():
    nested: dict = {"physics": {}}
    nested["physics"]["again"] = nested
    with pytest.raises(ValueError, match="nested deeper"):
        gym.make(HOLD, engine="planar", config=nested)


AUTO = """
import sys
sys.modules["pybullet"] = None
import gymnasium as gym, slipgym
from policies.evaluation import Experiment
envs = [gym.make("slipgym/Hold-v0") for _ in range(2)]
print(*(env.unwrapped.engine for env in envs), gym.make("slipgym/Hold-v0", engine="planar").unwrapped.engine)
print(envs[0].unwrapped.get_state().made_of["engine"])
asked = dict(name="x", task="hold", trials=1, policies=[{"name": "hold"}], friction=[{"source": "true"}])
print(Experiment(**asked).model_dump()["engine"])
"""


def test_without_pybullet_the_default_engine_is_planar_and_says_so_once():
    run = [sys.executable, "-W", "error", "-c", AUTO]
    done = subprocess.run(run, capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["planar"] * 5
    said = [line for line in done.stderr.splitlines() if "compiling" not in line]
    assert len(said) == 1
    assert "PyBullet is not installed" in said[0]


def test_with_pybullet_the_default_engine_is_bullet(caplog):
    env = gym.make(HOLD)
    assert env.unwrapped.engine == env.unwrapped.get_state().made_of["engine"] == "bullet"
    assert not caplog.records
    assert "engine" not in env.spec.kwargs
