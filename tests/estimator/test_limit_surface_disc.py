"""The disc's closed form against its integral over the area, and at its ends."""

import numpy as np
import pytest
from scipy import integrate, special

from estimator.limit_surface import disc_friction


def quadrature(ratio: float) -> tuple[float, float]:
    """Friction (f_t, tau) of a unit disc, mu f_n = 1, integrated over the disc."""

    def velocity(angle: float, rho: float) -> tuple[float, float]:
        return ratio - rho * np.sin(angle), rho * np.cos(angle)

    def force(angle: float, rho: float) -> float:
        v_x, v_y = velocity(angle, rho)
        return rho * v_x / max(np.hypot(v_x, v_y), 1e-300)

    def torque(angle: float, rho: float) -> float:
        v_x, v_y = velocity(angle, rho)
        moment = rho * np.cos(angle) * v_y - rho * np.sin(angle) * v_x
        return rho * moment / max(np.hypot(v_x, v_y), 1e-300)

    def inner(integrand, rho: float) -> float:  # symmetric about the diameter with the centre of rotation
        half, _ = integrate.quad(integrand, -np.pi / 2, np.pi / 2, args=(rho,), epsabs=1e-11, limit=200)
        return 2.0 * half / np.pi

    points = [ratio] if ratio < 1.0 else None
    return tuple(
        integrate.quad(lambda rho, f=f: inner(f, rho), 0.0, 1.0, points=points, epsabs=1e-9, limit=200)[0]
        for f in (force, torque)
    )


@pytest.mark.parametrize("ratio", [0.05, 0.5, 0.9, 1.1, 2.0, 10.0])
def test_is_the_integral_over_the_disc(ratio):
    assert disc_friction(ratio) == pytest.approx(quadrature(ratio), abs=1e-7)


@pytest.mark.parametrize("ratio", [0.1, 0.7, 0.999])
def test_is_the_published_form_in_elliptic_integrals(ratio):
    e, k = special.ellipe(ratio**2), special.ellipk(ratio**2)
    force = 4 / (3 * np.pi * ratio) * ((ratio**2 + 1) * e + (ratio**2 - 1) * k)
    torque = 4 / (9 * np.pi) * ((4 - 2 * ratio**2) * e + (ratio**2 - 1) * k)
    assert disc_friction(ratio) == pytest.approx((force, torque), rel=1e-12)


def test_ends_and_middle():
    assert disc_friction(0.0) == pytest.approx((0.0, 2 / 3), abs=1e-15)
    assert disc_friction(np.inf) == pytest.approx((1.0, 0.0), abs=1e-15)
    assert disc_friction(1.0) == pytest.approx((8 / (3 * np.pi), 8 / (9 * np.pi)), rel=1e-13)


@pytest.mark.parametrize("ratio", [1e-9, 1e-5, 1e-3])
def test_series_near_spin_and_translation(ratio):
    force, torque = disc_friction(ratio)
    assert force == pytest.approx(ratio * (1 - ratio**2 / 8), rel=1e-11)
    assert torque == pytest.approx(2 / 3 - ratio**2 / 2, rel=1e-11)
    force, torque = disc_friction(1 / ratio)
    assert force == pytest.approx(1 - ratio**2 / 8, rel=1e-11)
    assert torque == pytest.approx(ratio / 4, rel=1e-6)


def test_normality_dissipation_is_stationary_along_the_surface():
    """Friction is the gradient of the power: ratio dF + dM = 0 along the surface (Goyal et al.)."""
    for ratio in (0.3, 0.99, 1.01, 3.0):
        h = 1e-5
        (f_0, m_0), (f_1, m_1) = disc_friction(ratio - h), disc_friction(ratio + h)
        assert ratio * (f_1 - f_0) + (m_1 - m_0) == pytest.approx(0.0, abs=1e-8)
