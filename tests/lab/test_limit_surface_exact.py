"""The limit surfaces of the named pressures against integrals over the disc, without elliptic integrals."""

import numpy as np
import pytest
from scipy.integrate import quad

from lab.limit_surface_exact import (
    FRICTION,
    exact_friction,
    hertz_friction,
    rim_friction,
    uniform_friction,
)
from slipgym.contact.pressure import OUTER_RADII

RATIOS = [0.0, 1e-5, 0.03, 0.4, 0.9, 0.999, 1.001, 1.3, 4.0, 100.0]


def ring(ratio: float, rho: float) -> tuple[float, float]:
    """Mean friction and torque on a circle, by quadrature over the angle."""

    def velocity(angle: float) -> tuple[float, float, float]:
        v_x, v_y = ratio - rho * np.sin(angle), rho * np.cos(angle)
        return v_x, v_y, max(np.hypot(v_x, v_y), 1e-300)

    def force(angle: float) -> float:
        v_x, _, speed = velocity(angle)
        return v_x / speed

    def torque(angle: float) -> float:
        v_x, v_y, speed = velocity(angle)
        return rho * (np.cos(angle) * v_y - np.sin(angle) * v_x) / speed

    # symmetric about the diameter with the centre of rotation, which lies at the angle of 90 degrees
    parts = (-0.5 * np.pi, 0.4 * np.pi), (0.4 * np.pi, 0.5 * np.pi)
    return tuple(
        sum(quad(f, *part, epsabs=1e-12, limit=400)[0] for part in parts) / np.pi for f in (force, torque)
    )


def disc(pressure, ratio: float) -> tuple[float, float]:
    """Friction and torque of rings of a pressure p(rho) that adds up to 1 over the unit disc."""
    points = [ratio] if 0.0 < ratio < 1.0 else None
    return tuple(
        quad(
            lambda rho, k=k: 2.0 * np.pi * rho * pressure(rho) * ring(ratio, rho)[k],
            0.0,
            1.0,
            points=points,
            epsabs=1e-8,
            limit=200,
        )[0]
        for k in range(2)
    )


@pytest.mark.parametrize("ratio", RATIOS)
def test_rim_is_the_mean_over_its_edge(ratio):
    assert rim_friction(ratio) == pytest.approx(ring(ratio, 1.0), abs=1e-10)


@pytest.mark.parametrize("ratio", [0.03, 0.6, 1.3])
def test_hertz_is_the_integral_of_its_pressure(ratio):
    pressure = disc(lambda rho: 1.5 / np.pi * np.sqrt(1.0 - rho * rho), ratio)
    assert hertz_friction(ratio) == pytest.approx(pressure, abs=1e-7)


def test_hertz_has_converged(monkeypatch):
    coarse = [hertz_friction(ratio) for ratio in RATIOS]
    finer = np.polynomial.legendre.leggauss(200)
    monkeypatch.setattr("lab.limit_surface_exact.GAUSS", finer)
    np.testing.assert_allclose(coarse, [hertz_friction(ratio) for ratio in RATIOS], atol=1e-8)


@pytest.mark.parametrize("name", FRICTION)
def test_ends_are_spin_and_translation(name):
    assert FRICTION[name](0.0) == pytest.approx((0.0, 1.0 / OUTER_RADII[name]), abs=1e-12)
    assert FRICTION[name](np.inf) == pytest.approx((1.0, 0.0), abs=1e-12)


def test_rim_where_its_centre_of_rotation_lies_on_it():
    assert rim_friction(1.0) == pytest.approx((2.0 / np.pi, 2.0 / np.pi), rel=1e-12)


@pytest.mark.parametrize("name", FRICTION)
def test_normality(name):
    """Friction is the gradient of the power: ratio dF + dM = 0 along the surface (Goyal et al.)."""
    for ratio in (0.3, 0.9, 1.1, 3.0):
        h = 1e-4
        before, after = FRICTION[name](ratio - h), FRICTION[name](ratio + h)
        slip = ratio * (after[0] - before[0]) + after[1] - before[1]
        assert slip == pytest.approx(0.0, abs=1e-9)
        assert after[0] - before[0] > 1e-6


def test_friction_opposes_the_twist():
    force, torque = uniform_friction(0.5)
    twists = np.array([[0.3, 0.4, 1.0], [-0.5, 0.0, -1.0], [0.0, 0.0, -2.0], [0.0, 7.0, 0.0]])
    np.testing.assert_allclose(
        exact_friction("uniform", twists),
        [
            [-0.6 * force, -0.8 * force, -torque],
            [force, 0.0, torque],
            [0.0, 0.0, 2.0 / 3.0],
            [0.0, -1.0, 0.0],
        ],
        atol=1e-12,
    )
