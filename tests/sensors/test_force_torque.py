import math

import numpy as np
import pytest

from slipgym.config import load
from slipgym.contact.records import pads
from slipgym.contact.soft_pad import load_pad
from slipgym.sensors.force_torque import (
    next_sample_read,
    read_force_torque,
    resolve_at_cop,
    sample_force_torque,
    sensed,
)
from slipgym.sensors.measure import measure
from slipgym.world.plant import build


def sensors(preset: str = "ideal", **force_torque):
    """Both fingers' sensors as the environment builds them, at 12000 ticks per second."""
    return build(load({"sensors": {"force_torque": force_torque}}, preset)).force_torque[0]


def loaded_pad(wrench=(1.5, -0.7, 0.012), normal=4.0, cop=(0.0, 0.0)):
    """A pad that carries a friction wrench on the object."""
    pad = pads(1)[0]
    pad["wrench"], pad["cop"] = wrench, cop
    load_pad(pad, normal)
    return pad


def samples(sensor, pad, count: int) -> np.ndarray:
    """Values (count, 6) of as many samples of a constant load."""
    values = np.zeros((count, 6))
    for number, row in enumerate(values, 1):
        sample_force_torque(sensor, pad, number * sensor["period"])
        sensed(sensor, number, row)
    return values


def test_it_reads_the_load_on_the_finger():
    value = samples(sensors()[0], loaded_pad(), 1)[0]
    np.testing.assert_allclose(value, [-1.5, 0.7, 4.0, 0.0, 0.0, -0.012], atol=1e-15)


def test_finger_2_counts_the_torque_the_other_way():
    first, second = (samples(sensor, loaded_pad(cop=(0.002, 0.001)), 1)[0] for sensor in sensors())
    np.testing.assert_array_equal(second[:5], first[:5])
    assert second[5] == -first[5] != 0.0


@pytest.mark.parametrize("finger", [0, 1])
def test_the_wrench_is_resolved_at_the_centre_of_pressure(finger):
    cop = np.array([0.002, -0.0015])
    sensor = sensors()[finger]
    reading = samples(sensor, loaded_pad(cop=cop), 1)[0]
    # at the pad centre the offset turns the tangential force into torque: tau + c x f
    at_centre = -0.012 + cop[0] * 0.7 - cop[1] * -1.5
    assert reading[5] == pytest.approx((1.0, -1.0)[finger] * at_centre)
    wrench, found = np.zeros(4), np.zeros(2)
    resolve_at_cop(sensor, reading, 0.2, wrench, found)
    np.testing.assert_allclose(found, cop, atol=1e-15)
    np.testing.assert_allclose(wrench, [-1.5, 0.7, 4.0, -0.012], atol=1e-15)


def test_without_contact_there_is_no_centre_of_pressure():
    sensor = sensors()[0]
    reading = samples(sensor, loaded_pad(normal=0.1, cop=(0.002, 0.0)), 1)[0]
    wrench, found = np.ones(4), np.ones(2)
    resolve_at_cop(sensor, reading, 0.2, wrench, found)
    np.testing.assert_array_equal(found, 0.0)
    assert np.all(np.isfinite(wrench))


def test_the_twist_is_moved_to_the_centre_of_pressure():
    config = load({"contact": {"cop_offset": [[0.002, 0.001]] * 2}}, "ideal")
    plant = build(config)
    plant.pads["normal"] = 4.0
    plant.world["tick"] = 12
    motion = np.array([1e-4, -2e-4, 5e-3])
    for f in range(2):
        sample_force_torque(plant.force_torque[0, f], plant.pads[0, f], 12)
    plant.slip_sensors["moved"] = motion
    wrenches, twists = np.zeros((1, 2, 4)), np.zeros((1, 2, 3))
    measure(plant.world, plant.force_torque, plant.slip_sensors, wrenches, twists)
    v_x, v_y, omega = 120 * motion
    expected = [v_x - omega * 0.001, v_y + omega * 0.002, omega]
    np.testing.assert_allclose(twists[0], [expected, expected], rtol=1e-9)


@pytest.mark.parametrize("latency", [0.0, 0.0015, 0.0021, 0.05])
def test_latency(latency):
    sensor = sensors(latency=latency)[0]
    reading, ticks = np.zeros(6), 12  # a sample per 12 ticks of 1/12000 s
    for tick in range(1, 1201):
        if tick % ticks == 0:
            sample_force_torque(sensor, loaded_pad(normal=tick / 12000), tick)
        read_force_torque(sensor, tick, reading)
        newest = math.floor((tick - round(latency * 12000)) / ticks) * ticks
        assert reading[2] == (max(newest, 0) / 12000)


@pytest.mark.parametrize("latency", [0.0, 0.0015, 0.0021, 0.05])
@pytest.mark.parametrize("rate", [120, 500, 1000])
def test_only_the_samples_that_a_reading_needs(latency, rate):
    sensor = sensors(latency=latency, rate=rate)[0]
    control, period, delay = 100, int(sensor["period"]), int(sensor["delay"])
    readings = range(control, 60 * control, control)
    needed = sorted({(tick - delay) // period * period for tick in readings if tick - delay >= period})
    tick, found = 0, []
    while len(found) < len(needed):
        tick = next_sample_read(sensor, tick, control)
        found.append(tick)
    assert found == needed


def test_resolution_and_range():
    sensor = sensors(resolution_force=0.05, resolution_torque=1e-3, force_range=1.2, torque_range=0.01)[0]
    value = samples(sensor, loaded_pad(wrench=(1.5, -0.711, 0.012), normal=4.032), 1)[0]
    np.testing.assert_allclose(value, [-1.2, 0.7, 4.05, 0.0, 0.0, -0.01], atol=1e-12)


def test_noise_has_the_configured_deviation():
    n, sensor = 4000, sensors("realistic")[0]
    sensor["key"] = 5
    values = samples(sensor, loaded_pad(), n)
    expected = [0.02, 0.02, 0.04, 5e-4, 5e-4, 5e-4]
    # the sd of n normal samples is known to 1 / sqrt(2 n), their mean to sd / sqrt(n): four sigma
    np.testing.assert_allclose(values.std(axis=0), expected, rtol=4.0 / math.sqrt(2 * n))
    truth = np.array([-1.5, 0.7, 4.0, 0.0, 0.0, -0.012])
    assert np.all(np.abs(values.mean(axis=0) - truth) < 4.0 * np.array(expected) / math.sqrt(n))


def test_drift_is_a_random_walk_per_root_second():
    n, sensor = 2000, sensors(drift_normal=0.1)[0]
    sensor["drift_key"], reading, bias = 6, np.zeros(6), [sensor["bias"].copy()]
    for tick in range(n):
        read_force_torque(sensor, tick, reading)
        bias.append(sensor["bias"].copy())
    steps = np.diff(np.array(bias), axis=0)
    # one step of the walk per control step of 1/120 s; the sd of n samples is known to 1 / sqrt(2 n)
    assert steps[:, 2].std() == pytest.approx(0.1 / math.sqrt(120), rel=4.0 / math.sqrt(2 * n))
    assert np.ptp(steps[:, 0]) == 0.0
    reading = samples(sensor, loaded_pad(normal=4.0), 1)[0]
    assert reading[2] == pytest.approx(4.0 + bias[-1][2])


@pytest.mark.parametrize(
    ("kind", "overrides"),
    [("force_torque.latency", {"force_torque": {"latency": 0.2}}), ("slip", {"slip": {"window": 40}})],
)
def test_histories_that_are_too_long_are_refused(kind, overrides):
    with pytest.raises(ValueError, match=kind):
        build(load({"sensors": overrides}))
