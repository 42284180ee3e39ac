"""Pictures have the size that is asked for, and the object fills them."""

import copy
import re

import gymnasium as gym
import numpy as np
import pytest

import policies
from policies.stepping import steps
from policies.task_names import own_policy
from slipgym.rendering.camera import FINE

pytestmark = pytest.mark.quick_tasks

SIZE = 640, 480


def spread(env) -> tuple[np.ndarray, np.ndarray]:
    """First and last corner of the object in the view, over the view's width and height."""
    renderer, world = env._renderer, env.simulation.plant.world[0]
    front = renderer._view().front((0.0, 0.0, 0.0))
    middle = front.mean(axis=0)
    cos, sin = np.cos(world["angle"]), np.sin(world["angle"])
    turn = np.array([[cos, 0.0, -sin], [0.0, 1.0, 0.0], [sin, 0.0, cos]])
    corners = (front - middle) @ turn.T + np.array([world["com"][0], middle[1], world["com"][1]])
    layout = renderer._camera.layout
    seen = renderer._camera.project(corners)[:, :2] / FINE / (layout.width, layout.height)
    return seen.min(axis=0), seen.max(axis=0)


@pytest.mark.parametrize("size", [None, (84, 84), (1000, 400)])
def test_the_object_is_large_and_in_view_wherever_the_wrist_goes(env_id, size):
    policy = policies.make(own_policy(env_id))
    made = {"engine": "planar", "render_mode": "rgb_array", "render_size": size, **policies.modes(policy)}
    env = gym.make(env_id, disable_env_checker=True, **made).unwrapped
    observation, _ = env.reset(seed=3)
    for _ in steps(env, policy, observation):
        low, high = spread(env)
        assert low.min() > -0.02
        assert high.max() < 1.02
        assert (high - low).max() > 0.25
    env.close()


@pytest.mark.parametrize("size", [SIZE, [320, 240], np.array([1280, 720]), (33, 47), (500, 1000)])
def test_pictures_have_the_size_that_is_asked_for(make, size):
    width, height = (int(each) for each in size)
    for mode, shape in (("rgb_array", (height, width, 3)), ("depth_array", (height, width))):
        env = make(render_mode=mode, render_size=size, engine="planar")
        env.reset(seed=0)
        picture = env.render()
        assert picture.shape == shape
        assert picture.flags.owndata
        assert len(np.unique(picture)) > 20


def test_words_grow_with_the_picture_and_go_where_nobody_could_read_them(make):
    def dark(size: tuple[int, int]) -> float:
        """Share of the corner with the task's name that is as dark as words."""
        env = make(render_size=size, engine="planar")
        env.reset(seed=0)
        width, height = size
        return float((env.render()[: height // 16, : width // 6].max(axis=-1) < 90).mean())

    assert dark((1440, 960)) == pytest.approx(dark((720, 480)), rel=0.4)
    assert dark((720, 480)) > 0.02
    assert dark((360, 240)) == 0.0


@pytest.mark.parametrize(
    "size", [640, (640,), "640x480", (640, 480.0), (640, True), (16, 480), (640, 10_000), (640, None), {}]
)
def test_a_size_that_is_none_is_refused(make, size):
    words = f"render_size = {re.escape(repr(size))} must be two whole numbers from 32 to 4096"
    with pytest.raises(ValueError, match=words):
        make(render_size=size, engine="planar")
    with pytest.raises(ValueError, match=words):
        gym.make_vec("slipgym/Hold-v0", 1, "vector_entry_point", render_size=size)


def test_the_size_survives_specs_copies_states_and_vectors(make):
    env = gym.make("slipgym/Hold-v0", engine="planar", render_mode="rgb_array", render_size=SIZE)
    again = gym.make(gym.envs.registration.EnvSpec.from_json(env.spec.to_json()))
    for each in (env, again):
        each.reset(seed=1)
    twin = copy.deepcopy(env.unwrapped)
    assert twin.render().shape == again.render().shape == (480, 640, 3)
    plain = make("slipgym/Hold-v0", engine="planar", action_mode=None)
    plain.set_state(env.unwrapped.get_state())  # a state knows nothing of pictures
    assert plain.render().shape == (480, 720, 3)
    for mode in ("vector_entry_point", "sync"):
        envs = gym.make_vec("slipgym/Hold-v0", 2, mode, render_mode="rgb_array", render_size=SIZE)
        envs.reset(seed=1)
        np.testing.assert_array_equal(envs.render()[0].shape, (480, 640, 3))
        envs.close()


def test_the_camera_forgets_where_it_has_been(make):
    """A state shows the same view whether it was reached or restored."""
    env = make("slipgym/Carry-v0", engine="planar", action_mode=None)
    env.reset(seed=0)
    for _ in range(150):
        env.step(np.zeros(env.action_space.shape, np.float32))
    other = make("slipgym/Carry-v0", engine="planar", action_mode=None)
    other.set_state(env.get_state())
    np.testing.assert_array_equal(other.render()[:, :448], env.render()[:, :448])
