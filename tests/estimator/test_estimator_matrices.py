"""Residual, gain and covariance of the recursive filters, and what they print."""

import numpy as np
import pytest

import estimator
from tests.estimator.exact_records import ellipsoid, planar, run

MU_C, R = 0.4, 0.01
SHAPES = {"residual": (2,), "gain": (2, 2), "covariance": (2, 2), "innovation_covariance": (2, 2)}
HAS = {
    "adaptive": {"covariance"},
    "rls": {"residual", "gain", "covariance"},
    "ukf": set(SHAPES),
    "joint": {"covariance"},
    "disc": {"covariance"},
}


@pytest.mark.parametrize("name", estimator.names())
def test_each_estimator_has_its_matrices(name):
    est, batch = estimator.make(name), estimator.make_batch(name, 3)
    for when in ("start", "later"):
        for which, shape in SHAPES.items():
            single, rows = getattr(est, which), getattr(batch.matrices, which)
            if which not in HAS[name]:
                assert single is None
                assert rows is None
                continue
            assert single.shape == shape
            assert rows.shape == (3, *shape)
            if when == "start" and which != "covariance":
                assert not single.any()
            if which.endswith("covariance"):
                np.testing.assert_array_equal(single, single.T)
        if when == "start":
            run(est, ellipsoid(60, *planar(0.7, R), MU_C, R))
    covariance = est.covariance
    if "covariance" not in HAS[name]:
        return
    assert covariance is not None
    assert (np.linalg.eigvalsh(covariance) > 0.0).all()
    assert not np.shares_memory(covariance, est.batch.states)


def test_an_estimator_of_ones_own_has_none():
    assert estimator.FilterMatrices() == (None, None, None, None)


def test_rls_equations():
    """y = f_t - phi mu_c, K = P phi / (lambda + phi^2 P), mu_c += K y, P = P / (lambda + phi^2 P)."""
    est = estimator.make("rls", heuristic=False)
    (first, second), before = ellipsoid(2, *planar(0.7, R), MU_C, R), est.estimate
    for t, wrench, twist in (first, second):
        p = np.diag(est.covariance)
        e = est.update(t, wrench, twist)
        f_t, f_n, tau = np.hypot(*wrench[:2]), wrench[2], abs(wrench[3])
        phi = np.array([e.gamma_t * f_n, e.gamma_tau * e.mu_c * f_n])
        y = np.array([f_t, tau]) - phi * (before.mu_c, before.r)
        gain = p * phi / (0.98 + phi**2 * p)
        np.testing.assert_allclose(est.residual, y, rtol=1e-12)
        np.testing.assert_allclose(est.gain, np.diag(gain), rtol=1e-12)
        np.testing.assert_allclose((e.mu_c, e.r), np.array([before.mu_c, before.r]) + gain * y, rtol=1e-12)
        np.testing.assert_allclose(
            est.covariance, np.diag(np.minimum(p / (0.98 + phi**2 * p), 1.0)), rtol=1e-12
        )
        before = e
    kept = est.residual
    est.update(1.0, (0.1, 0.0, 5.0, 0.0), (0.0, 0.0, 0.0))  # stick: no update
    np.testing.assert_array_equal(est.residual, kept)


def test_ukf_equations():
    """x += K y and P = P' - K S K^T on (ln mu_c, ln r), P' with the random walk added."""
    est, updated = estimator.make("ukf"), 0
    for sample in ellipsoid(40, *planar(0.7, R), MU_C, R):
        before, p = est.batch.states[0].copy(), est.covariance
        e = est.update(*sample)
        if not e.observable_mu_c:
            continue
        updated += 1
        p[[0, 1], [0, 1]] = np.minimum(np.diag(p) + est.parameters.drift**2, 1.0)
        x = np.log((before["mu_c"], before["r"])) + est.gain @ est.residual
        np.testing.assert_allclose(np.log((e.mu_c, e.r)), x, rtol=1e-9)
        expected = p - est.gain @ est.innovation_covariance @ est.gain.T
        np.testing.assert_allclose(est.covariance, expected, rtol=1e-6, atol=1e-12)
        assert np.sqrt(est.covariance[0, 0]) * e.mu_c == pytest.approx(e.sd_mu_c)
        assert np.sqrt(est.covariance[1, 1]) * e.r == pytest.approx(e.sd_r)
    assert updated > 20


@pytest.mark.parametrize("name", estimator.names())
def test_repr_shows_name_changed_parameters_and_values(name):
    est = estimator.make(name, mu_c0=1.1)
    first, *rest = repr(est).splitlines()
    assert first == f"OnlineEstimator({name!r}, mu_c0=1.1)"
    assert "no samples" in repr(est)
    run(est, ellipsoid(60, *planar(0.7, R), MU_C, R))
    e, shown = est.estimate, repr(est)
    for words in (
        f"mu_s  {e.mu_s:.4g}",
        f"mu_c  {e.mu_c:.4g}",
        f"r     {e.r:.4g} m",
        f"confidence {e.confidence_r:.2f}",
        "slipping True",
        "halted False",
        "60 samples",
        *HAS[name],
    ):
        assert words in shown
    assert [line for line in rest if line.strip()] == rest


def test_repr_of_a_batch():
    batch = estimator.make_batch("joint", 5, n_b=8)
    assert repr(batch).startswith("BatchEstimator('joint', n=5, n_b=8)\n")
    assert "mu_c  1.3 (1.3 to 1.3), confidence 0.00 (0.00 to 0.00)" in repr(batch)
    assert "different in each row" not in repr(batch)
    batch.parameters_array = np.repeat(batch.parameters_array, 5)
    assert "different in each row" in repr(batch)
    assert len(batch) == 5


@pytest.mark.parametrize("value", ["mu_s", "mu_c", "r"])
def test_old_names_of_confidence_warn_and_give_the_new_one(value):
    est = estimator.make("rls")
    (e,) = run(est, ellipsoid(1, *planar(0.7, R), MU_C, R))
    with pytest.warns(DeprecationWarning, match=f"support_{value} is now .*confidence_{value}") as caught:
        assert getattr(e, f"support_{value}") == getattr(e, f"confidence_{value}")
    assert caught[0].filename == __file__
    assert f"support_{value}" not in e._fields
