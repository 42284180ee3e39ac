"""Sensors as grippers have them: at the wrist, in the motor, and markers in the pads."""

import gymnasium as gym
import numpy as np
import pytest

import estimator
import policies
from slipgym.config import load
from slipgym.envs.load_part import LOAD
from slipgym.envs.observation import DEVIATION_COLUMNS, FRICTION_COLUMNS, columns
from slipgym.envs.sensor_part import LAYOUTS, LOADED
from slipgym.sensors.markers import COLUMNS, COUNT, forces_of, press
from slipgym.sensors.owned import motor_force, turn_motor
from slipgym.tasks import TASKS, find
from slipgym.world.plant import build

EXACT = {"compliance": 1e-3, "noise": 0.0, "latency_frames": 0, "gain_error": 0.0, "normal_error": 0.0}
OWNED = "wrist", "motor", "markers"


def made(preset: str, task: str = "Hold", n: int = 2, **arguments):
    return gym.make_vec(f"slipgym:slipgym/{task}-v0", n, "vector_entry_point", sensors=preset, **arguments)


def named(envs, row: np.ndarray) -> dict[str, float]:
    return dict(zip((column.name for column in envs.unwrapped.columns), row.tolist(), strict=True))


def driven(envs, steps: int = 60) -> np.ndarray:
    envs.reset(seed=3)
    forces = -0.8 + 0.1 * np.sin(0.3 * np.arange(steps))
    frames = [envs.step(np.full((envs.num_envs, 1), each, np.float32))[0] for each in forces]
    envs.close()
    return np.array(frames)


def test_a_motor_bears_friction_when_it_closes_and_less_when_it_opens():
    """The closed form: F (1 + h s), s from -1 to 1 along the change of force over the backlash."""
    motor = {"friction": 0.1, "backlash": 2.0, "noise": 0.0, "resolution": 0.0}
    gripper = build(load({"sensors": {"motor": motor}}, "motor")).grippers[0]
    seen = []
    for force in (0.0, 1.0, 10.0, 9.0, 8.0, 6.0, 6.5):
        turn_motor(gripper, force)
        seen.append(motor_force(gripper, 0))
    np.testing.assert_allclose(seen, [0.0, 1.05, 11.0, 9.45, 8.0, 5.4, 6.5 * 0.925])


@pytest.mark.parametrize("contact", ["ellipsoid", "distributed"])
def test_the_field_of_the_markers_adds_up_to_the_wrench(contact):
    config = load({"sensors": {"markers": EXACT}}, "markers", contact)
    plant = build(config)
    plant.pads["wrench"], plant.pads["normal"] = (1.0, -2.0, 0.01), 5.0
    plant.pads["pressure_centre"] = 1e-3, -5e-4
    pad = plant.pads[0, 0]
    if plant.cells is not None:
        plant.cells[0, 0, 3] = -1e-5 * (1.0 + plant.cells[0, 0, 0])
    markers = plant.markers[0, 0]
    press(markers, pad, plant.cells, 0, 0)
    field = markers["field"][0]
    expected = -1.0, 2.0, -0.01 + 1e-3 * 2.0 - -5e-4 * -1.0
    np.testing.assert_allclose(forces_of(markers, field), expected, rtol=1e-9)
    assert field.shape == (COUNT, 2)
    centre, corner = COUNT // 2, COLUMNS - 1
    assert np.hypot(*field[centre]) > 0.0 == np.hypot(*field[corner])


def test_observations_have_what_the_sensors_measure():
    envs = made("wrist")
    names = list(named(envs, np.zeros(envs.single_observation_space.shape)))
    assert names[:6] == ["wrist_f_x", "wrist_f_y", "wrist_tau", "motor_force", "opening", "commanded_force"]
    assert not any(name.startswith(("v_x", "omega", "measured_slip", "f_n")) for name in names)
    envs.close()
    with pytest.raises(ValueError, match="load_columns"):
        made("motor", load_columns=True)
    with pytest.raises(ValueError, match="place"):
        load({"sensors": {"place": "wrist"}}, "markers")


def test_a_wrist_sees_the_sum_of_both_fingers():
    """Without errors; at rest the force is the weight."""
    quiet = {name: 0.0 for name in load(sensors="wrist").sensors.force_torque.model_dump() if "noise" in name}
    quiet |= {"bias_tangential": 0.0, "drift_tangential": 0.0, "resolution_force": 0.0}
    envs = made("wrist", config={"sensors": {"force_torque": quiet}})
    frames = driven(envs)
    envs = made("wrist")
    weight = envs.unwrapped.simulation.config.object.mass * 9.81
    envs.close()
    assert abs(frames[-1, 0, 1]) == pytest.approx(weight, rel=0.5)
    assert frames[:, :, 4].std() < 5e-4


@pytest.mark.parametrize("preset", OWNED)
def test_rows_do_not_depend_on_each_other_and_states_restore_every_bit(preset):
    many, one = driven(made(preset, n=3)), driven(made(preset, n=1))
    np.testing.assert_array_equal(many[:, :1], one)
    envs = made(preset)
    envs.reset(seed=1)
    state, action = envs.unwrapped.get_state(), np.full((2, 1), -0.85, np.float32)
    first = [envs.step(action)[0].copy() for _ in range(5)]
    envs.unwrapped.set_state(state)
    np.testing.assert_array_equal(first, [envs.step(action)[0] for _ in range(5)])
    envs.close()


@pytest.mark.quick_cases("markers")
@pytest.mark.parametrize("preset", OWNED)
def test_both_engines_have_the_same_columns(preset):
    pytest.importorskip("pybullet")
    env = gym.make("slipgym:slipgym/Hold-v0", engine="bullet", sensors=preset)
    observation, _ = env.reset(seed=0)
    envs = made(preset)
    assert observation.shape == envs.single_observation_space.shape
    assert env.observation_space.contains(env.step(np.array([-0.5], np.float32))[0])
    env.close()
    envs.close()


def test_markers_give_sixty_frames_a_second_and_the_field_on_demand():
    frames = driven(made("markers"))
    assert (frames[1::2, :, :14] == frames[:-1:2, :, :14]).all() or (
        frames[2::2, :, :14] == frames[1:-1:2, :, :14]
    ).all()
    envs = made("markers", config={"sensors": {"markers": {"observed": True}}})
    envs.reset(seed=0)
    for _ in range(10):
        seen = named(envs, envs.step(np.full((2, 1), -0.5, np.float32))[0][0])
    total = sum(seen[f"marker_y_{k}_1"] for k in range(COUNT)) / 1e-3
    assert total == pytest.approx(seen["f_y_1"], abs=1e-3)
    shown = [[[seen[f"marker_{axis}_{k}_{f}"] for axis in "xy"] for k in range(COUNT)] for f in (1, 2)]
    np.testing.assert_array_equal(shown, np.float32(envs.unwrapped.simulation.state.markers["seen"][0]))
    envs.close()


def test_with_the_motor_alone_the_estimate_stays_the_start_value_with_a_reason():
    envs = made("motor", task="LinearSlip")
    driven_frames = named(envs, driven(envs)[-1, 0])
    assert driven_frames["confidence_mu_c"] == driven_frames["confidence_mu_s"] == 0.0
    learner = estimator.make("adaptive", unmeasured=2)
    for k in range(100):
        learner.update(k / 120.0, (0.0, 0.0, 5.0, 0.0), (0.0, 0.0, 0.0))
    assert learner.estimate.mu_c == learner.parameters.mu_c0
    assert learner.estimate.sd_mu_c == learner.estimate.mu_c
    assert all("nothing in them depends on friction" in why for why in learner.reasons().values())


def test_falls_of_the_load_show_friction_where_slip_is_not_measured():
    """Ten slips from 0.6 to 0.5; many falls do not make the deviation less than that of the normal force."""
    learner = estimator.make("adaptive", unmeasured=1, sd_gain=0.1)
    deviations = []
    for k in range(10 * 60):
        load = 5.0 * (0.6 if k % 60 < 30 else 0.5)
        found = learner.update(k / 120.0, (0.0, load, 5.0, 0.0), (0.0, 0.0, 0.0))
        deviations.append(found.sd_mu_c / found.mu_c)
    assert found.mu_c == pytest.approx(0.5, rel=0.03)
    assert found.mu_s == pytest.approx(0.6, rel=0.03)
    assert found.updates_mu_c == 10
    assert deviations[0] == 1.0 > deviations[100] > deviations[-1] > 0.1
    still = estimator.make("adaptive", unmeasured=1)
    for k in range(200):
        still.update(k / 120.0, (0.0, 3.0 + 0.005 * k, 5.0, 0.0), (0.0, 0.0, 0.0))
    assert still.estimate.updates_mu_c == 0
    assert "no slip velocity" in still.reasons()["mu_c"]


def test_controllers_act_on_what_there_is_or_say_what_is_missing():
    envs = made("wrist", observation_mode="deviations")
    observations, _ = envs.reset(seed=0)
    actions, _ = policies.make("hold").predict(observations)
    assert np.isfinite(actions).all()
    envs.close()
    envs = made("motor", observation_mode="deviations")
    observations, _ = envs.reset(seed=0)
    with pytest.raises(ValueError, match=r"forces along the pad.*do not measure"):
        policies.make("hold").predict(observations)
    assert policies.make("constant_force", force=5.0).predict(observations)[0].shape == (2, 1)
    envs.close()
    envs = made("wrist", task="LinearSlip", observation_mode="deviations")
    observations, _ = envs.reset(seed=0)
    with pytest.raises(ValueError, match=r"the slip.*do not measure"):
        policies.make("linear_slip").predict(observations)
    envs.close()


def test_an_observation_of_no_sensors_is_refused_by_a_policy_of_any_task():
    with pytest.raises(ValueError, match=r"observation has 2 columns; every task has at least 3"):
        policies.make("constant_force").predict(np.zeros(2))


@pytest.mark.parametrize("task", [task.name for task in TASKS.values()])
def test_the_length_of_an_observation_shows_its_sensors(task):
    config = load()
    whole = len(columns(config, find(task), "true", find(task).action_mode, "deviations"))
    tail = whole - len(LAYOUTS["fingers"])
    ends = 0, len(DEVIATION_COLUMNS), len(DEVIATION_COLUMNS) + len(FRICTION_COLUMNS)
    lengths = [len(layout) + tail - end for layout in LAYOUTS.values() for end in ends]
    lengths += [len(LAYOUTS[name]) + tail - end + len(LOAD) for name in LOADED for end in ends]
    assert len(lengths) == len(set(lengths))
