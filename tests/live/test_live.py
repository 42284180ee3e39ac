"""Live estimates are those of the record of the same readings, and no reading is lost uncounted."""

import math
import random
from pathlib import Path

import numpy as np
import pytest

from estimator import records
from estimator.live import Live, Log
from estimator.live import records as of_log
from estimator.live.source import CAPACITY, LEARNED, RESTART
from estimator.records.separated import read_csv
from lab.live_streams import faulty, feed, readings

ROOT = Path(__file__).parents[2]
SHIPPED = ROOT / "examples" / "linear_slip_wood.csv.gz"
WRENCH, TWIST = ["f_x", "f_y", "f_n", "tau"], ["v_x", "v_y", "omega"]
REFUSED = ("late", "duplicate", "not_finite", "too_large", "jump", "clock", "width", "overflow")


def shipped():
    """The readings of the example record, as its rows have them."""
    table = read_csv(SHIPPED, [*WRENCH, *TWIST])[0]
    tilt = [name for name in ("tau_x", "tau_y") if name in table]
    rows = [
        (kind, t, values)
        for kind, names in (("wrench", [*WRENCH, *tilt]), ("twist", TWIST))
        for t, *values in table.dropna(subset=names)[["t", *names]].itertuples(index=False)
    ]
    return sorted(rows, key=lambda row: row[1])


@pytest.fixture
def log(tmp_path):
    book = Log(tmp_path / "log.jsonl")
    yield book
    book.close()


def same(outputs, result):
    """Whether outputs are the estimates of a result, bit for bit."""
    found = [tuple(output.estimate) for output in outputs]
    times = [output.t for output in outputs]
    return times == result.samples.t.tolist() and found == result.estimates.tolist()


def nothing_lost(live):
    for name, n in live.counts.items():
        assert n["received"] == n["accepted"] + sum(n[why] for why in REFUSED), (name, n)
        if name.startswith("velocity"):
            assert n["accepted"] == n["estimated"] + n["no_force"] + n["waiting"], (name, n)


@pytest.mark.parametrize("name", ["rls", "adaptive"])
def test_a_record_fed_sample_by_sample_gives_the_estimates_of_the_record(name):
    live = Live(name, fingers=1)
    outputs = feed(live, shipped()) + live.flush()
    assert same(outputs, records.estimate(records.load(SHIPPED), name))
    assert len(outputs) > 100
    nothing_lost(live)


def test_and_so_it_does_shuffled_within_the_lateness():
    rng = random.Random(1)
    shuffled = sorted(shipped(), key=lambda row: row[1] + rng.uniform(0.0, 0.0099))
    assert [row[1] for row in shuffled] != sorted(row[1] for row in shuffled)
    live = Live("rls", fingers=1, lateness=0.01)
    outputs = feed(live, shuffled) + live.flush()
    assert same(outputs, records.estimate(records.load(SHIPPED), "rls"))
    assert not any(n["late"] for n in live.counts.values())


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("width", [4, 6])
def test_under_faults_the_estimates_are_those_of_the_accepted_readings(seed, width, log):
    live = Live("rls", fingers=1, log=log)
    outputs = feed(live, faulty(readings(6.0, seed, width), seed)) + live.flush()
    (record,) = of_log(log.path)[1]
    assert same(outputs, records.estimate(record, "rls", allow_gaps=True))
    for why in ("late", "duplicate", "not_finite", "missing"):
        assert live.counts["force 1"][why] > 0, why
    nothing_lost(live)
    assert {output.status for output in outputs} > {"ok"}


@pytest.mark.parametrize("kind", ["wrench", "twist"])
def test_a_gap_begins_afresh_as_in_a_record(kind, log):
    live = Live("rls", fingers=1, log=log)
    stream = [row for row in readings(4.0) if row[0] != kind or not 2.3 < row[1] < 2.4]
    outputs = feed(live, stream) + live.flush()
    (record,) = of_log(log.path)[1]
    result = records.estimate(record, "rls", allow_gaps=True)
    assert same(outputs, result)
    assert result.samples.segment[-1] == 1
    assert next(output.status for output in outputs if "gap" in output.status).startswith("gap 1")


def test_two_fingers_do_not_mix():
    live, alone = Live("rls"), [Live("rls", fingers=1) for _ in range(2)]
    both = [[], []]
    streams = [list(readings(1.0, seed)) for seed in range(2)]
    for rows in zip(*streams, strict=True):
        for finger, (kind, t, values) in enumerate(rows, 1):
            take = live.feed_wrench if kind == "wrench" else live.feed_twist
            for output in take(finger, t, values, t):
                both[output.finger - 1].append(output)
    for output in live.flush():
        both[output.finger - 1].append(output)
    for k in range(2):
        wanted = feed(alone[k], streams[k]) + alone[k].flush()
        assert [output.estimate for output in wanted] == [output.estimate for output in both[k]]


def test_every_refusal_is_counted_and_told_with_the_next_estimate():
    live = Live("rls", fingers=1)
    feed(live, readings(0.5, width=4))
    good = [0.1, 0.0, 5.0, 0.0]
    before = live.counts["force 1"]["received"]
    for t, values in (
        (0.2, good),
        (0.499, good),
        (0.51, [math.nan, 0.0, 5.0, 0.0]),
        (math.inf, good),
        (0.51, [1e12, 0.0, 5.0, 0.0]),
        (5e8, good),
        (0.51, [*good, 0.0, 0.0]),
    ):
        assert live.feed_wrench(1, t, values, 0.51) == []
    counts = live.counts["force 1"]
    refused = {why: counts[why] for why in REFUSED if counts[why]}
    assert refused == {"late": 1, "duplicate": 1, "not_finite": 2, "too_large": 1, "jump": 1, "width": 1}
    assert counts["received"] == before + 7
    (output, *_) = feed(live, [(kind, t, v) for kind, t, v in readings(0.6, width=4) if t > 0.5])
    assert output.status == "duplicate 1, jump 1, late 1, not_finite 2, too_large 1, width 1"
    nothing_lost(live)


def test_missing_samples_are_those_that_never_came():
    live = Live("rls", fingers=1)
    stream = list(readings(2.0))
    gone = {100, 101, 500, 900}
    feed(live, [row for k, row in enumerate(stream) if k not in gone])
    kinds = [stream[k][0] for k in gone]
    assert live.counts["force 1"]["missing"] == kinds.count("wrench")
    assert live.counts["velocity 1"]["missing"] == kinds.count("twist")


def test_jitter_of_the_stamps_is_not_taken_for_missing_samples():
    live, rng = Live("rls", fingers=1), np.random.default_rng(0)
    feed(live, [(kind, t + 0.0009 * rng.random(), values) for kind, t, values in readings(2.0)])
    assert live.counts["force 1"]["missing"] <= 1


def test_a_sensor_that_starts_again_from_zero_is_followed(log):
    live = Live("rls", fingers=1, log=log)
    first, second = readings(2.0), readings(2.0, 1)
    outputs = feed(live, [(kind, t + 100.0, values, t) for kind, t, values in first])
    outputs += feed(live, [(kind, t, values, t + 5.0) for kind, t, values in second]) + live.flush()
    assert live.counts["force 1"]["jump"] == RESTART - 1
    assert live.counts["force 1"]["restart"] >= 1
    assert outputs[-1].t > 1.9
    assert outputs[-1].estimate.updates_mu_c > 0
    nothing_lost(live)
    for record in of_log(log.path)[1]:
        assert (np.diff(record.force_t) > 0).all()
    last = records.estimate(of_log(log.path)[1][-1], "rls", allow_gaps=True)
    assert outputs[-1].estimate == tuple(last.estimates[-1])


@pytest.mark.parametrize("wild", [1e300, -1e300, 1e18, 5.0])
def test_wild_stamps_among_good_ones_do_no_harm(wild):
    live, quiet, stream = Live("rls", fingers=1), Live("rls", fingers=1), list(readings(2.0))
    noisy = []
    for k, (kind, t, values) in enumerate(stream):
        noisy.append((kind, t, values, t))
        if k % 10 == 3:
            noisy.append((kind, wild * (1.0 + k), values, t))
    wanted = [output.estimate for output in feed(quiet, stream)]
    assert [output.estimate for output in feed(live, noisy)] == wanted
    assert live.counts["force 1"]["jump"] > 50


def test_a_first_stamp_that_is_wild_is_recovered_from():
    live = Live("rls", fingers=1)
    live.feed_wrench(1, 1e300, [0.0, 0.0, 5.0, 0.0, 0.0, 0.0], 0.0)
    outputs = feed(live, readings(2.0))
    assert len(outputs) > 200


def test_a_stall_of_the_network_loses_nothing():
    live = Live("rls", fingers=1)
    stalled = [(kind, t, values, max(t, 1.9) if t > 0.5 else t) for kind, t, values in readings(2.0)]
    feed(live, stalled)
    assert all(n["accepted"] == n["received"] for n in live.counts.values())


def test_the_offset_of_two_clocks_is_found_and_told():
    live = Live("rls", fingers=1)
    shifted = [(kind, t + 0.07 * (kind == "twist"), values, t + 0.001) for kind, t, values in readings(1.0)]
    feed(live, shifted)
    clocks = live.clocks()
    assert clocks["force 1"] == pytest.approx(0.001, abs=1e-6)
    assert clocks["velocity 1"] == pytest.approx(-0.069, abs=1e-6)
    (line,) = live.warnings().values()
    assert "+0.070 s" in line


@pytest.mark.parametrize("offset", [0.07, -3.2, 1.7e9])
def test_by_arrival_sensors_with_clocks_of_their_own_are_paired(offset, log):
    live = Live("rls", fingers=1, clocks="arrival", lateness=0.004, log=log)
    rng, stream = np.random.default_rng(0), []
    for kind, t, values in readings(3.0):
        stream.append((kind, t + offset * (kind == "twist"), values, t + 0.002 * rng.random()))
    outputs = feed(live, sorted(stream, key=lambda row: row[3])) + live.flush()
    truth = feed(whole := Live("rls", fingers=1), readings(3.0)) + whole.flush()
    assert outputs[-1].estimate.mu_c == pytest.approx(truth[-1].estimate.mu_c, rel=0.02)
    assert outputs[-1].estimate.updates_mu_c > 0.7 * truth[-1].estimate.updates_mu_c
    assert live.counts["force 1"]["clock"] == live.counts["velocity 1"]["clock"] == LEARNED
    assert live.warnings() == {}
    (record,) = of_log(log.path)[1]
    assert same(outputs, records.estimate(record, "rls", allow_gaps=True))


def test_by_arrival_clocks_that_drift_apart_are_told():
    live = Live("rls", fingers=1, clocks="arrival")
    drifted = [(kind, t * (1.0 + 0.01 * (kind == "twist")), values, t) for kind, t, values in readings(20.0)]
    feed(live, drifted)
    assert live.warnings() != {}


@pytest.mark.parametrize("silent", ["wrench", "twist", "neither"])
def test_memory_is_bounded_whatever_stops(silent):
    live = Live("rls", fingers=1)
    most = 0
    for row in readings(5.0):
        if row[0] != silent:
            feed(live, [row])
            most = max(most, *(n["waiting"] for n in live.counts.values()))
    assert most < 20
    nothing_lost(live)


def test_a_flood_within_the_lateness_is_refused_and_counted():
    live = Live("rls", fingers=1)
    live.feed_wrench(1, 1.0, [0.0, 0.0, 5.0, 0.0], 1.0)
    for k in range(CAPACITY + 100):
        live.feed_wrench(1, 1.0 + 1e-3 * k / (CAPACITY + 100), [0.0, 0.0, 5.0, 0.0], 1.0)
    counts = live.counts["force 1"]
    assert counts["waiting"] == CAPACITY
    assert counts["overflow"] == 100
    nothing_lost(live)


def test_silent_sensors_are_named():
    live = Live("rls", fingers=1)
    assert live.silent(0.0, 1e9) == ["force 1", "velocity 1"]
    feed(live, [row for row in readings(1.0) if row[0] == "wrench"])
    assert live.silent(1.0, 0.1) == ["velocity 1"]
    live.feed_wrench(1, 1.5, [math.nan] * 6, 1.5)  # a sensor that gives NaN is as good as silent
    assert live.silent(1.5, 0.1) == ["force 1", "velocity 1"]


@pytest.mark.parametrize(
    ("finger", "stamp", "wrench"),
    [
        (3, 0.0, [0.0] * 4),
        (True, 0.0, [0.0] * 4),
        ([1], 0.0, [0.0] * 4),
        (1, "0", [0.0] * 4),
        (1, 10**400, [0.0] * 4),
        (1, 0.0, [0.0] * 5),
        (1, 0.0, "1234"),
        (1, 0.0, [True] * 4),
        (1, 0.0, 7.0),
        (1, 0.0, [[0.0]] * 4),
    ],
)
def test_what_is_no_reading_is_a_value_error(finger, stamp, wrench):
    live = Live("rls")
    with pytest.raises(ValueError, match="expected"):
        live.feed_wrench(finger, stamp, wrench)
    assert live.counts["force 1"]["received"] == 0


@pytest.mark.parametrize(
    ("argument", "value"),
    [("fingers", 0), ("rates", (1000.0, 0.0)), ("lateness", -1.0), ("lateness", math.nan), ("clocks", "ntp")],
)
def test_arguments_are_checked(argument, value):
    with pytest.raises(ValueError, match="expected"):
        Live("rls", **{argument: value})
