"""Exact disc data: "disc" and "ukf" find the truth from any start, wherever the noise lets them look.

The tables are off by 2e-5, a start error fades as forgetting**n or faster: 0.1 % is generous for "disc".
"""

import numpy as np
import pytest

import estimator
from tests.estimator.exact_records import RATE, disc, planar, run

SAMPLES = int(3 * RATE)
TOLERANCE = 1e-3
MU_C, R = 0.4, 0.01
GAMMAS = np.array([0.1, 0.3, 0.5, 0.707, 0.9, 0.95])
RADII = np.array([1e-3, 0.01, 0.03, 0.1])
SILENT = {"sd_force": 1e-4, "sd_normal": 1e-4, "sd_torque": 1e-6, "sd_speed": 1e-6, "sd_spin": 1e-5}
"""Noise of a sensor that shows even 1 N at gamma_t 0.1."""


def grid(name, f_n, spin_first, **parameters):
    """Estimates after a slip, from every start in every slip, (radii, gammas)."""
    starts, gammas = (axis.ravel() for axis in np.meshgrid(RADII, GAMMAS, indexing="ij"))
    batch = estimator.make_batch(name, len(starts), **parameters)
    batch.parameters_array = np.repeat(batch.parameters_array, len(starts))
    batch.parameters_array["r0"], batch.parameters_array["r_max"] = starts, np.maximum(starts, 0.015)
    batch.reset()
    (spin,) = disc(1, 0.0, 2.0, MU_C, R, f_n)
    slips = [disc(1, *planar(gamma, R), MU_C, R, f_n)[0] for gamma in gammas]
    for k in range(2 * SAMPLES):
        samples = slips if k >= SAMPLES else [spin] * len(starts)
        if k >= SAMPLES or spin_first:
            batch.update(k / RATE, *(np.array([sample[i] for sample in samples]) for i in (1, 2)))
    return batch.estimates


@pytest.mark.parametrize("f_n", [1.0, 5.0, 20.0])
@pytest.mark.parametrize("spin_first", [False, True])
def test_nothing_is_locked_out(f_n, spin_first):
    e = grid("disc", f_n, spin_first, **SILENT)
    np.testing.assert_allclose(e["mu_c"], MU_C, rtol=TOLERANCE)
    np.testing.assert_allclose(e["r"], R, rtol=TOLERANCE)


@pytest.mark.parametrize("f_n", [1.0, 5.0, 20.0])
def test_with_a_real_sensor_a_value_is_right_or_untouched(f_n):
    e = grid("disc", f_n, spin_first=False)
    assert (e["observable_mu_c"] == (e["updates_mu_c"] > 0)).all()
    untouched = np.where(e["events_mu_s"] > 0, np.minimum(e["mu_s"], 1.3), 1.3)  # mu_c never exceeds mu_s
    np.testing.assert_allclose(e["mu_c"], np.where(e["observable_mu_c"], MU_C, untouched), rtol=TOLERANCE)
    np.testing.assert_allclose(e["r"], np.where(e["observable_r"], R, np.repeat(RADII, 6)), rtol=TOLERANCE)
    assert e["observable_mu_c"].mean() > 0.8


def test_translation_finds_mu_c_and_leaves_r():
    last = run(estimator.make("disc", r0=0.012), disc(SAMPLES, 0.02, 0.0, MU_C, R))[-1]
    assert last.mu_c == pytest.approx(MU_C, rel=TOLERANCE)
    assert (last.r, last.sd_r, last.updates_r) == (0.012, 0.012, 0)


def test_spin_alone_learns_nothing_and_a_slide_makes_r_right_at_once():
    """Spin shows only the product mu_c r; the first spin after a slide shows r."""
    est = estimator.make("disc", r0=0.003)
    last = run(est, disc(SAMPLES, 0.0, 2.0, MU_C, R))[-1]
    assert (last.mu_c, last.r, last.updates_mu_c, last.updates_r) == (1.3, 0.003, 0, 0)
    run(est, disc(SAMPLES, 0.02, 0.0, MU_C, R, start=SAMPLES + 1))
    # three samples until forces and velocities pair; the first one seen outweighs the start's doubt of 10 mm
    soon = run(est, disc(8, 0.0, 2.0, MU_C, R, start=2 * SAMPLES + 1))[-1]
    assert soon.r == pytest.approx(R, rel=0.01)


def test_joint_has_the_bias_that_the_page_names():
    """What "disc" is for: the ellipsoid reads a disc's mu_c 15 % low at gamma_t 0.5."""
    record = disc(SAMPLES, *planar(0.5, R), MU_C, R)
    assert run(estimator.make("joint"), record)[-1].mu_c / MU_C == pytest.approx(0.85, abs=0.01)


@pytest.mark.parametrize("gamma_t", [0.3, 0.5, 0.707, 0.9])
@pytest.mark.parametrize("r0", [0.002, 0.01, 0.04])
def test_ukf_converges(gamma_t, r0):
    """Its memory is drift over noise, some tens of samples; 1 % is what is left after 3 s."""
    est = estimator.make("ukf", r0=r0, r_max=max(r0, 0.015))
    last = run(est, disc(SAMPLES, *planar(gamma_t, R), MU_C, R))[-1]
    assert last.mu_c == pytest.approx(MU_C, rel=0.01)
    assert last.r == pytest.approx(R, rel=0.01)


def test_ukf_on_the_ellipsoid_is_a_parameter():
    record = disc(SAMPLES, *planar(0.5, R), MU_C, R)
    assert run(estimator.make("ukf", disc=False), record)[-1].mu_c / MU_C == pytest.approx(0.85, abs=0.01)


def test_mu_s_follows_a_change_in_one_event():
    """Ten breaks at 0.5, then two at 0.8: the average starts afresh, and stays an average."""
    est, k = estimator.make("disc"), 0
    seen = []
    for i, mu_s in enumerate([0.5, 0.51] * 5 + [0.8, 0.81]):
        for share in np.linspace(0.5, 1.0, 60):
            k += 1
            e = est.update(k / RATE, (5.0 * mu_s * share, 0.0, 5.0, 0.0), (0.0, 0.0, 0.0))
        for _ in range(30):
            k += 1
            e = est.update(k / RATE, (5.0 * MU_C, 0.0, 5.0, 0.0), (0.02, 0.0, 0.0))
        assert e.events_mu_s == i + 1
        seen.append(e.mu_s)
    assert seen[9] == pytest.approx(0.505, abs=0.003)
    assert seen[10:] == pytest.approx([0.8, 0.805], abs=1e-9)
    assert 0.0 < e.sd_mu_s < 0.02


@pytest.mark.parametrize("name", ["disc", "joint", "ukf"])
def test_a_spin_from_rest_tells_nothing_of_mu_s(name):
    """An unloaded contact shows ratios of noise; the torque that starts the spin comes a sample before it."""
    est, rng = estimator.make(name), np.random.default_rng(0)
    ((_, torque, spin),) = disc(1, 0.0, 2.0, MU_C, R)
    sd = np.array([0.02, 0.02, 0.04, 5e-4])
    for k in range(200):
        wrench = np.array(torque if k % 50 >= 40 else (0.0, 0.0, 5.0, 0.0)) + sd * rng.standard_normal(4)
        e = est.update(k / RATE, wrench, spin if k % 50 > 40 else (0.0, 0.0, 0.0))
    assert (e.mu_s, e.events_mu_s) == (1.5, 0)
