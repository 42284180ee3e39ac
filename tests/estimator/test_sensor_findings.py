"""What "adaptive" found out about the sensors, as a record's report says it."""

from dataclasses import replace

import numpy as np
import pytest

from estimator import records
from estimator.records.record import Record
from estimator.records.summary import markdown

OPEN = 60
NOISE = (0.02, 0.02, 0.04, 5e-4)  # [N, N, N, N m]


def recorded(wrenches, twists):
    t = np.arange(1, len(wrenches) + 1) / 120
    return Record("log.csv", t, wrenches, None, t, twists, None)


@pytest.fixture(scope="module")
def calibrated(planar_slip):
    """An open gripper, then a slip that turns; zero errors of 0.3, -0.1, 0.2 N, a CoP at (2, -1) mm."""
    finger = planar_slip(fingers=1, turn=1.5)
    wrench, twist = finger.wrenches[0].copy(), finger.twists[0].copy()
    wrench[:, 3] += 2e-3 * wrench[:, 1] + 1e-3 * wrench[:, 0]
    twist[:, 0] += -1e-3 * twist[:, 2]
    twist[:, 1] -= 2e-3 * twist[:, 2]
    unloaded = np.random.default_rng(0).standard_normal((OPEN, 4)) * list(NOISE)
    wrenches = np.concatenate((unloaded, wrench)) + np.array([0.3, -0.1, 0.2, 0.0])
    return records.estimate(recorded(wrenches, np.concatenate((np.zeros((OPEN, 3)), twist))))


def test_zero_errors_and_the_cop_are_found_with_their_deviations(calibrated):
    errors = {error.name: error for error in calibrated.calibration.errors}
    true = {"zero of f_x": 0.3, "zero of f_y": -0.1, "zero of f_n": 0.2, "zero of tau": 0.0}
    for name, value in (true | {"CoP, x": 2.0, "CoP, y": -1.0}).items():
        error = errors[name]
        assert error.seen
        assert abs(error.value - value) < 2.0 * error.sd, name
        assert abs(error.value - value) < max(abs(value), 0.5 * error.spread), name  # better than not to know
        assert error.sd < error.spread


def test_the_report_and_the_page_show_them(calibrated):
    report, page = records.report(calibrated), markdown(calibrated)
    assert "sensors" in report.splitlines()[-14]
    assert "zero of f_n [N]" in report
    assert "## What it found about the sensors\n\n| sensors | found | sd | sd before |\n" in page
    other = records.estimate(calibrated.record, "disc")
    assert other.calibration is None
    assert "sd before" not in records.report(other)


@pytest.mark.parametrize("late", [0, 2])
def test_the_delay_is_found_or_said_to_be_assumed(stick_slip, calibrated, late):
    finger = stick_slip(fingers=1)
    twist = np.concatenate((np.zeros((late, 3)), finger.twists[0]))[: len(finger.t)]
    found = records.estimate(recorded(finger.wrenches[0], twist))
    assert found.calibration.delay == late
    assert found.calibration.delay_seen
    assert f"{late} samples, {1e3 * late / 120:.1f} ms  correlation 0." in records.report(found)
    assert not calibrated.calibration.delay_seen  # nothing but steady slip
    assert "1 sample, 8.3 ms  not seen: assumed" in records.report(calibrated)


def test_what_was_not_seen_is_a_dash(calibrated):
    short = replace(
        calibrated.record, force_t=calibrated.record.force_t[:50], wrench=calibrated.record.wrench[:50]
    )
    found = records.estimate(replace(short, twist_t=short.twist_t[:50], twist=short.twist[:50]))
    errors = {error.name: error for error in found.calibration.errors}
    assert errors["zero of f_x"].seen
    assert not errors["CoP, x"].seen
    assert "CoP, x [mm]                            –" in records.report(found)
