"""Pictures show what is there and change nothing."""

import gymnasium as gym
import numpy as np
import pytest

import slipgym  # noqa: F401

IDS = ("slipgym/LinearSlip-v0", "slipgym/Hold-v0")


@pytest.fixture(params=IDS)
def env(request):
    env = gym.make(request.param, render_mode="rgb_array").unwrapped
    yield env
    env.close()


def changed(before: np.ndarray, after: np.ndarray) -> int:
    """Pixels that differ by more than noise of rounding."""
    return int((np.abs(before.astype(int) - after).max(axis=-1) > 8).sum())


def test_a_picture_is_the_callers_own(env):
    env.reset(seed=0)
    first = env.render()
    assert first.shape == (480, 480, 3)
    assert first.dtype == np.uint8
    assert first.flags.owndata
    kept = first.copy()
    first[:] = 0
    np.testing.assert_array_equal(env.render(), kept)


def test_pictures_repeat(env):
    films = []
    for _ in range(2):
        env.reset(seed=3)
        film = []
        for _ in range(20):
            env.step(np.float32([-0.9]))
            film.append(env.render())
        films.append(film)
    np.testing.assert_array_equal(*films)


def test_rendering_does_not_change_the_simulation(env):
    def play(rendering: bool) -> list[str]:
        with np.printoptions(precision=17, floatmode="unique"):
            said = [repr(env.reset(seed=1))]
            for action in np.random.default_rng(1).uniform(-1.0, 1.0, (60, 1)):
                said.append(repr(env.step(action)))
                if rendering:
                    env.render()
            return said

    assert play(rendering=True) == play(rendering=False)


def test_a_slide_moves_the_object_down(env):
    env.reset(seed=0, options={"object_mass": 0.3})
    before = env.render()
    while env.step(np.float32([-1.0]))[4]["slip"][1] > -0.03:
        pass
    after = env.render()
    rows = np.flatnonzero((np.abs(before.astype(int) - after).max(axis=-1) > 8).any(axis=1))
    assert changed(before, after) > 1000
    assert rows.max() > 330  # below where the lower edge was


def test_an_object_that_fell_leaves_the_picture(env):
    env.reset(seed=0)
    held = env.render()
    for _ in range(120):
        env.step(np.float32([-1.0]))
    assert changed(held, env.render()) > 10_000
    assert env.render().min() < 100  # the gripper is still there


def test_the_material_is_seen(env):
    pictures = {}
    for material in env.config.materials:
        env.reset(seed=0, options={"material": material})
        pictures[material] = env.render()
    names = list(pictures)
    for i, first in enumerate(names):
        assert all(changed(pictures[first], pictures[second]) > 5000 for second in names[i + 1 :])


def test_the_object_hides_finger_1_and_shows_through_finger_2(env):
    env.reset(seed=0, options={"material": "plastic"})
    red, _, blue = env.render()[215, 255].astype(int)  # on the near pad
    assert red > blue + 20


@pytest.mark.parametrize("size", [(0.04, 0.005, 0.04), (2.0, 1.0, 2.0)])
def test_any_object_can_be_drawn(env, size):
    env.reset(seed=0, options={"object_size": size, "object_mass": 0.2})
    assert env.render().shape == (480, 480, 3)


def test_without_a_reset_there_is_nothing_to_see(env):
    with pytest.raises(RuntimeError, match=r"call reset\(\) first"):
        env.render()


def test_without_a_render_mode_there_is_no_picture():
    env = gym.make(IDS[0]).unwrapped
    env.reset(seed=0)
    assert env.render() is None
    env.close()
