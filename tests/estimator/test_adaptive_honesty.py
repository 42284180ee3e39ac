"""What "adaptive" says of itself: deviations, confidence, bounds, matrices."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import estimator
from policies.leaderboard.imperfections import Imperfections, impaired
from tests.estimator.exact_records import RATE, ellipsoid, planar, run

LAB = {"velocity_delay": 2, "jitter": 0.2, "drop_outs": 0.01, "velocity_scale": 0.05, "force_delay": 0.004}
LAB |= {"zero_normal": 0.1, "cross_talk": 0.02, "zero": 0.1, "tilt": np.deg2rad(1.5), "cop": 0.001}


def last(record, **parameters):
    batch = estimator.make_batch("adaptive", len(record.wrenches), **parameters)
    for k, t in enumerate(record.t.tolist()):
        batch.update(t, *(np.ascontiguousarray(a[:, k]) for a in (record.wrenches, record.twists)))
    return batch.estimates


def within(estimates, record, field, deviations):
    truth = getattr(record, field)[-1]
    return np.mean(np.abs(estimates[field] - truth) <= deviations * estimates[f"sd_{field}"])


@pytest.mark.parametrize("turn", [0.0, 1.0])
def test_deviations_hold_the_truth_with_the_errors_of_a_laboratory(planar_slip, turn):
    """Not too small: 68 - 15 and 95 - 5 % of 200 fingers (a share of 0.68 of 200 is known to 3 %)."""
    record = planar_slip(turn, fingers=200, hertz=True, seed=7)
    estimates = last(impaired(record, Imperfections(**LAB), seed=11))
    for field in ("mu_c", "r"):
        assert within(estimates, record, field, 1.0) > 0.53, field
        assert within(estimates, record, field, 2.0) > 0.90, field


def test_deviations_fall_when_the_motion_shows_the_errors(planar_slip):
    known = {"sd_zero_torque": 1e-6}  # the zero error of the torque is the one that no turn shows
    steady, turning = (last(planar_slip(turn), **known) for turn in (0.0, 1.5))
    for field in ("mu_c", "r"):
        assert np.median(turning[f"sd_{field}"]) < 0.5 * np.median(steady[f"sd_{field}"])
        assert np.median(turning[f"confidence_{field}"]) > np.median(steady[f"confidence_{field}"])


def test_confidence_falls_while_nothing_slides(planar_slip):
    record = planar_slip(1.5)
    estimates = []
    batch = estimator.make_batch("adaptive", 8)
    for k in range(2400):
        i = min(k, len(record.t) - 1)
        still = k > i
        twists = np.zeros((8, 3)) if still else np.ascontiguousarray(record.twists[:, i])
        batch.update((k + 1) / RATE, np.ascontiguousarray(record.wrenches[:, i]), twists)
        estimates.append(batch.estimates.copy())
    before, after = estimates[len(record.t)], estimates[-1]
    assert (after["confidence_mu_c"] < before["confidence_mu_c"]).all()
    assert (after["sd_mu_c"] > before["sd_mu_c"]).all()
    np.testing.assert_allclose(after["mu_c"], before["mu_c"], rtol=0.02)


@pytest.mark.parametrize("r", [0.008, 0.022])
def test_nothing_is_known_of_an_r_beyond_the_pad(planar_slip, r):
    """Slips that ask for 22 mm on a pad of 15 mm: the deviation is that of the start; it is forgotten."""
    start = estimator.AdaptiveParameters().sd_log_r0
    batch, seen = estimator.make_batch("adaptive", 8), []
    for number, record in enumerate((planar_slip(1.0, r=r), planar_slip(1.0))):
        for k, t in enumerate(record.t.tolist()):
            sample = np.ascontiguousarray(record.wrenches[:, k]), np.ascontiguousarray(record.twists[:, k])
            batch.update(number * record.t[-1] + t, *sample)
        seen.append(batch.estimates.copy())
    beyond, after = (np.median(estimates["sd_r"] / estimates["r"]) for estimates in seen)
    if r > 0.015:
        np.testing.assert_allclose(seen[0]["r"], 0.015, rtol=1e-3)
        assert beyond > start
        assert (seen[0]["confidence_r"] < 0.05).all()
    else:
        assert beyond < 0.2 * start
    assert after < 0.2 * start
    np.testing.assert_allclose(np.median(seen[1]["r"]), 0.008, rtol=0.05)


def test_data_that_fit_no_law_widen_the_deviation(planar_slip):
    """Every sample is 30 % off, so the window's mean of 0.4 s is off by 30 % / sqrt(48) = 4 %."""
    good = planar_slip(1.0)
    rng = np.random.default_rng(0)
    factor = 1.0 + 0.3 * rng.standard_normal((8, len(good.t), 1))
    poor = dataclasses.replace(good, wrenches=good.wrenches * np.where(np.arange(4) == 2, 1.0, factor))
    noisy, clean = (last(record) for record in (poor, good))
    assert np.median(noisy["sd_mu_c"] / clean["sd_mu_c"]) > 1.2
    assert (np.abs(noisy["mu_c"] - clean["mu_c"]) < 2.0 * noisy["sd_mu_c"]).all()


@pytest.mark.parametrize("mu_c0", [0.2, 0.6, 1.3])
@pytest.mark.parametrize("r0", [0.002, 0.006, 0.015])
def test_no_start_value_locks_it_out(planar_slip, mu_c0, r0):
    estimates = last(planar_slip(0.0, fingers=4), mu_c0=mu_c0, mu_s0=max(mu_c0, 0.9), r0=r0)
    np.testing.assert_allclose(estimates["mu_c"], 0.4, rtol=0.05)
    np.testing.assert_allclose(estimates["r"], 0.008, rtol=0.05)


anything = st.one_of(st.floats(-1e3, 1e3), st.floats(allow_nan=False, allow_infinity=False))


@settings(deadline=None, max_examples=50)
@given(st.lists(st.tuples(*[anything] * 7), min_size=1, max_size=60), st.integers(0, 2**32 - 1))
def test_estimates_stay_finite_and_in_bounds(rows, seed):
    limits, est = estimator.AdaptiveParameters(), estimator.make("adaptive")
    rng = np.random.default_rng(seed)
    usual = rng.normal(scale=(2, 2, 2, 0.03, 0.01, 0.01, 1.0), size=(200, 7)) + np.array(
        [0, 0, 5, 0, 0.01, 0, 0]
    )
    for k, row in enumerate([*usual.tolist(), *rows, *usual.tolist()]):
        e = est.update((k + 1) / RATE, row[:4], row[4:])
        assert limits.mu_min <= e.mu_c <= e.mu_s <= limits.mu_max
        assert limits.r_min * (1 - 1e-12) <= e.r <= limits.r_max * (1 + 1e-12)
        for name in ("mu_s", "mu_c", "r"):
            assert 0.0 <= getattr(e, f"confidence_{name}") <= 1.0
            assert 0.0 <= getattr(e, f"sd_{name}") < np.inf
    assert np.isfinite(est.batch.states["x"]).all()
    assert (np.linalg.eigvalsh(est.batch.states["covariance"][0]) > -1e-9).all()


def test_it_says_when_it_learns(planar_slip):
    record, est = planar_slip(1.0, fingers=1), estimator.make("adaptive")
    previous = est.estimate
    for t, wrench, twist in zip(record.t, record.wrenches[0], record.twists[0], strict=True):
        e = est.update(t, wrench, twist)
        assert e.updates_mu_c - previous.updates_mu_c == e.observable_mu_c
        assert e.updates_r - previous.updates_r == e.observable_r
        previous = e
    assert previous.updates_r > 20


def test_mu_s_follows_a_stick_that_contradicts_it():
    """A stick that carries more than mu_s f_n refutes an old event."""
    est = estimator.make("adaptive")
    run(est, [(k / RATE, (0.0, 1.0, 3.0, 0.0), (0.0, 0.0, 0.0)) for k in range(30)])
    run(est, [(k / RATE, (0.0, 0.9, 3.0, 0.0), (0.0, 0.02, 0.0)) for k in range(30, 40)])
    run(est, [(k / RATE, (0.0, 1.0, 3.0, 0.0), (0.0, 0.0, 0.0)) for k in range(40, 60)])
    assert est.estimate.mu_s == pytest.approx(1.0 / 3.0, rel=0.02)
    run(est, [(k / RATE, (0.0, 1.8, 3.0, 0.0), (0.0, 0.0, 0.0)) for k in range(60, 80)])
    assert est.estimate.mu_s == pytest.approx(0.6, rel=0.02)


def test_covariance_is_that_of_the_logarithms():
    est = estimator.make("adaptive")
    e = run(est, ellipsoid(120, *planar(0.7, 0.01), 0.4, 0.01))[-1]
    assert np.sqrt(est.covariance[0, 0]) <= e.sd_mu_c / e.mu_c
