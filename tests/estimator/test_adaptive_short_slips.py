"""Slips too short for pairs of velocity windows: "adaptive" learns mu_c from the fall of the force."""

import numpy as np
import pytest

import estimator
from policies.leaderboard.imperfections import Imperfections, impaired
from tests.estimator.exact_records import RATE


def last(record):
    batch = estimator.make_batch("adaptive", len(record.wrenches))
    for k, t in enumerate(record.t.tolist()):
        batch.update(t, *(np.ascontiguousarray(a[:, k]) for a in (record.wrenches, record.twists)))
    return batch


def lengths(record):
    """Lengths of the slips in samples."""
    edges = np.diff((record.phase == "slip").astype(int), prepend=0, append=0)
    return np.flatnonzero(edges < 0) - np.flatnonzero(edges > 0)


@pytest.mark.parametrize("jitter", [0.0, 0.3])
@pytest.mark.parametrize("delay", [0, 1, 3])
@pytest.mark.parametrize("mu_c", [0.25, 0.5])
def test_short_slips_teach_mu_c_whatever_the_delay(short_slips, mu_c, delay, jitter):
    """A sample has a deviation of 2 % from f_t, 2 % from f_n, 3 % of the law: 5 % for one, less for some."""
    plain = short_slips(mu_c=mu_c, mu_s=1.35 * mu_c)
    assert len(lengths(plain)) > 5
    assert lengths(plain).max() <= 3
    batch = last(impaired(plain, Imperfections(velocity_delay=delay, jitter=jitter), seed=delay))
    e = batch.estimates
    assert (e["updates_mu_c"] > 0).all()
    assert np.median(e["updates_mu_c"]) >= 5
    np.testing.assert_allclose(e["mu_c"], mu_c, rtol=0.08)
    assert np.mean(e["mu_c"]) == pytest.approx(mu_c, rel=0.03)
    assert np.median(np.abs(e["mu_c"] / mu_c - 1.0) * mu_c / e["sd_mu_c"]) < 1.0


def test_a_short_slip_of_one_finger_does_not_affect_the_next_row(short_slips, planar_slip):
    short, long = short_slips(mu_c=0.3, mu_s=0.4), planar_slip(1.5)
    alone, pair = estimator.make_batch("adaptive", 1), estimator.make_batch("adaptive", 2)
    for k, t in enumerate(short.t.tolist()):
        i = k % len(long.t)
        for batch, rows in ((alone, (long,)), (pair, (short, long))):
            at = [k if row is short else i for row in rows]
            wrenches = np.stack([row.wrenches[0, j] for row, j in zip(rows, at, strict=True)])
            twists = np.stack([row.twists[0, j] for row, j in zip(rows, at, strict=True)])
            batch.update(t, wrenches, twists)
        assert pair.states[1].tobytes() == alone.states[0].tobytes(), t
    assert pair.estimates["updates_mu_c"][0] > 5


def test_a_pad_that_springs_does_not_slip():
    """A load that swings on a spring of 5 N/mm, 3 to 40 Hz, below static friction: nothing is learned."""
    t = np.arange(1, 601) / RATE
    fine = (np.arange(600 * 20) + 0.5) / (RATE * 20)
    rng = np.random.default_rng(0)
    for frequency in (3.0, 10.0, 25.0, 40.0):
        load = 1.0 - 0.5 * np.cos(2 * np.pi * frequency * t)
        rate = 0.5 * 2 * np.pi * frequency * np.sin(2 * np.pi * frequency * fine)
        speed = 2e-4 * rate.reshape(600, 20).mean(axis=1)
        assert np.abs(speed).max() > 1.5e-3
        est = estimator.make("adaptive")
        for k in range(600):
            wrench = np.array([0.0, load[k], 5.0, 0.0]) + rng.normal(size=4) * (0.02, 0.02, 0.04, 5e-4)
            e = est.update(t[k], wrench, (0.0, speed[k], 0.0))
        assert (e.updates_mu_c, e.events_mu_s) == (0, 0), frequency


def test_a_load_that_is_taken_off_is_no_slip():
    """The force falls by a third, and the object does not move along it."""
    est = estimator.make("adaptive")
    for k in range(120):
        load = 1.5 if k < 60 else 1.0
        speed = -0.005 if k in (60, 61) else 0.0  # it springs back 0.08 mm
        e = est.update((k + 1) / RATE, (0.0, load, 5.0, 0.0), (0.0, speed, 0.0))
    assert e.updates_mu_c == 0
