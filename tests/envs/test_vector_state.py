"""Saved, restored, copied and pickled batches go on bit for bit; so do they in other processes."""

import copy
import multiprocessing
import pickle

import gymnasium as gym
import numpy as np
import pytest

from tests.vector_checker.compare import difference, spoil
from tests.vector_checker.returned import info_of

pytestmark = pytest.mark.quick_tasks

ID = "slipgym/LinearSlip-v0"
MADE = {"num_envs": 5, "randomization": "train", "history": 1, "frame_skip": 4, "threads": 2}


def actions(env, steps):
    rng = np.random.default_rng(7)
    held = rng.uniform(-1.0, 0.1, (steps // 10 + 1, *env.action_space.shape))
    return [held[k // 10].astype(np.float32) for k in range(steps)]


def go_on(env, steps=150):
    return [env.step(action) for action in actions(env, steps)]


def midway(env_id=ID, **arguments):
    """A batch in which some episodes are over, some go on."""
    env = gym.make_vec(env_id, **{**MADE, **arguments})
    env.reset(seed=4)
    for k, action in enumerate(actions(env, 300)):
        if k == 5:  # from now on not all of them end at the same time
            env.reset(options={"reset_mask": np.arange(env.num_envs) == 0})
        _, _, terminated, truncated, _ = env.step(action)
        over = terminated | truncated
        if over.any() and not over.all():
            return env
    raise AssertionError("no moment with some episodes over")


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_going_back_again_and_again(env_id, mode):
    env = midway(env_id, autoreset_mode=mode)
    state = env.get_state()
    said = go_on(env)
    env.set_state(state)
    assert not difference(said, go_on(env))
    other = gym.make_vec(env_id, **{**MADE, "autoreset_mode": mode, "threads": 1})
    other.reset(seed=1)
    other.set_state(pickle.loads(pickle.dumps(state)))
    assert not difference(said, go_on(other))
    assert not difference(env.reset(), other.reset())
    for each in (env, other):
        each.close()


def test_patches_of_cells_go_on_too():
    small = {"contact": {"cells": 5}}
    env = midway(contact="distributed", config=small, num_envs=3)
    twin = pickle.loads(pickle.dumps(env))
    assert not difference(go_on(env, 20), go_on(twin, 20))
    for each in (env, twin):
        each.close()


@pytest.mark.parametrize("duplicate", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
def test_copies_have_worlds_of_their_own(duplicate):
    env = midway(render_mode="rgb_array", render_rows=[1])
    twin = duplicate(env)
    said = go_on(env, 40)
    env.close()
    assert not difference(said, go_on(twin, 40))
    assert twin.spec == env.spec
    assert len(twin.render()) == 1
    twin.close()


def test_before_the_first_reset_and_after_closing():
    fresh = gym.make_vec(ID, **MADE)
    twin = copy.deepcopy(fresh)
    assert not difference(fresh.reset(), twin.reset())  # without a seed: the generators were copied
    fresh.close()
    with pytest.raises(RuntimeError, match="closed"):
        copy.deepcopy(fresh).reset()
    twin.close()


def test_rows_without_an_episode_stay_without():
    env = gym.make_vec(ID, num_envs=2, autoreset_mode="Disabled")
    env.reset(seed=0, options={"reset_mask": np.array([True, False])})
    twin = copy.deepcopy(env)
    with pytest.raises(RuntimeError, match=r"environments \[1\] have no episode"):
        twin.step(np.zeros((2, 1)))
    for each in (env, twin):
        each.close()


@pytest.mark.parametrize("arguments", [{}, {"observation_mode": "dict"}, {"history": 2}])
@pytest.mark.parametrize("mode", ["NextStep", "SameStep", "Disabled"])
def test_what_was_handed_out_is_the_callers_to_write_into(mode, arguments):
    """Nothing of it is read again, by a step, by a reset of other environments, or for a state."""
    config = {"tasks": {"linear_slip": {"duration": 0.2, "settle": 0.1, "hold": 0.1}}}
    envs = [gym.make_vec(ID, num_envs=4, autoreset_mode=mode, config=config, **arguments) for _ in range(2)]
    plain, spoiled = envs
    said, over, ends = [env.reset(seed=3) for env in envs], np.zeros(4, dtype=bool), 0
    for k, action in enumerate(actions(plain, 120)):
        assert not difference(*map(by_rows, said))
        spoil(said[1])
        if k % 20 == 10:
            state = spoiled.get_state()
            assert not difference(plain.get_state().frames, state.frames)
            spoiled.set_state(state)
        mask = over if mode == "Disabled" else np.array([k % 25 == 20, False, False, False])
        if mask.any():
            said = [env.reset(options={"reset_mask": mask}) for env in envs]
            assert not difference(*map(by_rows, said))
            spoil(said[1])
        said = [env.step(action) for env in envs]
        over = said[0][2] | said[0][3]
        ends += over.sum()
    assert ends > 4
    for env in envs:
        env.close()


def by_rows(said):
    """What a reset or a step said, with infos of the rows alone that have them."""
    return *said[:-1], [info_of(said[-1], i) for i in range(4)]


def test_refuses_the_state_of_another_kind():
    env = midway()
    state = env.get_state()
    for arguments, message in (
        ({"num_envs": 4}, "another num_envs: 5, here 4"),
        ({"autoreset_mode": "SameStep"}, "another autoreset_mode: 'NextStep', here 'SameStep'"),
        ({"history": 0}, "another history: 1, here 0"),
    ):
        other = gym.make_vec(ID, **{**MADE, **arguments})
        with pytest.raises(ValueError, match=message):
            other.set_state(state)
        other.close()
    scalar = gym.make(ID, engine="planar").unwrapped
    with pytest.raises(TypeError, match="must come from get_state"):
        scalar.set_state(state)
    with pytest.raises(TypeError, match="must come from get_state"):
        env.set_state(scalar.get_state())
    scalar.close()
    env.close()


def send(env, pipe):
    """In another process: go on, and tell."""
    pipe.send(go_on(env, 20))
    env.close()


@pytest.mark.parametrize("method", ["fork", "forkserver", "spawn"])
@pytest.mark.filterwarnings("ignore:.*multi-threaded, use of fork.*:DeprecationWarning")
def test_in_another_process(method):
    """A fork while threads wait in the parent, too."""
    context = multiprocessing.get_context(method)
    env = midway()
    here, there = context.Pipe()
    process = context.Process(target=send, args=(env, there))
    process.start()
    assert here.poll(120.0), "the other process hangs"
    said = here.recv()
    process.join(60.0)
    assert process.exitcode == 0
    assert not difference(said, go_on(env, 20))
    env.close()


def test_gymnasium_steps_batches_of_scalar_planar_environments_in_processes():
    made = [lambda: gym.make(f"slipgym:{ID}", engine="planar").unwrapped] * 2
    processes = gym.vector.AsyncVectorEnv(made, context="forkserver")
    batch = gym.make_vec(ID, num_envs=2)
    for env in (processes, batch):
        env.reset(seed=0)
    for _ in range(5):
        one, other = (env.step(np.full((2, 1), 0.3, np.float32)) for env in (processes, batch))
        assert not difference(one[:4], other[:4])
    processes.close()
    batch.close()
