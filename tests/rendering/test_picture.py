"""Pictures show what is there and change nothing."""

import gymnasium as gym
import numpy as np
import pytest

from slipgym.registration import ENVIRONMENTS
from slipgym.rendering import camera

pytestmark = pytest.mark.quick_tasks

IDS = tuple(ENVIRONMENTS)


def view(picture: np.ndarray) -> np.ndarray:
    """The scene without the words above and below it."""
    return picture[50 : camera.HEIGHT - 46, : camera.WIDTH]


def test_a_picture_is_the_callers_own(make, env_id):
    env = make(env_id)
    env.reset(seed=0)
    first = env.render()
    assert first.shape == (480, 720, 3)
    assert first.dtype == np.uint8
    assert first.flags.owndata
    kept = first.copy()
    first[:] = 0
    np.testing.assert_array_equal(env.render(), kept)


def test_pictures_repeat(make, env_id):
    def film(env) -> list[np.ndarray]:
        env.reset(seed=3)
        pictures = []
        for _ in range(20):
            env.step(np.float32([-0.9]))
            pictures.append(env.render())
        return pictures

    env = make(env_id)
    first = film(env)
    np.testing.assert_array_equal(film(env), first)
    np.testing.assert_array_equal(film(make(env_id)), first)


@pytest.mark.parametrize(
    ("mode", "env_id"),
    [("rgb_array", name) for name in IDS[:5]] + [("depth_array", IDS[0]), ("human", IDS[0])],
)
def test_rendering_does_not_change_the_simulation(make, env_id, mode, hidden_screen):
    def play(mode: str | None) -> list[str]:
        env = make(env_id, render_mode=mode)
        with np.printoptions(precision=17, floatmode="unique"):
            said = [repr(env.reset(seed=1))]
            for action in np.random.default_rng(1).uniform(-1.0, 1.0, (30, 1)):
                said.append(repr(env.step(action)))
                env.render()
            return said

    assert play(mode) == play(None)


def lowest(picture: np.ndarray) -> int:
    """Row of a wooden object's lower end."""
    return int(np.flatnonzero((picture[..., 0].astype(int) - picture[..., 2] > 60).any(axis=1)).max())


def test_a_slide_moves_the_object_down_and_leaves_its_outline(make):
    env = make()
    env.reset(seed=0, options={"object_mass": 0.3, "material": "wood"})
    before = view(env.render())
    while env.step(np.float32([-1.0]))[4]["slip"][1] > -0.02:
        pass
    after = view(env.render())
    assert lowest(after) > lowest(before) + 10
    blue = (np.abs(after.astype(int) - (0x00, 0x72, 0xB2)).max(axis=-1) < 40).sum()
    assert blue > 200  # outline and arrow


def test_an_object_that_fell_leaves_the_picture(make, changed):
    env = make()
    env.reset(seed=0)
    held = env.render()
    for _ in range(120):
        env.step(np.float32([-1.0]))
    assert changed(view(held), view(env.render())).sum() > 10_000
    assert view(env.render()).min() < 100  # the gripper is still there


def test_the_material_is_seen(make, changed):
    env = make()
    pictures = []
    for material in env.config.materials:
        env.reset(seed=0, options={"material": material})
        pictures.append(view(env.render()))
    for i, first in enumerate(pictures):
        assert all(changed(first, second).sum() > 5000 for second in pictures[i + 1 :])


def test_a_material_of_ones_own_can_be_drawn(make):
    env = make(config={"materials": {"glass": {"mu_c": 0.2, "mu_s": 0.3}}}, material="glass")
    env.reset(seed=0)
    assert env.render().shape == (480, 720, 3)


@pytest.mark.parametrize("size", [(0.04, 0.005, 0.04), (2.0, 1.0, 2.0)])
def test_any_object_can_be_drawn(make, size):
    env = make()
    env.reset(seed=0, options={"object_size": size, "object_mass": 0.2})
    assert env.render().shape == (480, 720, 3)


def test_a_harder_grip_has_longer_arrows(make):
    env = make()

    def dark(force: float) -> int:
        env.reset(seed=0, options={"initial_force": force, "material": "cardboard"})
        return int((view(env.render()).max(axis=-1) < 45).sum())

    assert dark(4.0) < dark(8.0) < dark(16.0)


def test_friction_is_drawn_where_there_is_some(make):
    env = make()

    def orange(mass: float) -> int:
        env.reset(seed=0, options={"object_mass": mass, "material": "case"})
        return int((np.abs(view(env.render()).astype(int) - (0xD5, 0x5E, 0x00)).max(axis=-1) < 40).sum())

    assert orange(0.01) < orange(0.2) < orange(0.4)


def test_depths(make, env_id):
    env = make(env_id, render_mode="depth_array")
    env.reset(seed=0)
    depth = env.render()
    assert depth.shape == (480, 448)
    assert depth.dtype == np.float32
    seen = np.isfinite(depth)
    x, z = env.unwrapped.simulation.plant.world["com"][0]
    right, down, _ = env.unwrapped._renderer._camera.project(np.array([x, 0.0, z]))
    assert seen[int(down / camera.FINE), int(right / camera.FINE)]
    assert seen.mean() < 0.5
    assert np.all(depth[seen] > 0.3)
    assert np.all(depth[seen] < 3.0)


def test_the_depth_of_a_wide_face_is_its_distance(make):
    env = make(render_mode="depth_array")
    env.reset(seed=0, options={"object_size": (0.2, 0.02, 0.2), "object_mass": 0.2})
    held = env._renderer._camera
    corner = np.array([0.06, -0.01, 0.05])
    x, y, near = held.project(corner)
    assert env.render()[int(y / camera.FINE), int(x / camera.FINE)] == pytest.approx(1.0 / near, rel=2e-3)


def test_without_a_reset_there_is_nothing_to_see(make):
    with pytest.raises(RuntimeError, match=r"call reset\(\) first"):
        make().render()


def test_without_a_render_mode_there_is_no_picture_and_nothing_is_kept(make):
    env = make(render_mode=None)
    env.reset(seed=0)
    assert env.render() is None
    assert env._renderer is None


def test_collected_and_observed_pictures(env_id):
    env = gym.make(env_id, render_mode="rgb_array_list", frame_skip=4, action_mode="grip_force")
    env.reset(seed=0)
    for _ in range(3):
        env.step(np.float32([0.0]))
    pictures = env.render()
    assert [picture.shape for picture in pictures] == [(480, 720, 3)] * 4
    env.close()
    seen = gym.wrappers.AddRenderObservation(gym.make(env_id, render_mode="rgb_array"))
    stacked = gym.wrappers.FrameStackObservation(seen, 2)
    observation, _ = stacked.reset(seed=0)
    assert observation.shape == (2, 480, 720, 3)
    stacked.close()


def test_a_restored_state_begins_a_new_strip(make, changed):
    env = make()
    env.reset(seed=0)
    for _ in range(30):
        env.step(np.float32([0.5]))
    state, picture = env.get_state(), env.render()
    other = make()
    other.set_state(state)
    np.testing.assert_array_equal(view(other.render()), view(picture))
    assert changed(other.render()[:, camera.WIDTH :], picture[:, camera.WIDTH :]).any()


GREEN = np.array([0x00, 0x9E, 0x73])


def greens(picture: np.ndarray) -> np.ndarray:
    """Pixels (row, column) of the view in the colour of the target, without the words below it."""
    part = picture[50 : camera.HEIGHT - 70, : camera.WIDTH].astype(int)
    return np.argwhere(np.abs(part - GREEN).max(axis=-1) < 40)


def test_the_target_is_drawn_where_the_object_is_to_be(make):
    def below(distance: float) -> int:
        """Rows from the object's lower end to that of the target."""
        env = make(engine="planar")
        env.reset(seed=0, options={"distance": distance, "material": "wood"})
        picture = env.render()
        assert len(greens(picture)) > 50
        return greens(picture)[:, 0].max() - lowest(view(picture))

    assert below(0.03) > below(0.01) + 5
    hold = make("slipgym/Hold-v0", engine="planar")
    hold.reset(seed=0)
    assert len(greens(hold.render())) == 0


def test_a_solved_object_covers_its_target():
    """The outline at the target is that of an object with the target as its slip."""
    from slipgym.rendering.poses import held_at
    from slipgym.rendering.stage import View
    from slipgym.world.scene import Box

    box = Box((0.16, 0.03, 0.2), (0.01, 0.02), (0.03, -0.04), 0.2, 1e-3)
    pitch, pose = 0.4, (0.004, -0.012, 0.3)
    angle = pitch + pose[2]

    def turn(by: float) -> np.ndarray:
        return np.array([[np.cos(by), 0.0, -np.sin(by)], [0.0, 1.0, 0.0], [np.sin(by), 0.0, np.cos(by)]])

    grasp = np.array([0.03, 0.0, -0.04]) - (0.01, 0.0, 0.02)  # from the centre of mass, on the object's axes
    at = turn(pitch) @ [pose[0], 0.0, pose[1]]
    view = View(box, "wood", at - turn(angle) @ grasp, turn(angle), (0.0, 0.0, pitch), 0.015)
    eye = camera.framing(np.array([[-0.2, 0.0, -0.2], [0.2, 0.0, 0.2]]))
    corners, _ = held_at(view, pose, eye, (0, 0, 0))
    seen = corners.reshape(-1, 3)[:, :2]
    front = np.array([(x, -0.015, z) for x in (-0.08, 0.08) for z in (-0.1, 0.1)])
    for corner in eye.project(view.carry(front))[:, :2]:
        assert np.linalg.norm(seen - corner, axis=1).min() < 4.0
