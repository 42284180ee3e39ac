"""Environments with physics.tilt: options, disturbances, states, and what is refused without it."""

import copy
import pickle

import gymnasium as gym
import numpy as np
import pytest

TILT = {"physics": {"tilt": True}}
SHAKE = {
    "kind": "shake",
    "probability": 1.0,
    "amplitude": {"choices": [0.002]},
    "pitch": {"choices": [0.02]},
    "frequency": {"uniform": [1.0, 3.0]},
}
ROLLING = {**SHAKE, "roll": {"choices": [0.2]}, "sway": {"uniform": [0.002, 0.004]}}
OPTIONS = {"wrist_roll": 0.3, "com_offset": (0.004, 0.01)}


@pytest.fixture
def midway(make):
    """An environment whose wrist rolls and sways, in the middle of an episode."""
    env = make(config=TILT, randomization={"disturbances": [ROLLING]})
    env.reset(seed=4, options=OPTIONS)
    for k in range(50):
        env.step(np.array([-0.9 + 0.01 * k], dtype=np.float32))
    return env


def go_on(env) -> list[str]:
    rng = np.random.default_rng(2)
    return [repr(env.step(rng.uniform(-1.0, -0.2, 1).astype(np.float32))) for _ in range(80)]


def test_states_continue_bit_for_bit(make, midway):
    other = make(config=TILT, randomization={"disturbances": [ROLLING]})
    other.set_state(pickle.loads(pickle.dumps(midway.get_state())))
    twin, first = copy.deepcopy(midway), go_on(midway)
    assert go_on(other) == first
    assert go_on(twin) == first
    assert repr(other.reset()) == repr(midway.reset())
    twin.close()


def test_the_same_seed_gives_the_same_bits(make, play):
    one, two = (make(config=TILT, randomization={"disturbances": [ROLLING]}) for _ in range(2))
    assert play(one, options=OPTIONS) == play(two, options=OPTIONS)


def test_a_rolled_wrist_loads_the_lower_finger(make):
    env = make("slipgym/Hold-v0", config=TILT)
    env.reset(
        seed=0, options={"wrist_roll": 0.5, "object_mass": 0.3, "shake_amplitude": 0.0, "shake_pitch": 0.0}
    )
    normal = env.simulation.plant.fingers["contact_force"][0]
    assert normal[1] - normal[0] == pytest.approx(0.3 * 9.81 * np.sin(0.5), rel=0.01)
    assert env.simulation.plant.world["gravity"][0] == pytest.approx(9.81 * np.cos(0.5))


def test_the_wrist_rolls_and_sways(midway):
    tilt = midway.simulation.plant.tilt[0]
    assert 0.0 < abs(tilt["roll"][0] - 0.3) < 0.4
    assert 0.0 < abs(tilt["sway"][0]) < 8e-3


def test_other_axes_shake_as_without_roll(make):
    shakes = []
    for disturbance in (SHAKE, ROLLING):
        env = make(config=TILT, randomization={"disturbances": [disturbance]})
        env.reset(seed=1)
        shakes.append(env.simulation.episode["shakes"].copy())
    np.testing.assert_array_equal(*shakes)


def test_a_mass_change_reaches_the_normal_forces(make):
    change = {
        "kind": "mass_change",
        "probability": 1.0,
        "time": {"choices": [0.1]},
        "factor": {"choices": [2.0]},
    }
    env = make("slipgym/LinearSlip-v0", config=TILT, randomization={"disturbances": [change]})
    env.reset(seed=0, options={"wrist_roll": 0.5, "object_mass": 0.2})
    for _ in range(60):
        env.step(np.array([0.5], dtype=np.float32))
    normal = env.simulation.plant.fingers["contact_force"][0]
    assert normal[1] - normal[0] == pytest.approx(0.4 * 9.81 * np.sin(0.5), rel=0.01)


def test_what_needs_tilt_is_refused_without(make):
    with pytest.raises(ValueError, match=r'wrist_roll = 0.1 rad needs .*"tilt": True.* engine="bullet"'):
        make().reset(options={"wrist_roll": 0.1})
    with pytest.raises(ValueError, match=r'shake in roll or sway needs .*"tilt": True.* engine="bullet"'):
        make(randomization={"disturbances": [ROLLING]})
    make().reset(options={"wrist_roll": 0.0})


def test_the_planar_engine_refuses_tilt(make):
    with pytest.raises(ValueError, match='engine="bullet"'):
        make(config=TILT, engine="planar")
    with pytest.raises(ValueError, match='engine="bullet"'):
        gym.make_vec("slipgym/LinearSlip-v0", num_envs=2, config=TILT)
