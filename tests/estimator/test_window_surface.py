"""The table of limit surfaces against integrals and closed forms."""

import numpy as np
import pytest

from estimator.limit_surface import disc_friction
from estimator.window.surface import ANGLES, RING, surface

KNOTS = np.linspace(0.0, 0.5 * np.pi, ANGLES + 1)
BETWEEN = 0.5 * (KNOTS[1:] + KNOTS[:-1])


def table(shape, angles):
    return np.array([surface(shape, theta)[:2] for theta in angles])


def test_shape_0_is_the_ellipsoid():
    """Exact at the knots; linear interpolation is off by (pi / 128)^2 / 8 between them."""
    for angles, tolerance in ((KNOTS, 1e-12), (BETWEEN, 1e-4)):
        exact = np.column_stack((np.cos(angles), np.sin(angles)))
        np.testing.assert_allclose(table(0.0, angles), exact, atol=tolerance)


def test_shape_1_is_the_disc():
    """r is two thirds of the disc's radius; sixty rings are off by up to 0.2 % of mu_c f_n near pure spin."""
    exact = [disc_friction(2.0 / 3.0 / np.tan(theta)) for theta in BETWEEN]
    np.testing.assert_allclose(table(1.0, BETWEEN), np.array(exact) * (1.0, 1.5), atol=2e-3)


def rings(theta, radii, shares, r):
    """Friction over mu_c f_n and torque over mu_c f_n r of rings that carry these shares of the load."""
    angle = 2.0 * np.pi * (np.arange(4000) + 0.5) / 4000
    x, y = np.outer(radii, np.cos(angle)), np.outer(radii, np.sin(angle))
    v_x, v_y = np.cos(theta) - np.sin(theta) / r * y, np.sin(theta) / r * x
    speed = np.hypot(v_x, v_y) + 1e-12
    each = (v_x / speed).mean(axis=1), ((x * v_y - y * v_x) / speed).mean(axis=1) / r
    return [float(shares @ part) for part in each]


def test_the_last_shape_is_the_ring():
    """Linear interpolation is off most where the ring turns about one of its points, 45 degrees."""
    exact = [rings(theta, np.ones(1), np.ones(1), 1.0) for theta in KNOTS]
    np.testing.assert_allclose(table(RING, KNOTS), exact, atol=2e-3)


def test_a_hertzian_pressure_is_shape_0_91():
    """Within 0.5 % (rms) of mu_c f_n and mu_c f_n r."""
    radii = (np.arange(400) + 0.5) / 400
    shares = radii * np.sqrt(1.0 - radii**2)
    shares /= shares.sum()
    exact = [rings(theta, radii, shares, shares @ radii) for theta in BETWEEN]
    assert (np.sqrt(np.square(table(0.91, BETWEEN) - exact).mean(axis=0)) < 5e-3).all()


@pytest.mark.parametrize("shape", [-0.1, 0.4, 0.95, 1.2])
def test_derivatives_of_the_surface(shape):
    """Within an interval of the table, where it is linear."""
    for theta in BETWEEN:
        slopes = np.array(surface(shape, theta)[2:]).reshape(2, 2)
        for slope, (d_shape, d_theta) in zip(slopes, ((0.0, 1e-4), (1e-4, 0.0)), strict=True):
            upper, lower = (surface(shape + k * d_shape, theta + k * d_theta)[:2] for k in (1, -1))
            np.testing.assert_allclose(slope, np.subtract(upper, lower) / 2e-4, atol=1e-9)
