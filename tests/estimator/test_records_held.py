"""Velocities that a log repeats until the next one are recognised and read once; others are not touched."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from estimator import records
from estimator.records.alignment import align, held
from estimator.records.readings import reading_warnings


def sensor(rate, seconds=3.0):
    """Times and twists of a sensor whose object slips, sticks for 0.5 s and slips."""
    t = np.arange(1 / rate, seconds, 1 / rate)
    noise = 1.0 + 0.05 * np.random.default_rng(0).standard_normal((len(t), 3))
    twist = np.column_stack([0.01 * np.sin(4 * t), 0.02 + 0.0 * t, np.cos(3 * t)]) * noise
    twist[(t > 1.0) & (t < 1.5)] = 0.0
    return t, twist


def rows_of(table_t, t, twist):
    at = np.searchsorted(t, table_t + 1e-9, side="right") - 1
    return np.where(at[:, None] >= 0, twist[at], 0.0)


@pytest.mark.parametrize("rate", [30, 60, 120, 125, 240, 333, 500])
@pytest.mark.parametrize("jitter", [0.0, 0.1])
def test_a_hold_is_read_once(table, save, rate, jitter):
    t, twist = sensor(rate)
    t = t + jitter / rate * np.random.default_rng(1).random(len(t))
    at = np.arange(1, 3001) / 1000
    at_rows = rows_of(at, t, twist)
    forces = table.dropna(subset="f_n").iloc[np.arange(3000) % 2000].reset_index(drop=True)
    frame = forces.assign(t=at, **dict(zip(("v_x", "v_y", "omega"), at_rows.T, strict=True)))
    record = records.load(save(frame))
    assert record.hold == pytest.approx(1 / rate, rel=0.01)
    assert len(record.twist_t) == pytest.approx(len(t), abs=3)
    np.testing.assert_array_equal(np.unique(record.twist, axis=0), np.unique(at_rows, axis=0))
    (line,) = [line for line in reading_warnings(record, align(record)) if "held" in line]
    assert line.startswith(
        f"Warning: the velocities are held: rows repeat each for {1e3 * record.hold:.3g} ms"
    )


def test_the_example_in_one_rate_is_estimated_as_in_two(tmp_path):
    frame = pd.read_csv(Path(__file__).parents[2] / "examples" / "linear_slip_wood.csv.gz")
    frame = frame[frame["t"] < 2.0]
    names = ["v_x", "v_y", "omega"]
    one = frame.assign(**frame[names].ffill().fillna(0.0))[frame["f_n"].notna()]
    estimated = []
    for each in (frame, one):
        each.to_parquet(tmp_path / "log.parquet", index=False)
        estimated.append(records.estimate(records.load(tmp_path / "log.parquet")).estimates[-1])
    assert estimated[1]["mu_s"] == pytest.approx(estimated[0]["mu_s"], rel=0.05)


def test_velocities_that_are_not_held(planar_slip, stick_slip, short_slips):
    for make in (planar_slip, stick_slip, short_slips):
        record = make(fingers=4)
        for twist in record.twists:
            assert held(record.t, twist) is None


def test_a_ramp_in_coarse_counts_is_not_held():
    t = np.arange(1, 2001) / 1000
    ramp = np.floor(100 * t) * 1e-3
    assert held(t, np.column_stack([ramp, 0 * t, 0 * t])) is None
    steady = np.full((len(t), 3), 0.02)
    assert held(t, steady) is None
