"""What actions command in every action mode."""

import math
import re

import numpy as np
import pytest

from slipgym.config import load
from slipgym.envs.actions import ACTION_MODES, COMMANDS, Actions, interpret
from slipgym.tasks.episode import EPISODE, trapezoid

LINEAR, HOLD, HINGE = "slipgym/LinearSlip-v0", "slipgym/Hold-v0", "slipgym/Hinge-v0"
WRIST = "grip_force_wrist"
CONFIG = load()
GRIPPER = CONFIG.gripper
ENDS = {  # what -1 and +1 stand for
    "grip_force": (GRIPPER.force_min, GRIPPER.force_max),
    "wrist_velocity_x": (-GRIPPER.wrist_speed_max, GRIPPER.wrist_speed_max),
    "wrist_velocity_z": (-GRIPPER.wrist_speed_max, GRIPPER.wrist_speed_max),
    "wrist_pitch_rate": (-GRIPPER.wrist_pitch_rate_max, GRIPPER.wrist_pitch_rate_max),
    "force_increment": (-GRIPPER.force_step, GRIPPER.force_step),
    "ln_grip_force": (math.log(GRIPPER.force_min), math.log(GRIPPER.force_max)),
    **{f"ln_{name}": (math.log(0.05), math.log(2.0)) for name in ("mu_s", "mu_c")},
    "ln_r": (math.log(0.1 * GRIPPER.pad_radius), math.log(GRIPPER.pad_radius)),
    **{f"ln_sd_{name}": (math.log(0.01), 0.0) for name in ("mu_s", "mu_c", "r")},
}


def commanded(mode: str, *actions: list[float], force: float = 10.0) -> np.ndarray:
    """Force and wrist velocity that actions command, one row each, after a force of 10 N."""
    episodes = np.zeros(len(actions), EPISODE)
    episodes["command"] = force
    episodes["force_min"], episodes["force_max"] = GRIPPER.force_min, GRIPPER.force_max
    commands = np.zeros((len(actions), len(COMMANDS)))
    interpret(np.array(actions), Actions(mode, CONFIG).table, episodes, commands)
    return commands


@pytest.mark.parametrize("mode", ACTION_MODES)
def test_the_ends_of_every_component(mode):
    columns = Actions(mode, CONFIG).columns
    assert tuple(column.name for column in columns) == ACTION_MODES[mode]
    for column in columns:
        assert (column.low, column.high) == pytest.approx(ENDS[column.name])


def test_force_and_wrist_in_si_units():
    rows = commanded(WRIST, [-1, -1, -1, -1], [0, 0, 0, 0], [1, 0.5, 1, 1], [7, 7, -7, 7])
    expected = [[0.6, -0.5, -0.5, -3], [12.8, 0, 0, 0], [25, 0.25, 0.5, 3], [25, 0.5, -0.5, 3]]
    np.testing.assert_allclose(rows, expected, rtol=1e-15)
    np.testing.assert_allclose(commanded("grip_force_pitch", [1, 0.5]), [[25, 0, 0, 1.5]], rtol=1e-15)


def test_a_logarithmic_grip_is_geometric_and_stays_in_range():
    rows = commanded("log_grip_force", [-1], [0], [1], [0.1], [7])
    middle = math.sqrt(0.6 * 25.0)
    expected = [0.6, middle, 25.0, middle * (25.0 / 0.6) ** 0.05, 25.0]
    np.testing.assert_allclose(rows[:, 0], expected, rtol=1e-14)
    assert rows[:, 0].min() >= GRIPPER.force_min
    assert rows[:, 0].max() <= GRIPPER.force_max
    np.testing.assert_array_equal(rows[:, 1:], 0.0)


def test_increments_start_from_the_last_command_and_stay_in_range():
    rows = commanded("force_increment", [1], [-0.25], [0], [9])
    np.testing.assert_array_equal(rows, [[11, 0, 0, 0], [9.75, 0, 0, 0], [10, 0, 0, 0], [11, 0, 0, 0]])
    assert commanded("force_increment", [1], force=24.5)[0, 0] == GRIPPER.force_max
    assert commanded("force_increment", [-1], force=1.0)[0, 0] == GRIPPER.force_min


def test_a_guess_is_kept_in_the_episode():
    episodes, commands = np.zeros(2, EPISODE), np.zeros((2, len(COMMANDS)))
    actions = np.column_stack((np.zeros((2, 4)), [[-1.0] * 6, [0.0, 1.0, 7.0, -1.0, 0.0, 1.0]]))
    interpret(actions, Actions("grip_force_wrist_guess", CONFIG).table, episodes, commands)
    radius = GRIPPER.pad_radius
    expected = [[0.05, 0.05, 0.1 * radius, *[0.01] * 3], [math.sqrt(0.1), 2.0, radius, 0.01, 0.1, 1.0]]
    np.testing.assert_allclose(episodes["guess"], expected, rtol=1e-12)
    assert episodes["guesses"].all()
    np.testing.assert_allclose(commands, [[12.8, 0.0, 0.0, 0.0]] * 2)
    interpret(np.zeros((2, 1)), Actions("grip_force", CONFIG).table, before := np.zeros(2, EPISODE), commands)
    assert not before["guesses"].any()


def column(env, name: str) -> int:
    return [c.name for c in env.columns].index(name)


@pytest.mark.parametrize("frame_skip", [1, 3])
def test_an_increment_counts_for_every_sample(make, frame_skip):
    env = make(LINEAR, action_mode="force_increment", frame_skip=frame_skip)
    env.reset(seed=0, options={"initial_force": 10.0})
    for steps in (1, 2):
        observation, *_ = env.step([0.5])
        assert observation[column(env, "commanded_force")] == 10.0 + 0.5 * steps * frame_skip


@pytest.mark.parametrize("mode", ["grip_force_pitch", WRIST])
def test_a_wrist_left_alone_is_the_default_mode(make, env_id, mode):
    plain, env = make(env_id), make(env_id, action_mode=mode)
    common = [column(env, c.name) for c in plain.columns]
    first = plain.reset(seed=0)[0], env.reset(seed=0)[0]
    np.testing.assert_array_equal(first[0], first[1][common])
    for force in np.random.default_rng(0).uniform(-0.95, 0.0, 60):
        expected = plain.step([force])
        said = env.step([force, *np.zeros(env.action_space.shape[0] - 1)])
        np.testing.assert_array_equal(expected[0], said[0][common])
        assert repr(expected[1:]) == repr(said[1:])


def test_the_wrist_goes_where_it_is_told(make, env_id):
    env = make(env_id, action_mode=WRIST)
    start = env.reset(seed=0)[0][column(env, "wrist_pitch")]
    x, z = env.simulation.plant.world["wrist"][0, :2].copy()
    speed = env.action_columns[1].high
    for _ in range(30):  # before anything is scripted but Hold's shaking
        observation, *_ = env.step([1.0, 0.05 / speed, -0.02 / speed, 0.02])
    moved = (
        *(env.simulation.plant.world["wrist"][0, :2] - (x, z)),
        observation[column(env, "wrist_pitch")] - start,
    )
    shaken = (0.01, 0.01, 0.06) if env_id == HOLD else 0.0
    # a ramp of one sample, then a quarter of a second less half a sample
    np.testing.assert_array_less(
        np.abs(moved - np.array([0.05, -0.02, 0.06]) * 29.5 / 120), 1e-6 + np.array(shaken)
    )
    if env_id != HOLD:
        names = "wrist_velocity_x", "wrist_velocity_z", "wrist_pitch_rate"
        seen = [observation[column(env, name)] for name in names]
        np.testing.assert_allclose(seen, [0.05, -0.02, 0.06], rtol=1e-5)


def test_the_agents_velocity_adds_to_the_shaking(make):
    still, moving = make(HOLD, action_mode=WRIST), make(HOLD, action_mode=WRIST)
    still.reset(seed=1)
    moving.reset(seed=1)
    at = slice(column(still, "wrist_velocity_x"), column(still, "wrist_pitch_rate") + 1)
    for _ in range(60):
        scripted, both = still.step([0.5, 0, 0, 0])[0][at], moving.step([0.5, 0.2, -0.1, 0.1])[0][at]
        np.testing.assert_allclose(both - scripted, [0.1, -0.05, 0.3], atol=1e-6)
    assert np.abs(scripted).max() > 0.01


def test_the_grippers_limits_hold_for_the_sum(make):
    env = make(HOLD, action_mode=WRIST)
    env.reset(seed=1)
    at = slice(column(env, "wrist_velocity_x"), column(env, "wrist_pitch_rate") + 1)
    for k in range(60):
        x, z, pitch = env.step([1.0, 1.0, 1.0, (-1.0) ** k])[0][at]
        assert np.hypot(x, z) == pytest.approx(GRIPPER.wrist_speed_max, rel=1e-5)
        assert abs(pitch) <= GRIPPER.wrist_pitch_rate_max * (1 + 1e-6)


def test_undoing_the_turn_is_no_success(make):
    """Pitching back as fast as the script turns keeps the object upright, but earns nothing."""
    env = make(HINGE, action_mode="grip_force_pitch")
    env.reset(seed=0, options={"turn": 0.4, "duration": 1.0, "settle": 0.0, "hold": 0.1, "direction": 1})
    step, over = 0, False
    while not over:
        step += 1
        rate = trapezoid(step / 120, 0.4, 1.0)[1]  # of the script at the end of the coming step
        observation, _, terminated, truncated, info = env.step([1.0, -rate / GRIPPER.wrist_pitch_rate_max])
        over = terminated or truncated
    assert abs(observation[column(env, "wrist_pitch")]) < 1e-6
    assert np.abs(info["slip"]).max() < 1e-3
    assert info["reward_terms"]["upright"] < 1e-3
    assert not info["is_success"]


BAD = [
    (WRIST, [0.0, np.nan, 0.0, 0.0], "action[1] (wrist_velocity_x) = nan must be finite"),
    (WRIST, [0.0, 0.0, np.inf, 0.0], "action[2] (wrist_velocity_z) = inf must be finite"),
    (WRIST, [0.0, 0.0, 0.0, -np.inf], "action[3] (wrist_pitch_rate) = -inf must be finite"),
    (WRIST, [np.nan, 0.0, 0.0, 0.0], "action[0] (grip_force) = nan must be finite"),
    ("force_increment", [np.nan], "action[0] (force_increment) = nan must be finite"),
    (
        "grip_force_pitch",
        [0.0],
        "shape (2,) in action_mode 'grip_force_pitch' (grip_force, wrist_pitch_rate), got (1,)",
    ),
    ("grip_force", [0.0, 0.0], "shape (1,) in action_mode 'grip_force' (grip_force), got (2,)"),
]


@pytest.mark.parametrize(("mode", "action", "message"), BAD, ids=[row[2] for row in BAD])
def test_a_wrong_component_is_named_and_moves_nothing(make, mode, action, message):
    env, twin = make(LINEAR, action_mode=mode), make(LINEAR, action_mode=mode)
    env.reset(seed=0)
    twin.reset(seed=0)
    with pytest.raises(ValueError, match=re.escape(message)):
        env.step(action)
    fine = np.full(env.action_space.shape, 0.1)
    assert repr(env.step(fine)) == repr(twin.step(fine))


NO_NUMBERS = {
    "complex": np.array([0.5 + 1j]),
    "complex without imaginary part": np.array([0.5 + 0j]),
    "text": ["0.5"],
    "bytes": np.array([b"1"]),
    "date": np.array(["2020-01-01"], "M8[D]"),
    "duration": np.array([1], "m8[s]"),
    "masked": np.ma.array([0.5], mask=[True]),
    "with a mask": np.ma.array([0.5], mask=[False]),
    "large": [10**400],
    "large object": np.array([10**30], dtype=object),
    "none": [None],
    "record": np.array([(0.5,)], dtype=[("a", "f8")]),
}


@pytest.mark.parametrize("action", NO_NUMBERS.values(), ids=NO_NUMBERS)
def test_values_that_are_no_real_numbers_are_named(make, make_vec, action):
    env, batch = make(engine="planar"), make_vec(num_envs=1)
    env.reset(seed=0)
    batch.reset(seed=0)
    with pytest.raises(ValueError, match=r"action (.*)?must be an array"):
        env.step(action)
    together = action.reshape(1, -1) if isinstance(action, np.ndarray) else [action]
    with pytest.raises(ValueError, match=r"actions (.*)?must be an array"):
        batch.step(together)


@pytest.mark.parametrize(
    "action", [[True], np.array([1], np.uint64), np.float16([0.5]), np.longdouble([0.5])]
)
def test_all_kinds_of_real_numbers_are_taken(make, action):
    env = make(engine="planar")
    env.reset(seed=0)
    env.step(action)


def test_the_force_of_another_task_does_not_limit_this_one(make, env_id):
    """RotationalSlip begins with 25 N; a gripper of 20 N still serves the other tasks."""
    key = make(env_id, engine="planar").task.key
    config = {"gripper": {"force_max": 20.0}, "tasks": {key: {"initial_force": 20.0}}}
    env = make(env_id, engine="planar", config=config)
    env.reset(seed=0)
    env.reset(seed=0, options={"initial_force": 18.0})


@pytest.mark.parametrize("engine", ["bullet", "planar"])
def test_an_action_may_be_a_view_of_an_array_with_gaps(make, engine):
    plain = np.array([-0.9, 0.5, -0.5, 0.3])
    gaps = np.full(8, np.nan)
    gaps[::2] = plain
    found = []
    for action in (plain, gaps[::2]):
        env = make(engine=engine, action_mode="grip_force_wrist")
        env.reset(seed=0)
        found.append(env.step(action)[0])
    np.testing.assert_array_equal(*found)
