"""The published standard deviations, against the scatter of many noisy records."""

import numpy as np
import pytest

import estimator
from tests.estimator.exact_records import RATE, ellipsoid, planar

MU_C, R, FINGERS = 0.4, 0.01, 400


def noisy(name, gamma_t, samples=240, scale=1.0, **parameters):
    """Estimates of many fingers on the same planar slip at varying speed, white noise on every signal."""
    rng = np.random.default_rng(1)
    batch = estimator.make_batch(name, FINGERS, **parameters)
    sd_wrench, sd_twist = (
        scale * np.array([0.02, 0.02, 0.04, 5e-4]),
        scale * np.array([1.6e-4, 1.6e-4, 6.5e-3]),
    )
    for k in range(samples):
        _, wrench, twist = ellipsoid(1, *planar(gamma_t, R, 0.04 + 0.02 * np.sin(0.2 * k)), MU_C, R)[0]
        wrenches = wrench + sd_wrench * rng.standard_normal((FINGERS, 4))
        twists = twist + sd_twist * rng.standard_normal((FINGERS, 3))
        batch.update(k / RATE, wrenches, twists)
    return batch.estimates


@pytest.mark.parametrize("gamma_t", [0.4, 0.7, 0.9])
def test_joint_knows_its_error(gamma_t):
    """400 fingers show it to 4 %; neighbouring samples share a velocity, so up to a third is allowed."""
    e = noisy("joint", gamma_t, law_error=0.0)
    for value, sd, truth in ((e["mu_c"], e["sd_mu_c"], MU_C), (e["r"], e["sd_r"], R)):
        assert abs(value.mean() / truth - 1.0) < 0.01
        assert 0.67 < value.std() / np.sqrt(np.mean(sd**2)) < 1.34


@pytest.mark.parametrize("gamma_t", [0.7, 0.9])
def test_rls_knows_its_scatter(gamma_t):
    """With forgetting the variance is about half of P times that of the residuals: sd is on the safe side."""
    e = noisy("rls", gamma_t)
    for value, sd in ((e["mu_c"], e["sd_mu_c"]), (e["r"], e["sd_r"])):
        assert 0.4 < value.std() / np.sqrt(np.mean(sd**2)) < 1.1


def test_rls_measures_the_noise():
    quiet, loud = (noisy("rls", 0.7, scale=scale, mu_c0=MU_C, r0=R) for scale in (0.3, 1.0))
    assert np.median(loud["sd_mu_c"]) > 2.0 * np.median(quiet["sd_mu_c"])


@pytest.mark.parametrize("name", estimator.names())
def test_standard_deviations_start_at_the_values_themselves(name):
    e = estimator.make(name).estimate
    assert (e.sd_mu_s, e.sd_mu_c, e.sd_r) == (e.mu_s, e.mu_c, e.r)
    assert (e.observable_mu_c, e.observable_r) == (False, False)


def test_rls_says_on_which_samples_it_learns():
    est = estimator.make("rls")
    (slide,), (spin,) = ellipsoid(1, 0.02, 0.0, MU_C, R), ellipsoid(1, 0.0, 2.0, MU_C, R, start=2)
    assert est.update(*slide)[-2:] == (True, False)
    assert est.update(*spin)[-2:] == (False, True)
    assert est.update(3 / RATE, (1.0, 0.0, 5.0, 0.0), (0.0, 0.0, 0.0))[-2:] == (False, False)
