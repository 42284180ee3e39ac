"""The tabulated inverse of the disc's limit surface against the exact surface."""

import numpy as np
import pytest

from estimator.limit_surface import DISC_RADIUS, disc_friction
from estimator.limit_surface.inverse import load_size, slip_factors, spin_radius

RATIOS = np.concatenate([np.geomspace(1e-3, 1e3, 601), np.random.default_rng(0).uniform(0.5, 2.0, 400)])
ERROR = 2e-5
"""Of linear interpolation between the knots: h^2 / 8 times the second derivative, largest near ratio 1."""


def slip(ratio, mu_f_n=3.0, r=0.01, omega=1.5):
    """f_t, tau, v_t, omega of a disc, exactly."""
    force, torque = disc_friction(ratio)
    return mu_f_n * force, mu_f_n * torque * r / DISC_RADIUS, ratio * omega * r / DISC_RADIUS, omega


def inverted(ratio, disc=True):
    """mu_c f_n and r of a slip, and their derivatives by ln(1 + q) and ln q."""
    f_t, tau, v_t, omega = slip(ratio)
    q = tau * omega / (f_t * v_t)
    friction, by_one_plus_q, radius, by_q = slip_factors(disc, 1.0 / (1.0 + q))
    return friction * np.sqrt(1.0 + q) * f_t, radius * np.sqrt(q) * v_t / omega, by_one_plus_q, by_q


def test_finds_friction_and_radius_over_the_whole_range():
    found = np.array([inverted(ratio)[:2] for ratio in RATIOS])
    np.testing.assert_allclose(found[:, 0], 3.0, rtol=ERROR)
    np.testing.assert_allclose(found[:, 1], 0.01, rtol=ERROR)


def test_ends():
    """Pure spin: mu_c f_n = infinity times f_t = 0, of finite factors; pure translation: the ellipsoid's."""
    spin, translation = slip_factors(True, 0.0), slip_factors(True, 1.0)
    assert np.isfinite(spin).all()
    assert translation[0] == pytest.approx(1.0, abs=ERROR)
    # ratio / force -> 1 and torque -> 2/3 in spin; force -> 1 and ratio torque -> 1/4 in translation
    assert spin[0] == pytest.approx(np.sqrt(1.5), rel=1e-3)
    assert spin[2] == pytest.approx(np.sqrt(1.5) * DISC_RADIUS, rel=1e-3)
    assert translation[2] == pytest.approx(2.0 * DISC_RADIUS, rel=1e-3)


@pytest.mark.parametrize("ratio", [0.02, 0.2, 0.6, 1.3, 2.0, 5.0, 50.0])
def test_derivatives(ratio):
    """By difference over five knots; they weigh the noise, and need no more."""
    f_t, tau, v_t, omega = slip(ratio)
    q = tau * omega / (f_t * v_t)
    s = 1.0 / (1.0 + q)
    low, high = max(s - 0.005, 1e-9), min(s + 0.005, 1.0 - 1e-9)
    log_q = [np.log((1.0 - x) / x) for x in (low, high)]
    log_friction = [np.log(slip_factors(True, x)[0]) - 0.5 * np.log(x) for x in (low, high)]
    log_radius = [np.log(slip_factors(True, x)[2]) + 0.5 * y for x, y in zip((low, high), log_q, strict=True)]
    _, _, by_one_plus_q, by_q = inverted(ratio)
    assert by_one_plus_q == pytest.approx(-np.diff(log_friction)[0] / np.log(high / low), abs=0.02)
    if 0.01 < s < 0.99:  # nearer to the ends ln q runs off within five knots
        assert by_q == pytest.approx(np.diff(log_radius)[0] / np.diff(log_q)[0], abs=0.02)


def test_the_ellipsoid_has_no_factors():
    assert slip_factors(False, 0.3) == (1.0, 0.5, 1.0, 0.5)


def test_load_size_is_one_on_the_surface():
    for ratio in RATIOS:
        f_t, tau, _, _ = slip(ratio)
        assert load_size(True, f_t, tau / 0.01) == pytest.approx(3.0, rel=ERROR)
    assert load_size(True, 0.0, 0.0) == 0.0
    assert load_size(True, 0.0, 2.0) == pytest.approx(2.0, rel=ERROR)
    assert load_size(False, 3.0, 4.0) == 5.0


@pytest.mark.parametrize("ratio", [0.0, 0.01, 0.05, 0.1])
def test_radius_of_a_spin(ratio):
    """Off by the first term left out, ratio^4 / 16 of the disc's radius, 3/2 of that relative to 2/3."""
    _, tau, v_t, omega = slip(ratio)
    assert spin_radius(True, tau / 3.0, v_t / omega) == pytest.approx(0.01, rel=0.2 * ratio**4 + 1e-12)
