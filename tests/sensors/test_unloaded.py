"""Readings of the open gripper before the grasp: errors of sensors without a load, and who learns them."""

import gymnasium as gym
import numpy as np
import pytest

from estimator.window.layout import ZERO
from slipgym.config import load
from slipgym.sensors.starting import draw_sensors, start_sensors
from slipgym.sensors.unloaded import READINGS, read_unloaded
from slipgym.world.plant import build

LINEAR = "slipgym/LinearSlip-v0"
QUIET = {"noise_tangential": 0.0, "noise_normal": 0.0, "noise_torque": 0.0}


def read(seed: int = 0, bias=0.0, **sensors) -> np.ndarray:
    """Readings of finger 1, (READINGS, 4)."""
    plant = build(load({"sensors": {"force_torque": sensors}}, "ideal"))
    start_sensors(plant.force_torque[0], plant.slip_sensors[0], *draw_sensors(2, np.random.default_rng(seed)))
    plant.force_torque["bias"] = bias
    before, wrenches = plant.force_torque.copy(), np.zeros((READINGS, 4))
    read_unloaded(plant.force_torque[0, 0], wrenches)
    assert plant.force_torque.tobytes() == before.tobytes()
    return wrenches


def test_without_errors_they_are_zero():
    np.testing.assert_array_equal(read(tilt=0.05, crosstalk=0.02, off_centre=0.002), 0.0)


def test_they_show_zero_errors_in_noise():
    """Bounds of four standard errors."""
    bias = np.array([0.1, -0.2, 0.15, 0.0, 0.0, 1e-3])
    rows = np.array([read(seed, bias, noise_tangential=0.02, noise_normal=0.01) for seed in range(50)])
    count = rows.shape[0] * rows.shape[1]
    for axis, (mean, noise) in enumerate(((0.1, 0.02), (-0.2, 0.02), (0.15, 0.01))):
        values = rows[..., axis]
        assert abs(values.mean() - mean) < 4 * noise / count**0.5
        assert values.std() == pytest.approx(noise, rel=4 / (2 * count) ** 0.5)
    assert np.unique(rows[..., 0]).size == count
    np.testing.assert_allclose(rows[..., 3], 1e-3, rtol=1e-12)


def test_the_bias_drifts_to_what_it_is_at_the_grasp():
    """A random walk of 0.1 N a step: its variance is in proportion to what is left; four standard errors."""
    episodes = 400
    rows = np.array([read(seed, drift_tangential=0.1 * 120**0.5)[:, 0] for seed in range(episodes)])
    left = np.arange(READINGS, 0, -1)
    ratio = (rows**2).mean(axis=0) / (0.01 * left)
    assert np.abs(ratio - 1.0).max() < 4 * (2 / episodes) ** 0.5


def test_quantisation_saturation_and_lost_readings():
    rows = read(bias=0.13, resolution_force=0.05)
    np.testing.assert_allclose(rows[:, :3], 0.15)
    assert read(bias=1.0, force_range=0.5)[:, 0].max() == 0.5
    rows = np.array([read(seed, noise_tangential=0.02, dropout=0.2)[:, 0] for seed in range(50)])
    again = (np.diff(rows, axis=1) == 0.0).mean()
    assert abs(again - 0.2) < 4 * (0.16 / (rows.size - 50)) ** 0.5


@pytest.mark.parametrize("engine", ["planar", "bullet"])
def test_an_episode_is_the_same_but_for_what_the_estimator_knows(engine):
    """Both engines show it the same readings; twins in a batch and alone have the same bits."""
    with gym.make(LINEAR, engine=engine, sensors="lab", estimator="adaptive") as made:
        made.reset(seed=3)
        alone = made.unwrapped.simulation
        found = alone.estimator.states.copy()
        sensors, known = alone.plant.force_torque[0], alone.estimator.states
        weights = np.pad(sensors["tip_load"], ((0, 0), (0, 4)))
        biases = sensors["bias"] + np.einsum("fab,fb->fa", sensors["mix"], weights)
        # mean of 24 readings: noise and lost ones 2 / 24^0.5 of the noise at most; four standard errors
        np.testing.assert_allclose(known["x"][:, ZERO : ZERO + 2], biases[:, :2], atol=4 * 2 * 0.02 / 24**0.5)
        for f in range(2):
            assert known["zeros"][f, 2] == pytest.approx(biases[f, 2], abs=4 * 2 * 0.04 / 24**0.5)
        assert (known["variance"][:, ZERO] ** 0.5 < 0.2 * alone.estimator.parameters.sd_zero).all()
    many = gym.make_vec(LINEAR, num_envs=5, sensors="lab", estimator="adaptive").unwrapped
    many.reset(seed=1)
    np.testing.assert_array_equal(many.simulation.estimator.states[4:6], found)
    many.close()
