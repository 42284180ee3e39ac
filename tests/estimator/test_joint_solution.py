"""Exact ellipsoid data: "joint" finds the truth from any start, wherever the noise lets it look.

A start error fades as forgetting**n or faster; the noise model's weights make that of the start value
negligible after one sample, so what is left is rounding and the prior of the viscosity: 0.1 % is generous.
"""

import numpy as np
import pytest

import estimator
from tests.estimator.exact_records import RATE, ellipsoid, planar, run

SAMPLES = int(3 * RATE)
TOLERANCE = 1e-3
MU_C, R = 0.4, 0.01
SILENT = {"sd_force": 1e-4, "sd_normal": 1e-4, "sd_torque": 1e-6, "sd_speed": 1e-6, "sd_spin": 1e-5}
"""Noise of a sensor that shows even 1 N at gamma_t 0.1."""


def make(**parameters):
    return estimator.make("joint", **parameters)


def test_translation_finds_mu_c_and_leaves_r():
    last = run(make(r0=0.012), ellipsoid(SAMPLES, 0.02, 0.0, MU_C, R))[-1]
    assert last.mu_c == pytest.approx(MU_C, rel=TOLERANCE)
    assert (last.r, last.sd_r, last.updates_r) == (0.012, 0.012, 0)
    assert (last.observable_mu_c, last.observable_r) == (True, False)
    assert last.updates_mu_c == SAMPLES - 3  # the force of two windows ago, between windows wholly in contact


def test_spin_alone_learns_nothing_and_says_so():
    """It shows only the product mu_c r."""
    est = make()
    start = est.estimate
    last = run(est, ellipsoid(SAMPLES, 0.0, 2.0, MU_C, R))[-1]
    assert last[:3] == start[:3]
    assert last.confidence_mu_c == last.confidence_r == 0.0
    assert (last.observable_mu_c, last.observable_r) == (False, False)


def test_translation_then_spin_finds_both():
    est = make(r0=0.003)
    run(est, ellipsoid(SAMPLES, 0.02, 0.0, MU_C, R))
    last = run(est, ellipsoid(SAMPLES, 0.0, 2.0, MU_C, R, start=SAMPLES + 1))[-1]
    assert last.mu_c == pytest.approx(MU_C, rel=TOLERANCE)
    assert last.r == pytest.approx(R, rel=TOLERANCE)


@pytest.mark.parametrize("gamma_t", [0.1, 0.3, 0.5, 0.707, 0.9, 0.95])
@pytest.mark.parametrize("f_n", [1.0, 5.0, 20.0])
@pytest.mark.parametrize("r0", [1e-3, 0.01, 0.03, 0.1])
@pytest.mark.parametrize("spin_first", [False, True])
def test_nothing_is_locked_out(gamma_t, f_n, r0, spin_first):
    est = make(r0=r0, r_max=max(r0, 0.015), **SILENT)
    spin = ellipsoid(SAMPLES, 0.0, 2.0, MU_C, R, f_n=f_n) if spin_first else []
    run(est, spin)
    slip = ellipsoid(SAMPLES, *planar(gamma_t, R), MU_C, R, f_n=f_n, start=len(spin) + 1)
    last = run(est, slip)[-1]
    assert last.mu_c == pytest.approx(MU_C, rel=TOLERANCE)
    assert last.r == pytest.approx(R, rel=TOLERANCE)


@pytest.mark.parametrize("gamma_t", [0.1, 0.3, 0.5, 0.9, 0.95])
@pytest.mark.parametrize("f_n", [1.0, 5.0, 20.0])
def test_with_a_real_sensor_a_value_is_right_or_untouched(gamma_t, f_n):
    est = make(r0=0.003)
    last = run(est, ellipsoid(SAMPLES, *planar(gamma_t, R), MU_C, R, f_n=f_n))[-1]
    seen = not (f_n == 1.0 and gamma_t == 0.1)  # f_t is 0.04 N, two of its standard deviations: not above
    assert last.observable_mu_c == last.observable_r == seen
    assert last.mu_c == pytest.approx(MU_C if seen else 1.3, rel=TOLERANCE)
    assert last.r == pytest.approx(R if seen else 0.003, rel=TOLERANCE)


def test_follows_a_truth_that_changes():
    est = make()
    run(est, ellipsoid(SAMPLES, *planar(0.707, R), MU_C, R))
    mu_c, r = 0.6, 0.013
    last = run(est, ellipsoid(SAMPLES, *planar(0.707, r), mu_c, r, start=SAMPLES + 1))[-1]
    assert last.mu_c == pytest.approx(mu_c, rel=5e-3)  # 0.98**360 = 7e-4 of the change, and of its weight
    assert last.r == pytest.approx(r, rel=5e-3)


def test_far_centres_of_rotation_teach_no_radius():
    """Beyond three pad radii a torque is mostly an error of the centre of pressure."""
    far = ellipsoid(SAMPLES, 0.05, 0.05 / 0.046, MU_C, R)
    near = ellipsoid(SAMPLES, 0.05, 0.05 / 0.044, MU_C, R)
    assert not run(make(), far)[-1].observable_r
    assert run(make(), near)[-1].observable_r


def test_r_is_projected_onto_the_pad():
    last = run(make(), ellipsoid(SAMPLES, *planar(0.5, 0.03), MU_C, 0.03))[-1]
    assert last.r == 0.015


def test_viscous_friction_is_told_from_coulomb_friction():
    """f_t = (mu_c + sigma v) f_n: with speeds from 5 to 80 mm/s the intercept is mu_c."""
    sigma, est = 0.2, make(sd_viscosity=1.0)
    for k in range(SAMPLES):
        v = 0.0425 + 0.0375 * np.sin(0.05 * k)
        v_then = 0.0425 + 0.0375 * np.sin(0.05 * (k - 1.5))  # at the force that "joint" pairs with it
        est.update(k / RATE, (MU_C * 5.0 + sigma * 5.0 * v, 0.0, 5.0, 0.0), (v_then, 0.0, 0.0))
    assert est.estimate.mu_c == pytest.approx(MU_C, rel=5e-3)
    plain = make(sd_viscosity=1e-6)
    run(plain, [(k, ((MU_C + sigma * 0.05) * 5.0, 0.0, 5.0, 0.0), (0.05, 0.0, 0.0)) for k in range(50)])
    assert plain.estimate.mu_c == pytest.approx(MU_C + sigma * 0.05, rel=TOLERANCE)


def test_poor_samples_do_not_wind_the_memory_down():
    """Half an hour of the weakest slip that counts leaves at least the start's information."""
    est = make(sd_force=0.1, sd_torque=1e-3)
    run(est, ellipsoid(20_000, *planar(0.7, R), MU_C, R, f_n=1.0))
    state = est.batch.states[0]
    assert state["information"][0] >= 1.0  # 1 / sd_mu_c0^2
    assert state["information_r"] >= 1e4 * (1 - 1e-9)  # 1 / sd_r0^2
