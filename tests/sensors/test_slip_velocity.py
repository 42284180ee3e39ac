import math

import numpy as np
import pytest

from slipgym.config import load
from slipgym.sensors.slip_velocity import (
    AXES,
    accumulate_slip,
    chip_positions,
    displacement,
    read_slip,
    sample_slip,
)
from slipgym.world.plant import build

COUNT, RADIUS, RATE = 7.94e-6, 0.0243, 120


def sensors(**slip):
    """Both fingers' sensors as the environment builds them."""
    return build(load({"sensors": {"slip": slip}})).slip_sensors[0]


def levers(radius: float, chips: int) -> np.ndarray:
    """Matrix from slip displacement (x, y, theta), in the finger's frame, to the chips' axes (2 chips, 3)."""
    rows = []
    for x, y in chip_positions(radius, chips)[:chips]:
        rows += [(1.0, 0.0, -y), (0.0, 1.0, x)]
    return np.array(rows)


def run(sensor, motions: np.ndarray) -> np.ndarray:
    """Readings (n, 3) for a slip displacement per sample (n, 3)."""
    readings = np.zeros((len(motions), 3))
    for i, motion in enumerate(motions):
        accumulate_slip(sensor, motion)
        sample_slip(sensor)
        read_slip(sensor, readings[i])
    return readings


def exact(**slip):
    return sensors(counts=False, **{"latency_samples": 0, "window": 1, **slip})


@pytest.mark.parametrize("finger", [0, 1])
@pytest.mark.parametrize("chips", [2, 3, 4])
def test_without_counting_it_reads_the_twist(finger, chips):
    twist = np.array([0.01, -0.03, 2.0])
    reading = run(exact(chips=chips)[finger], np.tile(twist / RATE, (3, 1)))
    np.testing.assert_allclose(reading, np.tile(twist, (3, 1)), rtol=1e-12)


def test_finger_2_is_mirrored():
    first, second = exact()
    motion = np.array([[2e-5, -1e-5, 3e-3]])
    run(first, motion)
    run(second, motion)
    # what the chips of finger 2 see is what those of finger 1 would see with omega reversed
    mirror = exact()[0]
    run(mirror, motion * (1.0, 1.0, -1.0))
    np.testing.assert_allclose(second["counted"], mirror["counted"], rtol=1e-12)
    solved = np.linalg.pinv(levers(RADIUS, 3)) @ second["counted"][:6]
    np.testing.assert_allclose(solved, motion[0] * (1.0, 1.0, -1.0), rtol=1e-12)


@pytest.mark.parametrize("chips", [2, 3, 4])
def test_chips_are_evenly_on_a_circle(chips):
    positions = chip_positions(RADIUS, chips)
    angles = math.pi / 2 + 2 * math.pi * np.arange(chips) / chips
    expected = RADIUS * np.column_stack([np.cos(angles), np.sin(angles)])
    np.testing.assert_allclose(positions[:chips], expected, atol=1e-18)
    np.testing.assert_array_equal(positions[chips:], 0.0)


@pytest.mark.parametrize("chips", [2, 3, 4])
def test_the_displacement_is_the_least_squares_one(chips):
    sensor = exact(chips=chips)[0]
    counted = np.random.default_rng(chips).normal(size=2 * chips)
    sensor["counted"][: 2 * chips] = counted
    expected = np.linalg.lstsq(levers(RADIUS, chips), counted, rcond=None)[0]
    np.testing.assert_allclose(displacement(sensor), expected, rtol=1e-12)


@pytest.mark.parametrize("finger", [0, 1])
@pytest.mark.parametrize("chips", [3, 4])
def test_a_chip_that_counts_nothing_is_left_out(finger, chips):
    twist = np.array([0.01, -0.03, 1.0])
    sensor = sensors(chips=chips, noise=0.0, latency_samples=0, latency_spread=0, window=1)[finger]
    for failed in range(chips):
        sensor["failed"], sensor["taken"], sensor["delivered"] = failed, 0, -1
        for name in ("travel", "carry", "measured_slip"):
            sensor[name] = 0.0
        readings = run(sensor, np.tile(twist / RATE, (100, 1)))
        # the rest of a count at either end, on each axis of a chip; rotation has the shortest lever
        rest = COUNT * RATE / 80 * np.array([2.0, 2.0, 2.0 / RADIUS])
        assert np.all(abs(readings[20:].mean(axis=0) - twist) < rest)
        assert abs(readings[0] - twist).max() > 0.1 * abs(twist).min()


def test_two_silent_chips_are_not_told_from_a_turn_about_them():
    sensor = sensors(noise=0.0, latency_samples=0, latency_spread=0, window=1)[0]
    sensor["travel"][:3] = 0.0, 0.0, 1.0
    sensor["counted"][:] = 0.0
    sensor["counted"][4:6] = COUNT
    expected = np.linalg.lstsq(levers(RADIUS, 3), sensor["counted"][:6], rcond=None)[0]
    np.testing.assert_allclose(displacement(sensor), expected, rtol=1e-12)


def test_no_count_no_velocity():
    sensor = sensors()[0]
    tremble = 0.4 * COUNT * np.random.default_rng(0).uniform(-1, 1, (500, 1)) * (1.0, 1.0, 1.0 / RADIUS)
    motions = np.diff(np.vstack([np.zeros(3), tremble]), axis=0)
    assert np.all(run(sensor, motions) == 0.0)


def test_latency_and_window():
    pulse = np.zeros((8, 3))
    pulse[2] = 20 * COUNT, 0.0, 0.0
    for window in (1, 2, 3):
        for delay in (0, 1, 2):
            reading = run(sensors(window=window, latency_samples=delay)[0], pulse)[:, 0]
            expected = np.zeros(8)
            expected[2 + delay : 2 + delay + window] = 20 * COUNT * RATE / window
            np.testing.assert_allclose(reading, expected, rtol=1e-9, atol=1e-15)


def test_a_single_count_of_one_chip():
    sensor = sensors(latency_samples=0)[0]
    sensor["carry"][0] = 1.001 * COUNT
    twist = run(sensor, np.zeros((1, 3)))[0]
    # one count is 0.95 mm/s on its axis; least squares over three chips leave a third of it
    np.testing.assert_allclose(twist[0], COUNT * RATE / 3, rtol=1e-9)
    assert pytest.approx(1e-3, rel=0.05) == COUNT * RATE


@pytest.mark.parametrize("finger", [0, 1])
def test_counts_add_up_to_the_travel(finger):
    rng = np.random.default_rng(3)
    sensor = sensors()[finger]
    motions = rng.normal(size=(2000, 3)) * (3e-5, 3e-5, 1e-3)
    motions[-2:] = 0.0  # the latency
    counted = np.zeros(AXES)
    for motion in motions:
        run(sensor, motion[None])
        counted += sensor["counted"]
    to_axes = levers(RADIUS, 3) * (1.0, 1.0, sensor["mirror"])
    # truncation keeps the rest: never a whole count is missing on any axis
    assert np.all(np.abs(counted[:6] - to_axes @ motions.sum(axis=0)) < COUNT * (1 + 1e-6))
    # least squares of six axis errors, each below one count
    away = np.abs(sensor["measured_slip"] - motions.sum(axis=0))
    assert np.all(away < COUNT * np.abs(np.linalg.pinv(to_axes)).sum(axis=1))


def test_quantisation_noise():
    """A count that keeps its rest errs by f (1 - f) count^2 per axis, f the fraction per sample.

    Averaged over all speeds that is count^2 / 6, twice the count^2 / 12 of rounding. Least
    squares over three chips divide it by 3, and by 3 R^2 for omega.
    """
    rng = np.random.default_rng(7)
    errors = []
    for _ in range(300):
        sensor = sensors(latency_samples=0)[0]
        sensor["carry"] = rng.uniform(0.0, 1.0, AXES) * COUNT
        twist = rng.uniform(0.5, 1.0, 3) * (0.05, 0.05, 0.0) + (0.0, 0.0, rng.uniform(-0.5, 0.5))
        errors.append(run(sensor, np.tile(twist / RATE, (20, 1))) - twist)
    sd = np.sqrt(np.mean(np.concatenate(errors) ** 2, axis=0))
    per_axis = COUNT * RATE / math.sqrt(6.0)
    expected = per_axis / math.sqrt(3.0) * np.array([1.0, 1.0, 1.0 / RADIUS])
    # 300 independent speeds: the variance is known to about sqrt(2 / 300) = 8 %, the sd to 4 %; three sigma
    np.testing.assert_allclose(sd, expected, rtol=0.12)
    # 0.16 mm/s and 6.5e-3 rad/s are the figures of rounding each sample by itself
    np.testing.assert_allclose(expected, math.sqrt(2.0) * np.array([0.16e-3, 0.16e-3, 6.5e-3]), rtol=0.02)


def test_noise_is_in_counts_per_sample():
    n = 4000
    sensor = exact(noise=0.5)[0]
    sensor["key"] = 1
    readings = run(sensor, np.zeros((n, 3)))
    expected = 0.5 * COUNT * RATE / math.sqrt(3.0) * np.array([1.0, 1.0, 1.0 / RADIUS])
    # sd of n normal samples is known to 1 / sqrt(2 n) = 1.1 %; four sigma
    np.testing.assert_allclose(readings.std(axis=0), expected, rtol=4.0 / math.sqrt(2.0 * n))


def test_saturation_per_axis():
    sensor = exact(speed_max=0.1)[0]
    reading = run(sensor, np.tile([0.2 / RATE, -0.05 / RATE, 0.0], (3, 1)))
    np.testing.assert_allclose(reading, np.tile([0.1, -0.05, 0.0], (3, 1)), atol=1e-12)
    np.testing.assert_array_equal(sensor["carry"], 0.0)  # what is beyond the range is lost
