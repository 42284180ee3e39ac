"""Fingers whose force/torque sensors are late by times of their own, by the readings alone."""

import math

import numpy as np
import pytest

from slipgym.sensors.force_torque import next_sample, read_force_torque
from slipgym.sensors.starting import draw_sensors, start_sensors
from slipgym.validation.bench import Bench

LATE = {"latency": 0.002, "latency_spread": 0.05}
TICK = 1.0 / 12_000


def readings(engine: str, seed: int, own: bool) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times of the readings, f_x of both fingers (n, 2) while the wrist nods, and their delays [s].

    The weight turns smoothly in the pads' frame. A shaken wrist would not show less than a control step: its
    acceleration is constant within one.
    """
    overrides = {"sensors": {"force_torque": {**LATE, "own_latency": own}}}
    rows, reading = [], np.zeros(6)
    with Bench(overrides, force=20.0, engine=engine) as bench:
        plant = bench.plant
        keys = draw_sensors(2, np.random.default_rng(seed))
        start_sensors(plant.force_torque[0], plant.slip_sensors[0], *keys)
        bench.settle()
        for k in range(240):
            t = (k + 1) * bench.step_time
            rate = 1.9 * math.sin(math.tau * 3.0 * t) + 0.9 * math.sin(math.tau * 7.3 * t + 1.0)
            bench.run(bench.step_time, wrist=lambda _, rate=rate: (0.0, 0.0, rate))
            row = []
            for f in range(2):
                read_force_torque(plant.force_torque[0, f], int(plant.world["tick"][0]), reading)
                row.append(reading[0])
            rows.append(row)
        delays = plant.force_torque["delay"][0] * TICK
    return np.arange(1, 241) / 120.0, np.array(rows), delays


def lag_between(times: np.ndarray, pair: np.ndarray) -> float:
    """Time by which the second of two signals follows the first: where their cross-correlation is largest."""
    inner = np.linspace(times[20], times[-20], 4000)
    first, lags = np.interp(inner, times, pair[:, 0]), np.arange(-0.06, 0.06, 5e-4)
    sums = [np.corrcoef(first, np.interp(inner + lag, times, pair[:, 1]))[0, 1] for lag in lags]
    assert max(sums) > 0.98
    return float(lags[int(np.argmax(sums))])


@pytest.mark.parametrize("engine", ["planar", "bullet"])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_the_cross_correlation_of_both_fingers_shows_their_latencies(engine, seed):
    times, pair, delays = readings(engine, seed, own=True)
    assert abs(delays[1] - delays[0]) > 0.003
    # a reading is the newest sample of 1 kHz at its age
    assert lag_between(times, pair) == pytest.approx(delays[1] - delays[0], abs=1.6e-3)


@pytest.mark.parametrize("engine", ["planar", "bullet"])
def test_fingers_on_one_bus_read_the_same(engine):
    _, pair, delays = readings(engine, 0, own=False)
    assert delays[0] == delays[1]
    np.testing.assert_allclose(pair[:, 0], pair[:, 1], atol=1e-9)


@pytest.mark.parametrize("delays", [(0, 0), (7, 130), (130, 7), (24, 25), (600, 1)])
def test_the_planar_engine_takes_the_samples_of_both_fingers(delays):
    with Bench({"sensors": {"force_torque": {"latency": 0.05}}}, engine="planar") as bench:
        pair = bench.plant.force_torque[0]
    pair["delay"] = delays
    readings = [(tick, late) for tick in range(100, 6000, 100) for late in delays if tick >= late + 12]
    asked = {(tick - late) // 12 * 12 for tick, late in readings}
    tick, found = 0, []
    while tick < 5000:
        tick = next_sample((pair[0], pair[1]), tick, 100)
        found.append(tick)
    assert found == sorted(asked)[: len(found)]
