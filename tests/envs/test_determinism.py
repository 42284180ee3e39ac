"""The same seed gives the same bits: in another process, after other episodes, beside other environments."""

from pathlib import Path

import numpy as np
import pytest

from slipgym.registration import ENVIRONMENTS

pytestmark = pytest.mark.quick_tasks

SCRIPT = str(Path(__file__).with_name("rollout.py"))


@pytest.mark.parametrize(
    "ids", [list(ENVIRONMENTS)[:1], pytest.param(list(ENVIRONMENTS), marks=pytest.mark.slow)]
)
def test_same_bits_in_another_process_and_after_other_episodes(python, ids):
    plain = python(SCRIPT, *ids)
    assert len(plain.splitlines()) == len(set(plain.split()[1::2])) == len(ids)
    assert plain == python(SCRIPT, *ids, "--disturbed")


def test_same_bits_after_other_episodes(make, env_id, play):
    alone = play(make(env_id), seed=3)
    env = make(env_id)
    play(env, seed=1, options={"object_mass": 0.4, "com_offset": (0.0, 0.02)})
    play(env, seed=2, options={"mu_s": 0.3, "mu_c": 0.2, "initial_force": 1.0})
    env.reset()
    assert play(env, seed=3) == alone


def test_the_first_mass_leaves_no_trace(make, play):
    heavy, light = make(), make()
    play(heavy, options={"object_mass": 0.4}, steps=1)
    play(light, options={"object_mass": 0.1}, steps=1)
    assert play(heavy) == play(light)


def test_unseeded_resets_repeat_after_a_seeded_one(make, env_id):
    first, second = make(env_id), make(env_id)
    first.reset(seed=5)
    second.reset(seed=5)
    for _ in range(3):
        assert repr(first.reset()) == repr(second.reset())


def test_another_seed_gives_another_episode(make, env_id, play):
    env = make(env_id)
    assert play(env, seed=1, steps=5) != play(env, seed=2, steps=5)


def test_two_environments_in_turn_do_not_touch_each_other(make, env_id, play):
    alone = [play(make(env_id), seed=seed) for seed in (1, 2)]
    pair = make(env_id), make(env_id)
    together = [[repr(env.reset(seed=seed))] for env, seed in zip(pair, (1, 2), strict=True)]
    actions = [np.random.default_rng(seed).uniform(-1.0, 1.0, (60, 1)).astype(np.float32) for seed in (1, 2)]
    for step in range(60):
        for i in (1, 0):
            together[i].append(repr(pair[i].step(actions[i][step])))
    assert together == alone
