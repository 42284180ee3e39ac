"""What "rls" is known not to do, and the analysis of the coupling of mu_c and r."""

import numpy as np
import pytest

import estimator
from tests.estimator.exact_records import RATE, ellipsoid, planar, run

MU_C, R = 0.4, 0.01
DEFAULTS = estimator.RlsParameters()
SAMPLES = int(3 * RATE)


@pytest.mark.parametrize("gamma_t", [0.1, 0.3, 0.5, 0.7, 0.9, 0.99])
def test_derivative_of_the_map_at_the_truth(gamma_t):
    """T(mu) = f_t / (f_n gamma_t(r(mu))) has T'(mu*) = -(1 - c^2) / (1 + c^2), c = gamma_t: it contracts."""
    _, (f_x, f_y, f_n, tau), (v_x, v_y, omega) = ellipsoid(1, *planar(gamma_t, R), MU_C, R)[0]
    f_t, v_t = np.hypot(f_x, f_y), np.hypot(v_x, v_y)

    def t_map(mu):
        # r = tau / (gamma_tau(r) mu f_n), with q = |tau| / (mu f_n): r^4 - q^2 r^2 - (q v_t / omega)^2 = 0.
        q = abs(tau) / (mu * f_n)
        r_squared = (q**2 + q * np.sqrt(q**2 + 4.0 * (v_t / omega) ** 2)) / 2.0
        return f_t / (f_n * v_t / np.sqrt(v_t**2 + r_squared * omega**2))

    assert t_map(MU_C) == pytest.approx(MU_C)
    h = 1e-5 * MU_C
    slope = (t_map(MU_C + h) - t_map(MU_C - h)) / (2.0 * h)  # truncation of order h^2
    assert slope == pytest.approx(-(1.0 - gamma_t**2) / (1.0 + gamma_t**2), rel=1e-6)


def test_at_full_gain_r_oscillates_for_ever():
    """Without memory (lambda -> 0) the recursion is r_{k+1} = r*^2 / r_k: r0, r*^2 / r0, r0, ..."""
    est = estimator.make("rls", forgetting=1e-9, p0=1e9, eps_t=1e-3, eps_tau=1e-3)
    radii = [e.r for e in run(est, ellipsoid(40, *planar(0.707, R), MU_C, R))]
    assert radii[::2] == pytest.approx(
        [R**2 / DEFAULTS.r0] * 20, rel=1e-6
    )  # the gain falls short by 1e-9 a step
    assert radii[1::2] == pytest.approx([DEFAULTS.r0] * 20, rel=1e-6)


def gamma_tau_at(r, gamma_t):
    """gamma_tau as an estimator with radius r sees a slip whose true share of translation is gamma_t."""
    v_t, omega = planar(gamma_t, R)
    return r * omega / np.hypot(v_t, r * omega)


@pytest.mark.parametrize("gamma_t", [0.9, 0.95])
def test_a_large_normal_force_locks_r_out(gamma_t):
    """At 20 N the first step is nearly the full one, to r*^2 / r0 = 5 mm, where the gate is shut: r stays."""
    assert gamma_tau_at(R**2 / DEFAULTS.r0, gamma_t) < DEFAULTS.eps_tau < gamma_tau_at(R, gamma_t)
    last = run(estimator.make("rls"), ellipsoid(SAMPLES, *planar(gamma_t, R), MU_C, R, f_n=20.0))[-1]
    assert last.updates_r == 1
    assert last.r < 0.6 * R
    assert last.confidence_r == pytest.approx(1.0 - DEFAULTS.forgetting)  # which the confidence shows


def test_the_same_slip_at_a_small_normal_force_is_learnt():
    last = run(estimator.make("rls"), ellipsoid(SAMPLES, *planar(0.9, R), MU_C, R, f_n=5.0))[-1]
    assert last.r == pytest.approx(R, rel=5e-3)


def test_spin_first_locks_r_out():
    """Spin learns r = mu_c* r* / mu_c0 = 3 mm; a later planar slip finds gamma_tau below its gate."""
    est = estimator.make("rls")
    spun = run(est, ellipsoid(SAMPLES, 0.0, 2.0, MU_C, R))[-1]
    assert spun.r == pytest.approx(MU_C / DEFAULTS.mu_c0 * R, rel=5e-3)
    assert gamma_tau_at(spun.r, 0.707) < DEFAULTS.eps_tau
    last = run(est, ellipsoid(SAMPLES, *planar(0.707, R), MU_C, R, start=SAMPLES + 1))[-1]
    assert last.r == spun.r


@pytest.mark.parametrize(("limit", "wound_up"), [(1.0, False), (np.inf, True)])
def test_covariance_winds_up_only_without_its_limit(limit, wound_up):
    """0.25 N for 3 s: phi = gamma_tau mu_c f_n is about 0.01 N; P tends to (1 - lambda) / phi^2 > 100 P0."""
    mu_c = 0.1
    est = estimator.make("rls", covariance_limit=limit, mu_c0=mu_c, r0=R)
    run(est, ellipsoid(SAMPLES, *planar(0.93, R), mu_c, R, f_n=0.25))
    assert (est.batch.states["covariance_r"][0] > 100.0) == wound_up
    assert est.batch.states["covariance_r"][0] <= limit * DEFAULTS.p0


def test_estimates_stay_within_their_bounds():
    """No force in a slip reads as no friction; the bounds keep the estimates positive."""
    frictionless = run(estimator.make("rls", mu_min=0.05), ellipsoid(SAMPLES, 0.02, 0.0, 1e-6, R))[-1]
    assert frictionless.mu_c == 0.05
    large = run(estimator.make("rls", r_max=0.025), ellipsoid(SAMPLES, *planar(0.5, 0.03), MU_C, 0.03))[-1]
    assert large.r == 0.025
