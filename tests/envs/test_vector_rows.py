"""Row i of a batch is, bit for bit, the scalar planar environment with its seed."""

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode, SyncVectorEnv

from tests.vector_checker.compare import difference
from tests.vector_checker.returned import info_of

pytestmark = pytest.mark.quick_tasks

PLAIN = {}
FULL = {
    "randomization": "train",
    "observation_mode": "dict",
    "history": 2,
    "action_mode": "grip_force_wrist",
    "frame_skip": 3,
    "friction_source": "true",
}
BARE = {
    "friction_source": "none",
    "action_mode": "force_increment",
    "sensors": "ideal",
    "observation_mode": "sensor",
    "frame_skip": 2,
}
NOMINAL = {"friction_source": "nominal", "action_mode": "grip_force_pitch", "material": "wood", "history": 1}


def by_row(said) -> list:
    """What `reset` or `step` returned, the infos sorted by rows."""
    *rest, infos = said
    return [*rest, [info_of(infos, i) for i in range(len(infos["time"]))]]


def scalars(env_id, n, mode=AutoresetMode.NEXT_STEP, **arguments):
    """n scalar environments, stepped by Gymnasium."""
    made = [lambda: gym.make(env_id, engine="planar", **arguments).unwrapped] * n
    return SyncVectorEnv(made, autoreset_mode=mode)


def play(env, steps, seed=3):
    """Everything that is returned while held actions let many objects fall."""
    said = [env.reset(seed=seed)]
    rng = np.random.default_rng(0)
    shape = env.single_action_space.shape
    for k in range(steps):
        if k % 10 == 0:
            actions = rng.uniform(-1.0, 0.2, (5, *shape)).astype(np.float32)[: env.num_envs]
        said.append(env.step(actions))
    env.close()
    return said


def assert_equal(a, b):
    for k, (one, other) in enumerate(zip(a, b, strict=True)):
        unlike = difference(by_row(one), by_row(other))
        assert not unlike, f"step {k}: {unlike}"


def ended(said) -> int:
    return sum(int((step[2] | step[3]).sum()) for step in said[1:])


@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP])
@pytest.mark.parametrize(
    ("arguments", "steps"),
    [
        pytest.param(FULL, 280, id="full"),
        pytest.param(PLAIN, 800, id="plain", marks=pytest.mark.slow),
        pytest.param(BARE, 400, id="bare", marks=pytest.mark.slow),
    ],
)
def test_equals_scalar_environments_stepped_by_gymnasium(env_id, arguments, steps, mode):
    said = play(gym.make_vec(env_id, num_envs=3, autoreset_mode=mode, **arguments), steps)
    assert ended(said) >= 3
    assert_equal(said, play(scalars(env_id, 3, mode, **arguments), steps))


def test_nominal_friction_and_pitch(env_id):
    said = play(gym.make_vec(env_id, num_envs=2, **NOMINAL), 100)
    assert_equal(said, play(scalars(env_id, 2, **NOMINAL), 100))


def test_patches_of_cells():
    arguments = {"contact": "distributed", "randomization": "train", "config": {"contact": {"cells": 5}}}
    said = play(gym.make_vec("slipgym/LinearSlip-v0", num_envs=3, threads=2, **arguments), 60)
    assert_equal(said, play(scalars("slipgym/LinearSlip-v0", 3, **arguments), 60))


@pytest.mark.parametrize("threads", [1, 2, 3])
def test_number_of_rows_and_threads_do_not_matter(env_id, threads):
    arguments = {"randomization": "train", "frame_skip": 3}
    alone = play(gym.make_vec(env_id, num_envs=1, threads=threads, **arguments), 60)
    three = play(gym.make_vec(env_id, num_envs=3, threads=1, **arguments), 60)
    five = play(gym.make_vec(env_id, num_envs=5, threads=threads, **arguments), 60)
    for few, many in ((alone, three), (three, five)):
        for one, other in zip(few, many, strict=True):
            n = len(one[0])
            rows = [part[:n] for part in by_row(other)]
            assert not difference(by_row(one), rows)


def test_default_threads_change_nothing():
    """More rows than a block holds, as many threads as there are processors."""
    made = [gym.make_vec("slipgym/Hold-v0", num_envs=80, threads=threads) for threads in (None, 1)]
    said = []
    for env in made:
        steps = [env.reset(seed=0)]
        for k in range(30):
            steps.append(env.step(np.full((80, 1), np.sin(k), np.float32)))
        env.close()
        said.append(steps)
    assert_equal(*said)


def test_reset_by_mask_equals_scalar_resets_and_leaves_the_rest(env_id):
    made = (
        gym.make_vec(env_id, num_envs=3, autoreset_mode="Disabled"),
        scalars(env_id, 3, AutoresetMode.DISABLED),
    )
    rng = np.random.default_rng(1)
    said = [[env.reset(seed=2)] for env in made]
    for k in range(60):
        actions = rng.uniform(-1.0, 1.0, made[0].action_space.shape).astype(np.float32)
        masks = [np.array([k % 2 == 0, False, True]) for _ in made]
        for steps, env, mask in zip(said, made, masks, strict=True):
            steps.append(env.step(actions))
            ended = steps[-1][2] | steps[-1][3]  # Explore's agent can end an episode
            if k % 20 == 9:
                steps.append(env.reset(seed=[k, k + 1, None], options={"reset_mask": mask | ended}))
            elif ended.any():
                steps.append(env.reset(seed=[k, k + 1, None], options={"reset_mask": ended}))
    assert_equal(*said)
    for env in made:
        env.close()


def test_options_of_rows(env_id):
    common = {"object_mass": 0.3, "mu_c": 0.4}
    rows = [None, {"mu_s": 0.9, "object_mass": 0.2}, {"material": "plastic"}]
    env = gym.make_vec(env_id, num_envs=3, randomization="train")
    said = [env.reset(seed=5, options={**common, "rows": rows})]
    zeros = np.zeros(env.action_space.shape, np.float32)
    said += [env.step(zeros) for _ in range(5)]
    env.close()
    for i, row in enumerate(rows):
        one = gym.make(env_id, engine="planar", randomization="train").unwrapped
        observation, info = one.reset(seed=5 + i, options={**common, **(row or {})})
        np.testing.assert_array_equal(said[0][0][i], observation)
        for step in said[1:]:
            observation, reward, *_, info = one.step(zeros[0])
            np.testing.assert_array_equal(step[0][i], observation)
            assert step[1][i] == reward
            np.testing.assert_array_equal(step[-1]["true"][i], info["true"])
        one.close()


@pytest.mark.parametrize(
    "row", [{"material": "nope"}, {"mu_s": 0.3, "mu_c": 0.5}, {"cop_offset": [1.0, 1.0]}, {"nope": 1.0}]
)
def test_an_error_names_the_row(row):
    envs = gym.make_vec("slipgym:slipgym/Hold-v0", num_envs=3)
    with pytest.raises(ValueError, match=r"options\['rows'\]\[1\]: "):
        envs.reset(seed=0, options={"rows": [None, row, None]})
    with pytest.raises(ValueError, match="unknown material 'nope'") as common:
        envs.reset(seed=0, options={"material": "nope", "rows": [None, {"mu_s": 0.7}, None]})
    assert "rows" not in str(common.value)
    assert common.value.__cause__ is None  # raised again as it was, with the traceback of a task of one's own
