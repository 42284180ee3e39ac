"""The structural mode of a finger against its differential equation and its step response."""

import math

import gymnasium as gym
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from slipgym.config import load
from slipgym.sensors.force_torque import read_force_torque, roomier
from slipgym.sensors.structure import forget, vibrate
from slipgym.validation.bench import Bench
from slipgym.world.plant import build

PERIOD = 1e-3


def sensor(frequency: float, damping: float):
    """Finger 1's sensor, at 1 kHz, before its first sample."""
    mode = {"mode_frequency": frequency, "mode_damping": damping}
    return build(load({"sensors": {"force_torque": mode}}, "ideal")).force_torque[0, 0]


@pytest.mark.parametrize(("frequency", "damping"), [(25.0, 0.02), (180.0, 0.3), (1400.0, 0.01)])
def test_any_load_gives_what_the_equation_gives(frequency, damping):
    """Six axes under loads that are straight between samples, by an integrator of another kind."""
    loads = np.random.default_rng(1).normal(size=(40, 6)).cumsum(axis=0)
    own, omega, found = sensor(frequency, damping), math.tau * frequency, loads.copy()
    for row in found:
        vibrate(own, row)
    times = PERIOD * np.arange(len(loads))
    for axis, values in enumerate(loads.T):

        def derivative(t, state, values=values):
            pull = np.interp(t, times, values) - state[0]
            return state[1], omega * omega * pull - 2.0 * damping * omega * state[1]

        solved = solve_ivp(
            derivative, (0.0, times[-1]), (values[0], 0.0), t_eval=times, max_step=2e-5, rtol=1e-9, atol=1e-10
        )
        np.testing.assert_allclose(found[:, axis], solved.y[0], atol=2e-5)


def ramp_response(t: np.ndarray, omega: float, damping: float) -> np.ndarray:
    """Response to a load that begins to rise by 1 a second at 0, by the Laplace transform."""
    turn, late = omega * math.sqrt(1.0 - damping**2), np.maximum(t, 0.0)
    ringing = 2.0 * damping / omega * np.cos(turn * late)
    ringing += (2.0 * damping**2 - 1.0) / turn * np.sin(turn * late)
    return np.where(t > 0.0, t - 2.0 * damping / omega + np.exp(-damping * omega * late) * ringing, 0.0)


@pytest.mark.parametrize(("frequency", "damping"), [(20.0, 0.05), (45.0, 0.3)])
@pytest.mark.parametrize(("engine", "close"), [("planar", 1e-9), ("bullet", 0.02)])
def test_a_step_of_the_grip_rings_in_the_reading(engine, close, frequency, damping):
    """A step response is the difference of two ramps: before the sample that sees the step, and at it."""
    force = {"mode_frequency": frequency, "mode_damping": damping}
    overrides = {
        "sensors": {"force_torque": force},
        "gripper": {"lag": 0.0, "dead_time": 0.0},
        "physics": {"gravity": 0.0},
    }
    found, reading = [], np.zeros(6)
    with Bench(overrides, force=5.0, engine=engine) as bench:
        bench.settle()
        start = int(bench.plant.world["tick"][0])
        for _ in range(24):
            bench.run(bench.step_time, force=lambda _: 8.0)
            tick = int(bench.plant.world["tick"][0])
            read_force_torque(bench.plant.force_torque[0, 0], tick, reading)
            found.append((tick // 12 * 12, reading[2]))
    ticks, values = np.array(found).T
    seen = (start // 12 + 1) * 12  # the first sample after the step, at 12 000 ticks a second
    omega = math.tau * frequency
    ramps = [ramp_response((ticks - end) / 12_000, omega, damping) for end in (seen - 12, seen)]
    expected = 5.0 + 3.0 * (ramps[0] - ramps[1]) / PERIOD
    assert expected.max() > 8.0 + 1.5 * math.exp(-math.pi * damping / math.sqrt(1.0 - damping**2))
    np.testing.assert_allclose(values, expected, atol=3.0 * close)


@pytest.mark.parametrize("engine", ["planar", "bullet"])
def test_an_episode_begins_at_rest(engine):
    """The grip of the reset is no step: readings are the rigid finger's, in every episode."""
    found = []
    for frequency in (None, 30.0):
        config = {"sensors": {"force_torque": {"mode_frequency": frequency, "mode_damping": 0.001}}}
        with gym.make(
            "slipgym/LinearSlip-v0", engine=engine, sensors="ideal", config=config, disable_env_checker=True
        ) as env:
            firm = np.zeros(env.action_space.shape, dtype=np.float32)
            first = [env.reset(seed=0)[0]]
            env.step(firm + 1.0)
            found.append([*first, env.reset(seed=1)[0]])
    # the first sample bears 99.5 % of the weight of the object; the grip is 15 N
    np.testing.assert_allclose(found[1], found[0], atol=0.01)


def test_a_rigid_finger_has_no_record_of_a_mode():
    swinging = build(load({"sensors": {"force_torque": {"mode_frequency": 40}}})).force_torque
    assert build(load()).force_torque.dtype["swing"].shape == (1, 1)
    larger = roomier(swinging, 40)
    np.testing.assert_array_equal(larger["mode"], swinging["mode"])
    assert larger["swing"].shape == swinging["swing"].shape


def test_a_mode_forgets():
    own, row = sensor(40.0, 0.01), np.zeros(6)
    for value in (0.0, 3.0, 5.0):
        row[:] = value
        vibrate(own, row)
    assert abs(row[0] - 5.0) > 1.0
    forget(own)
    row[:] = 5.0
    vibrate(own, row)
    np.testing.assert_array_equal(row, 5.0)


@pytest.mark.parametrize(
    ("name", "value", "range_"),
    [("mode_frequency", 0.0, ">= 1 and <= 10000"), ("mode_damping", 0.6, ">= 0.001 and <= 0.5")],
)
def test_what_is_out_of_range_is_refused_with_the_range(name, value, range_):
    with pytest.raises(ValueError, match=rf"sensors\.force_torque\.{name} = {value}.*{range_}"):
        load({"sensors": {"force_torque": {name: value}}})


def test_a_state_before_the_first_sample_can_be_restored():
    config = {"sensors": {"force_torque": {"rate": 10, "mode_frequency": 40.0}}}
    with gym.make("slipgym/LinearSlip-v0", engine="planar", config=config, disable_env_checker=True) as env:
        env.reset(seed=0)
        env.unwrapped.set_state(env.unwrapped.get_state())
