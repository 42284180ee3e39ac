"""Weight and inertia of a fingertip in front of its force/torque sensor, by closed forms."""

import gymnasium as gym
import numpy as np
import pytest

from estimator.window.layout import ZERO
from slipgym.sensors.force_torque import read_force_torque
from slipgym.validation.bench import Bench

MASS, GRAVITY, RATE, ACCELERATION = 0.02, 9.81, 1.5, (1.2, 0.8)
STEP = 1 / 120


def readings(mass: float, engine: str) -> np.ndarray:
    """What finger 2 reads of forces while the wrist speeds up along both axes and pitches, (n, 2)."""
    overrides = {"sensors": {"force_torque": {"tip_mass": mass}}, "physics": {"gravity": GRAVITY}}
    rows, reading = [], np.zeros(6)
    with Bench(overrides, force=20.0, engine=engine) as bench:
        bench.settle()
        for k in range(40):
            t = (k + 1) * STEP
            velocity = (ACCELERATION[0] * t, ACCELERATION[1] * t, RATE)
            bench.run(STEP, wrist=lambda _, velocity=velocity: velocity)
            read_force_torque(bench.plant.force_torque[0, 1], int(bench.plant.world["tick"][0]), reading)
            rows.append(reading[:2].copy())
    return np.array(rows)


@pytest.mark.parametrize("engine", ["planar", "bullet"])
def test_it_turns_with_the_pitch_and_grows_with_the_acceleration(engine):
    found = readings(MASS, engine) - readings(0.0, engine)
    t = np.arange(100, 4001, 100) // 12 * 12 / 12000  # of the newest sample, at 1 kHz
    pitch = RATE * np.where(t < STEP, t**2 / (2.0 * STEP), t - 0.5 * STEP)  # the first step is the ramp
    x, z = -MASS * ACCELERATION[0], -MASS * (GRAVITY + ACCELERATION[1])
    expected = np.column_stack((np.cos(pitch) * x + np.sin(pitch) * z, np.cos(pitch) * z - np.sin(pitch) * x))
    np.testing.assert_allclose(found, expected, atol=1e-9)
    assert np.ptp(found[:, 0]) > 0.05


@pytest.mark.parametrize("engine", ["planar", "bullet"])
def test_zeroing_takes_out_the_weight_in_the_pose_of_the_grasp(engine):
    """The readings of the open gripper have the weight in them; the estimator learns it as a zero error."""
    quiet = {"noise_tangential": 0.0, "noise_normal": 0.0, "noise_torque": 0.0}
    config = {"sensors": {"force_torque": {**quiet, "tip_mass": MASS}}}
    with gym.make(
        "slipgym/LinearSlip-v0", engine=engine, config=config, estimator="adaptive", disable_env_checker=True
    ) as env:
        env.reset(seed=0)
        simulation = env.unwrapped.simulation
        pitch = simulation.plant.world["wrist"][0, 2]
        weight = -MASS * simulation.plant.world["gravity"][0] * np.array([np.sin(pitch), np.cos(pitch)])
        np.testing.assert_allclose(
            simulation.estimator.states["x"][:, ZERO : ZERO + 2], np.tile(weight, (2, 1)), atol=2e-3
        )


def test_each_finger_has_its_own_mass_in_every_episode():
    lab = {"sensors": "lab", "randomization": "lab"}  # together: these programs are compiled anyway
    with gym.make("slipgym/Hold-v0", engine="planar", disable_env_checker=True, **lab) as env:
        masses = []
        for seed in range(60):
            env.reset(seed=seed)
            masses.append(env.unwrapped.simulation.plant.force_torque["tip_mass"][0].copy())
    found = np.array(masses)
    assert 0.005 <= found.min() < 0.007
    assert 0.028 < found.max() <= 0.030
    assert abs(np.corrcoef(found.T)[0, 1]) < 4 / 60**0.5
