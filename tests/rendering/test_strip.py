"""The strip's curves are the episode's."""

import numpy as np
import pytest

import policies
from policies.task_names import own_policy
from slipgym.tasks import TASKS


@pytest.mark.parametrize("frame_skip", [1, 3])
def test_every_sample_is_kept(make, frame_skip):
    env = make(frame_skip=frame_skip)
    env.reset(seed=0, options={"material": "wood"})
    infos, dropped = [], False
    while not dropped:
        _, _, dropped, _, info = env.step(np.float32([-0.93]))
        infos.append(info)
    history = env._renderer._history
    assert history.step == round(infos[-1]["time"] * 120)
    infos = infos[: history.step // frame_skip]  # the last step may have broken off
    for name in ("grip_1", "path", "reference"):
        assert np.isfinite(history.column(name)).all()
    at = slice(frame_skip, None, frame_skip)
    np.testing.assert_array_equal(history.column("grip_2")[at], [i["grip_force"][1] for i in infos])
    np.testing.assert_allclose(history.column("path")[at], [-1e3 * i["slip"][1] for i in infos])
    np.testing.assert_allclose(history.column("reference")[at], [1e3 * i["reference"][0] for i in infos])
    assert history.column("path")[-1] > 1.0
    assert history.column("mu_c")[at][-1] == infos[-1]["estimated"][1]
    assert np.isnan(history.column("mu_c")[0])  # no slip yet, no estimate


def test_a_new_episode_has_a_new_strip(make, changed):
    env = make()
    env.reset(seed=0)
    first = env.render()
    for _ in range(50):
        env.step(np.float32([-0.9]))
    assert changed(first, env.render())[:, 448:].sum() > 100
    env.reset(seed=0)
    np.testing.assert_array_equal(env.render(), first)


def test_the_plotted_path_follows_the_reference(make):
    """Signs agree: each task's own controller keeps near the dashed line."""
    for env_id in ("slipgym/LinearSlip-v0", "slipgym/RotationalSlip-v0", "slipgym/Hinge-v0"):
        env = make(env_id)
        policy = policies.make(own_policy(env.task.name))
        (observation, _), state = env.reset(seed=0, options={"duration": 3.0}), None
        while env.simulation.time < 2.5:
            action, state = policy.predict(observation, state=state)
            observation = env.step(action)[0]
        history = env._renderer._history
        path, reference = history.column("path")[-1], history.column("reference")[-1]
        assert path == pytest.approx(reference, rel=0.3)
        assert abs(reference) > 10.0


SLIP = np.array([0.003, -0.004, 0.5])


@pytest.mark.parametrize(
    ("task", "title", "path", "target"),
    [
        ("LinearSlip", "slid down [mm]", 4.0, 500.0),
        ("RotationalSlip", "turned by gravity [°]", -np.degrees(0.5), np.degrees(0.5)),
        ("Hinge", "turned in the grip [°]", np.degrees(0.5), -np.degrees(0.5)),
        ("Hold", "slid [mm]", 5.0, 0.0),
    ],
)
def test_the_motion_of_each_task(task, title, path, target):
    motion = TASKS[task].motion
    assert motion.title == title
    assert motion.path(SLIP) == pytest.approx(path)
    assert motion.target(0.5) == pytest.approx(target)
    assert motion.goal in {"", *(column.name for column in TASKS[task].columns)}


def test_steps_beyond_the_end_of_an_episode_are_kept(make):
    env = make(engine="planar", render_mode="rgb_array")
    env.reset(seed=0, options={"duration": 0.1, "distance": 0.002})
    over = False
    while not over:
        _, _, terminated, truncated, _ = env.step(env.action_space.high)
        over = terminated or truncated
    for _ in range(3):
        env.step(env.action_space.high)
    assert env.render().any()
