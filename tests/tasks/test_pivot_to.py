"""PivotTo: the angle that is drawn, the limits of the wrist, violation, success."""

import gymnasium as gym
import numpy as np
import pytest

import slipgym  # noqa: F401
from slipgym.tasks import TASKS

ID = "slipgym/PivotTo-v0"
GOAL = 0.8


@pytest.fixture
def arrived(hand):
    """The object rests at its goal after the time for the turn."""
    state = hand("PivotTo", angle=GOAL)
    state.episode["pad_radius"] = 0.015
    state.evaluate(121, slip=(0.0, 0.0, GOAL), angle=GOAL)
    return state


def test_the_angle_is_drawn_either_way_within_its_range():
    envs = gym.make_vec(ID, 64)
    _, info = envs.reset(seed=0)
    goals = info["reference"][:, 0]
    low, high = TASKS["PivotTo"].settings().angle
    assert ((low <= abs(goals)) & (abs(goals) <= high)).all()
    assert 0.3 < (goals > 0.0).mean() < 0.7
    _, info = envs.reset(seed=0, options={"angle": -0.3})
    envs.close()
    np.testing.assert_array_equal(info["reference"][:, 0], -0.3)


def test_the_wrist_keeps_to_speed_and_acceleration():
    settings = TASKS["PivotTo"].settings()
    env = gym.make(ID, engine="planar").unwrapped
    env.reset(seed=0)
    world, speeds = env.simulation.plant.world, [np.zeros(2)]
    for k in range(60):
        env.step(np.float32([1.0, -1.0 if k < 30 else 1.0, 0.5 if k < 15 else -1.0]))
        speeds.append(world["wrist_velocity"][0, :2].copy())
    env.close()
    changes = 120.0 * np.linalg.norm(np.diff(speeds, axis=0), axis=1)
    assert np.linalg.norm(speeds, axis=1).max() == pytest.approx(settings.wrist_speed)
    assert changes.max() == pytest.approx(settings.wrist_acceleration)
    # full speed from rest
    steps = np.ceil(120.0 * settings.wrist_speed / settings.wrist_acceleration)
    assert np.linalg.norm(speeds[int(steps)]) == pytest.approx(settings.wrist_speed)


def test_an_action_commands_up_to_the_speed_of_the_task():
    env = gym.make(ID, engine="planar", config={"tasks": {"pivot_to": {"wrist_speed": 0.9}}}).unwrapped
    env.close()
    ends = {column.name: (column.low, column.high) for column in env.action_columns}
    assert ends["wrist_velocity_x"] == ends["wrist_velocity_z"] == (-0.9, 0.9)


def test_success_is_rest_at_the_goal(arrived):
    arrived.evaluate(144)
    assert arrived.episode["success"]
    arrived.evaluate(144, slip_twist=(0.0, 0.0, 0.5))
    assert not arrived.episode["success"]
    arrived.evaluate(144, slip_twist=(0.0, 0.0, 0.0), wrist_velocity=(0.11, 0.0, 0.0))
    assert not arrived.episode["success"]


@pytest.mark.parametrize(
    ("step", "changes", "expected"),
    [
        (119, {"slip": (0.0, 0.0, 0.0), "angle": 0.0}, False),
        (120, {"slip": (0.0, 0.0, 0.0), "angle": 0.0}, True),
        (120, {"slip": (0.0, 0.0, GOAL - 0.08), "angle": GOAL - 0.08}, False),
        (120, {"angle": GOAL + 0.1}, True),  # the wrist pitched instead
        (30, {"slip": (0.0008, 0.0007, 0.0)}, True),
        (30, {"slip": (0.0006, 0.0007, 0.0)}, False),
    ],
)
def test_a_violation_is_a_slide_or_an_angle_missed(hand, step, changes, expected):
    state = hand("PivotTo", angle=GOAL)
    state.evaluate(1, slip=(0.0, 0.0, GOAL), angle=GOAL)
    terms = state.evaluate(step, **changes)
    assert state.episode["violated"] == expected
    assert terms["violated"] == (-1.0 if expected else 0.0)


def test_dense_terms(arrived):
    terms = arrived.evaluate(20, slip=(0.0003, -0.0004, GOAL - 0.0873), angle=GOAL - 0.0873)
    assert terms["angle"] == pytest.approx(np.exp(-1.0))
    assert terms["distance"] == pytest.approx(-0.0873 / np.pi)
    assert terms["sliding"] == pytest.approx(-0.05)
