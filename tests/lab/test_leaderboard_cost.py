"""The yardsticks compute what the estimators do, and cost more."""

import numpy as np
import pytest

import estimator
from lab.leaderboard.cost import costs
from lab.leaderboard.yardsticks import FilterpyUkf, NumpyRls
from tests.estimator.exact_records import ellipsoid, planar

SLIP = [
    (t, np.array(wrench), np.array(twist))
    for t, wrench, twist in ellipsoid(240, *planar(0.7, 0.01), mu_c=0.4, r=0.01)
]


def test_numpy_rls_is_rls():
    ours, plain = estimator.make("rls"), NumpyRls()
    for sample in SLIP:
        e = ours.update(*sample)
        assert plain.update(*sample) == pytest.approx((e.mu_c, e.r), rel=1e-9)
    assert e.updates_mu_c == e.updates_r == len(SLIP)


def test_filterpy_ukf_is_ukf():
    """The same five points, weights and noise; "ukf" waits for its first pair of windows."""
    ours, theirs = estimator.make("ukf"), FilterpyUkf()
    waited = ours.parameters.velocity_delay + 2
    for k, sample in enumerate(SLIP):
        e = ours.update(*sample)
        if k >= waited:
            assert theirs.update(*sample) == pytest.approx((e.mu_c, e.r), rel=1e-9)
    assert e.updates_mu_c > 0
    assert (e.sd_mu_c, e.sd_r) == pytest.approx(
        np.array([e.mu_c, e.r]) * np.sqrt(np.diag(theirs.filter.P)), rel=1e-9
    )


def test_costs_by_wide_margins():
    """Ratios in one run, each a good part of an order of magnitude below what a quiet machine shows."""
    table = costs(fingers=1024, calls=50, rounds=4).set_index("estimator")
    assert list(table.index) == [*estimator.names(), "numpy RLS", "filterpy UKF"]
    python, batch = table["python_us"], table["batch_ns"]
    assert 1e-3 * batch["disc"] < 0.1 * python["numpy RLS"]
    assert 1e-3 * batch["ukf"] < 0.1 * python["filterpy UKF"]
    assert python["disc"] < python["numpy RLS"]
    assert python["ukf"] < 0.2 * python["filterpy UKF"]
    assert batch["disc"] < batch["ukf"]
