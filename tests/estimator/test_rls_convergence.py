"""Exact ellipsoid data: the estimates find the truth from Table 1's start values.

Tolerance 0.5 % within 3 s of slip: a start error fades as forgetting**n or faster, and n = 360 samples at a
forgetting of 0.98 leave 0.98**360 = 7e-4 of it: 0.16 % of the truth for the largest, mu_c 1.3 for 0.4.
"""

import numpy as np
import pytest

import estimator
from tests.estimator.exact_records import RATE, ellipsoid, planar, run

SAMPLES = int(3 * RATE)
TOLERANCE = 5e-3
MU_C, R = 0.4, 0.01


def test_translation_finds_mu_c_and_leaves_r():
    last = run(estimator.make("rls"), ellipsoid(SAMPLES, 0.02, 0.0, MU_C, R))[-1]
    assert last.mu_c == pytest.approx(MU_C, rel=TOLERANCE)
    assert last.r == estimator.RlsParameters().r0
    assert (last.updates_mu_c, last.updates_r) == (SAMPLES, 0)
    assert (last.gamma_t, last.gamma_tau) == (1.0, 0.0)


def test_translation_then_spin_finds_both():
    est = estimator.make("rls")
    run(est, ellipsoid(SAMPLES, 0.02, 0.0, MU_C, R))
    last = run(est, ellipsoid(SAMPLES, 0.0, 2.0, MU_C, R, start=SAMPLES + 1))[-1]
    assert last.mu_c == pytest.approx(MU_C, rel=TOLERANCE)
    assert last.r == pytest.approx(R, rel=TOLERANCE)


def test_spin_alone_finds_only_the_product():
    last = run(estimator.make("rls"), ellipsoid(SAMPLES, 0.0, 2.0, MU_C, R))[-1]
    assert last.mu_c * last.r == pytest.approx(MU_C * R, rel=TOLERANCE)
    assert last.mu_c == estimator.RlsParameters().mu_c0
    assert last.confidence_mu_c == 0.0


@pytest.mark.parametrize("gamma_t", [0.4, 0.5, 0.6, 0.707, 0.8])
def test_planar_finds_both(gamma_t):
    last = run(estimator.make("rls"), ellipsoid(SAMPLES, *planar(gamma_t, R), MU_C, R))[-1]
    assert last.mu_c == pytest.approx(MU_C, rel=TOLERANCE)
    assert last.r == pytest.approx(R, rel=TOLERANCE)
    assert last.gamma_t == pytest.approx(gamma_t, rel=TOLERANCE)


def test_follows_a_truth_that_changes():
    est = estimator.make("rls")
    run(est, ellipsoid(SAMPLES, *planar(0.707, R), MU_C, R))
    mu_c, r = 0.6, 0.013
    last = run(est, ellipsoid(SAMPLES, *planar(0.707, r), mu_c, r, start=SAMPLES + 1))[-1]
    assert last.mu_c == pytest.approx(mu_c, rel=TOLERANCE)
    assert last.r == pytest.approx(r, rel=TOLERANCE)


def test_memory_is_the_forgetting_factor():
    """Once settled, the gain is 1 - forgetting: a step of the truth is half followed after 34 samples."""
    est = estimator.make("rls")
    run(est, ellipsoid(SAMPLES, 0.02, 0.0, 0.4, R))
    half = round(np.log(0.5) / np.log(0.98))
    after = run(est, ellipsoid(half, 0.02, 0.0, 0.6, R, start=SAMPLES + 1))[-1]
    assert after.mu_c == pytest.approx(
        0.6 - 0.2 * 0.98**half, rel=1e-3
    )  # 7e-4 of the memory is the start value


def test_rls_is_weighted_least_squares():
    """Any data: the recursion equals the closed-form minimiser of the exponentially weighted squares."""
    rng = np.random.default_rng(3)
    f_n, f_t = rng.uniform(2.0, 8.0, 200), rng.uniform(0.5, 4.0, 200)
    est = estimator.make("rls", covariance_limit=np.inf, heuristic=False)
    record = [((k + 1) / RATE, (f_t[k], 0.0, f_n[k], 0.0), (0.02, 0.0, 0.0)) for k in range(200)]
    weights = 0.98 ** np.arange(199, -1, -1)
    prior = 0.98**200  # times 1 / P0, P0 = 1
    expected = (prior * 1.3 + np.sum(weights * f_n * f_t)) / (prior + np.sum(weights * f_n**2))
    assert run(est, record)[-1].mu_c == pytest.approx(expected, rel=1e-12)  # 200 steps of rounding


def test_confidence_counts_the_data_behind_each_value():
    est = estimator.make("rls")
    assert est.estimate[5:13] == (0.0, 0.0, 0.0, 0, 0, 0, False, False)
    estimates = run(est, ellipsoid(50, *planar(0.707, R), MU_C, R))
    for n, e in enumerate(estimates, start=1):
        assert (e.updates_mu_c, e.updates_r) == (n, n)
        assert e.confidence_mu_c == e.confidence_r == pytest.approx(1.0 - 0.98**n)
    for e in run(est, ellipsoid(9, 0.001, 0.0, MU_C, R, start=51)):  # below eps_v: no motion regime
        assert (e.updates_mu_c, e.updates_r) == (50, 50)
