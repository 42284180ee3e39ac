"""Readings of any size: no estimator keeps a number that is not finite, and each goes on learning."""

import math

import numpy as np
import pytest

import estimator

SIZES = (
    *(0.0, 5e-324, 1e-308, 1e-200, 1e-100, 1e-30, 1e-9),
    *(1e3, 1e6, 1e9, 9.9e11, 1e12, 1e30, 1e75, 1e154, 1e200, 1.7e308),
)
RATE = 120.0


def numbers(records):
    """All floating-point numbers of a structured array, by field."""
    return {
        name: records[name] for name in records.dtype.names if np.issubdtype(records[name].dtype, np.floating)
    }


def samples(rng, count):
    """A slip that starts and stops, of mu_c = 0.4 and r = 8 mm, with a wrench that rises and falls."""
    for k in range(count):
        moves = (k // 30) % 2 == 1
        f_n = 5.0 + 0.5 * math.sin(0.1 * k)
        wrench = np.array([0.35 * f_n, 0.1 * f_n, f_n, 0.002 * f_n]) * (1.0 + 0.01 * rng.standard_normal())
        yield wrench, np.array([0.02, 0.005, 0.5]) * moves


def assert_finite(batch, when):
    for kind, records in (("state", batch.states), ("estimate", batch.estimates)):
        for name, values in numbers(records).items():
            assert np.isfinite(values).all(), f"{when}: {kind} {name} = {values}"


@pytest.mark.parametrize("name", estimator.names())
@pytest.mark.parametrize("place", [*range(7), "several"])
def test_no_reading_leaves_a_number_that_is_not_finite(name, place):
    rng = np.random.default_rng(0 if place == "several" else place)
    signed = [sign * size for size in SIZES for sign in (1.0, -1.0)]
    rows = len(signed)
    batch = estimator.make_batch(name, rows)
    for k, (wrench, twist) in enumerate(samples(rng, 300)):
        readings = np.tile(np.concatenate([wrench, twist]), (rows, 1))
        if k % 7 == 3:
            columns = rng.choice(7, 3, replace=False) if place == "several" else [place]
            for column in columns:
                readings[:, column] = rng.permutation(signed)
        wrenches, twists = np.ascontiguousarray(readings[:, :4]), np.ascontiguousarray(readings[:, 4:])
        batch.update(k / RATE, wrenches, twists)
        assert_finite(batch, f"sample {k}")


@pytest.mark.parametrize("name", estimator.names())
@pytest.mark.parametrize("step", [5e-324, 1e-300, 1e-12, 1e6, 1e300])
def test_no_step_of_time_leaves_a_number_that_is_not_finite(name, step):
    batch, t = estimator.make_batch(name, 1), 0.0
    for k, (wrench, twist) in enumerate(samples(np.random.default_rng(1), 200)):
        t += step if k % 5 == 2 else 1.0 / RATE
        batch.update(t, wrench[np.newaxis], twist[np.newaxis])
        assert_finite(batch, f"sample {k}")


@pytest.mark.parametrize("name", estimator.names())
@pytest.mark.parametrize("value", [1e15, -1e200, math.nan, math.inf])
def test_a_row_with_a_reading_of_no_sensor_is_skipped(name, value):
    batch = estimator.make_batch(name, 7)
    wrenches, twists = np.tile([2.0, 0.0, 5.0, 0.01], (7, 1)), np.tile([0.01, 0.0, 0.1], (7, 1))
    for k in range(5):
        batch.update(k / RATE, wrenches, twists)
    before = batch.states.tobytes()
    np.fill_diagonal(wrenches, value)
    np.fill_diagonal(twists[4:], value)
    batch.update(5 / RATE, wrenches, twists)
    assert batch.states.tobytes() == before
