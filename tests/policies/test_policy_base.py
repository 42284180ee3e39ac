import gymnasium as gym
import numpy as np
import pytest

import policies
import slipgym  # noqa: F401
from policies.controllers.base import Columns, ForcePolicy, ObservationIndex
from slipgym.config import load
from slipgym.envs import observation
from slipgym.envs.actions import ACTION_MODES
from slipgym.tasks import TASKS

CONFIG = load()
WIDTH = len(observation.columns(CONFIG, TASKS["LinearSlip"], "true"))


class Counter(ForcePolicy):
    """Grips with mu_c newtons per step taken."""

    task = "LinearSlip"

    def initial_state(self, n):
        return np.zeros((n, 1))

    def control(self, columns, state):
        state = state + 1.0
        return columns["mu_c"] * state[:, 0], state


def rows(n, mu_c=1.0):
    out = np.zeros((n, WIDTH), dtype=np.float32)
    out[:, ObservationIndex("LinearSlip", CONFIG)["mu_c"]] = mu_c
    return out


def newton(action):
    return 0.6 + 0.5 * (action + 1.0) * (25.0 - 0.6)


@pytest.mark.parametrize("task", TASKS)
def test_index_matches_the_environments_columns(task):
    index = ObservationIndex(task, CONFIG)
    for k, column in enumerate(
        observation.columns(CONFIG, TASKS[task], "estimated", TASKS[task].action_mode)
    ):
        assert index[column.name] == k


def test_unknown_columns_and_tasks_name_the_valid_ones():
    with pytest.raises(ValueError, match=r"'f_n_3'.*f_n_1"):
        ObservationIndex("LinearSlip", CONFIG)["f_n_3"]
    with pytest.raises(ValueError, match=r"LinearSlop.*linear_slip"):
        ObservationIndex("LinearSlop", CONFIG)


def test_single_and_batched_observations_agree():
    policy = Counter()
    single, state = policy.predict(rows(1, 3.0)[0])
    batch, states = policy.predict(rows(4, 3.0))
    assert single.shape == (1,)
    assert batch.shape == (4, 1)
    assert single.dtype == batch.dtype == np.float32
    assert state.shape == (1, 1)
    assert states.shape == (4, 1)
    np.testing.assert_array_equal(batch, np.tile(single, (4, 1)))
    np.testing.assert_allclose(newton(single), 3.0, rtol=1e-5)


def test_memory_restarts_by_row_and_belongs_to_the_caller():
    policy = Counter()
    _, first = policy.predict(rows(2, 2.0))
    kept = first.copy()
    action, state = policy.predict(rows(2, 2.0), state=first, episode_start=np.array([False, True]))
    np.testing.assert_allclose(newton(action[:, 0]), [4.0, 2.0], rtol=1e-5)
    np.testing.assert_array_equal(state[:, 0], [2.0, 1.0])
    np.testing.assert_array_equal(first, kept)


def test_without_the_friction_part_the_error_says_so():
    narrow = rows(1)[:, : WIDTH - len(observation.FRICTION_COLUMNS)]
    with pytest.raises(ValueError, match="friction_source='none'"):
        Counter().predict(narrow)
    columns = Columns(narrow, Counter().index)
    assert columns["f_n_1"] == 0.0
    assert "f_n_1" in columns
    assert "mu_c" not in columns


@pytest.mark.parametrize(
    "returned",
    [
        np.ones(2),
        (np.ones(2),),
        (1.0, np.ones((2, 1))),
        (np.ones(3), np.ones((2, 1))),
        (1j * np.ones(2), np.ones((2, 1))),
    ],
)
def test_what_control_has_to_return_is_named(returned):
    class Wrong(Counter):
        def control(self, columns, state):
            return returned

    with pytest.raises(ValueError, match=r"Wrong\.control must return the commands of 2 rows and the memory"):
        Wrong().predict(rows(2))


@pytest.mark.parametrize("shape", [(), (2, 3, WIDTH), (2, WIDTH + 1)])
def test_misshapen_observations_are_refused(shape):
    with pytest.raises(ValueError, match="observation"):
        Counter().predict(np.zeros(shape))


def test_misshapen_memory_is_refused():
    with pytest.raises(ValueError, match="state"):
        Counter().predict(rows(2), state=np.zeros((3, 1)))
    with pytest.raises(ValueError, match="episode_start"):
        Counter().predict(rows(2), state=np.zeros((2, 1)), episode_start=np.array([True]))


def test_forces_beyond_the_gripper_are_clipped():
    action, _ = Counter().predict(rows(1, 9.0), state=np.array([[99.0]]))
    assert action.item() == 1.0


@pytest.mark.parametrize("task", ["LinearSlip", "Hold"])
@pytest.mark.parametrize("friction_source", ["estimated", "none"])
def test_constant_force_holds_the_object_in_every_task(task, friction_source):
    env = gym.make(f"slipgym/{task}-v0", friction_source=friction_source)
    policy = policies.make("constant_force", force=20.0)
    obs, info = env.reset(seed=0, options={"object_mass": 0.1, "duration": 0.2})
    state = None
    for _ in range(20):
        action, state = policy.predict(obs, state=state)
        obs, _, _, _, info = env.step(action)
    assert not info["dropped"]
    np.testing.assert_allclose(info["grip_force"], 20.0, atol=0.1)
    env.close()


class Steer(ForcePolicy):
    """Ten newtons, and a wrist velocity."""

    task = "LinearSlip"
    action_mode = "grip_force_wrist"

    def control(self, columns, state):
        return np.tile([10.0, 0.25, -0.1, 1.5], (len(columns), 1)), state


class Nudge(ForcePolicy):
    """Towards ten newtons by increments."""

    action_mode = "force_increment"

    def control(self, columns, state):
        return np.full(len(columns), 10.0), state


class Geometric(Nudge):
    """Ten newtons, commanded by their logarithm."""

    action_mode = "log_grip_force"


@pytest.mark.parametrize("mode", ACTION_MODES)
@pytest.mark.parametrize("task", TASKS)
def test_index_matches_the_columns_of_every_action_mode(task, mode):
    index = ObservationIndex(task, CONFIG, mode)
    for k, column in enumerate(observation.columns(CONFIG, TASKS[task], "estimated", mode)):
        assert index[column.name] == k


def test_a_policy_can_command_the_wrist():
    env = gym.make("slipgym/LinearSlip-v0", action_mode="grip_force_wrist")
    obs, _ = env.reset(seed=0)
    action, _ = Steer().predict(obs)
    assert action.dtype == np.float32
    np.testing.assert_allclose(newton(action[0]), 10.0, rtol=1e-6)
    np.testing.assert_allclose(action[1:], [0.5, -0.2, 0.5], rtol=1e-6)
    batch, _ = Steer().predict(np.tile(obs, (3, 1)))
    np.testing.assert_array_equal(batch, np.tile(action, (3, 1)))
    index = ObservationIndex("LinearSlip", CONFIG, "grip_force_wrist")
    obs = env.step(action)[0]
    assert obs[index["commanded_force"]] == pytest.approx(10.0)
    assert obs[index["wrist_velocity_x"]] == pytest.approx(0.25)
    env.close()


def test_a_force_alone_leaves_the_wrist_to_the_script():
    class Still(Steer):
        def control(self, columns, state):
            return np.full(len(columns), 10.0), state

    narrow = np.zeros((2, len(observation.columns(CONFIG, TASKS["LinearSlip"], "none", "grip_force_wrist"))))
    np.testing.assert_array_equal(Still().predict(narrow)[0][:, 1:], 0.0)


def test_a_policy_can_command_by_increments():
    env = gym.make("slipgym/Hold-v0", action_mode="force_increment")
    obs, _ = env.reset(seed=0)  # at 15 N
    commanded = []
    for _ in range(7):
        obs = env.step(Nudge().predict(obs)[0])[0]
        commanded.append(obs[Nudge().index["commanded_force"]])
    np.testing.assert_allclose(commanded, [14.0, 13.0, 12.0, 11.0, 10.0, 10.0, 10.0], rtol=1e-6)
    env.close()


def test_a_policy_can_command_logarithms():
    env = gym.make("slipgym/Hold-v0", action_mode="log_grip_force")
    obs = env.step(Geometric().predict(env.reset(seed=0)[0])[0])[0]
    assert obs[Geometric().index["commanded_force"]] == pytest.approx(10.0)
    env.close()


@pytest.mark.parametrize("mode", ["flat", "deviations", "sensor"])
def test_controllers_ignore_the_load_part(mode):
    arguments = {"observation_mode": mode, "disable_env_checker": True}
    name = "slipgym/FragileHold-v0"
    plain, loaded = gym.make(name, **arguments), gym.make(name, load_columns=True, **arguments)
    policy = policies.make("constant_force", force=3.0) if mode == "sensor" else policies.make("fragile_hold")
    states = [None, None]
    seen = [env.reset(seed=0)[0] for env in (plain, loaded)]
    for _ in range(30):
        actions = []
        for k in range(2):
            action, states[k] = policy.predict(seen[k], states[k])
            actions.append(action)
        assert actions[0] == actions[1]
        seen = [env.step(actions[0])[0] for env in (plain, loaded)]
    np.testing.assert_array_equal(seen[0], seen[1][: len(seen[0])])
    plain.close()
    loaded.close()


def test_the_wrong_mode_is_a_clear_error():
    policy = policies.make("linear_slip")
    wrist, _ = gym.make("slipgym/LinearSlip-v0", action_mode="grip_force_wrist").reset(seed=0)
    with pytest.raises(ValueError, match=r"34 columns; LinearSlip has 30.*action_mode='grip_force'"):
        policy.predict(wrist)
    grouped, _ = gym.make("slipgym/LinearSlip-v0", observation_mode="dict").reset(seed=0)
    with pytest.raises(ValueError, match=r"groups policy, privileged.*observation_mode='flat'"):
        policy.predict(grouped)
    sensor, _ = gym.make("slipgym/LinearSlip-v0", observation_mode="sensor").reset(seed=0)
    with pytest.raises(ValueError, match="observation_mode='sensor' leave out"):
        policy.predict(sensor)
    env = gym.make("slipgym/Hinge-v0", action_mode="grip_force_pitch", disable_env_checker=True)
    action, _ = policies.make("hinge").predict(env.reset(seed=0)[0])  # observes all of it already
    with pytest.raises(ValueError, match=r"shape \(2,\).*grip_force, wrist_pitch_rate\), got \(1,\)"):
        env.step(action)
    env.close()
