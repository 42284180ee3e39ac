"""The limit surface of points: by hand, against the exact disc, and its table."""

from typing import get_args

import numpy as np
import pytest

from lab.limit_surface_exact import exact_friction
from slipgym.contact import DistributedContact
from slipgym.contact.limit_surface import LimitSurface
from slipgym.contact.pressure import PRESSURES, PressureName


def directions(n: int, r: float) -> np.ndarray:
    """Random twists (n, 3), uniform over directions of the scaled twist."""
    return np.random.default_rng(3).normal(size=(n, 3)) * (1.0, 1.0, 1.0 / r)


def test_two_points_by_hand():
    surface = LimitSurface([[0.0, 0.01], [0.0, -0.01]], [0.25, 0.75])
    assert surface.effective_radius == pytest.approx(0.01)
    # omega 1 rad/s about the centre: the points move along -x and +x; with v_x = 0.01 the first rests
    np.testing.assert_allclose(surface.exact((0.0, 0.0, 1.0)), (-0.5, 0.0, -0.01), atol=1e-15)
    np.testing.assert_allclose(surface.exact((0.01, 0.0, 1.0)), (-0.75, 0.0, -0.0075), atol=1e-15)
    np.testing.assert_allclose(surface.exact((0.0, -3.0, 0.0)), (0.0, 1.0, 0.0), atol=1e-15)


def test_many_points_are_the_exact_disc():
    rho, angle = np.sqrt((np.arange(300) + 0.5) / 300), 2 * np.pi * (np.arange(300) + 0.5) / 300
    points = np.stack([np.outer(rho, np.cos(angle)).ravel(), np.outer(rho, np.sin(angle)).ravel()], axis=1)
    surface = LimitSurface(points, np.full(90000, 1 / 90000), intervals=2)
    twists = directions(50, 1.0)
    # a ring has the area of a circle of 1 / 12 R: cells of 0.003 R
    np.testing.assert_allclose(surface.exact(twists), exact_friction("uniform", twists), atol=1e-4)


@pytest.mark.parametrize("pressure", ["uniform", "hertz", np.outer(np.arange(1, 22), np.ones(21))])
def test_the_table_is_the_sum(pressure):
    contact = DistributedContact(cells=21, pressure=pressure)
    surface = LimitSurface(contact.positions, contact.shares)
    twists = directions(2000, contact.effective_radius)
    away = (surface.wrench(twists) - surface.exact(twists)) / (1.0, 1.0, contact.effective_radius)
    # between two grid points the friction of a single cell may turn round, if the centre of rotation passes
    # it, and its lever is at most 1.7 r
    turn = 2.0 * contact.shares.max() * np.hypot(1.0, 1.7)
    assert np.linalg.norm(away, axis=1).max() < turn
    assert np.sqrt((away**2).sum(axis=1).mean()) < 1e-3


def test_the_table_is_exact_at_its_grid_and_closes_on_itself():
    contact = DistributedContact(cells=5)
    surface = LimitSurface(contact.positions, contact.shares, intervals=3)
    for twist in ([1.0, 0.0, 0.0], [1.0, -1e-15, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]):
        np.testing.assert_allclose(surface.wrench(twist), surface.exact(twist), atol=1e-12)
        np.testing.assert_allclose(surface.wrench(5.0 * np.array(twist)), surface.wrench(twist), atol=1e-15)


@pytest.mark.parametrize(
    ("positions", "shares", "named"),
    [
        (np.ones((2, 3)), [0.5, 0.5], "positions"),
        ([[0.0, 1.0], [1.0, 0.0]], [0.5, 0.6], "shares"),
        ([[0.0, 1.0], [1.0, 0.0]], [1.5, -0.5], "shares"),
        ([[0.0, 0.0]], [1.0], "centre"),
    ],
)
def test_refuses_what_is_no_pressure(positions, shares, named):
    with pytest.raises(ValueError, match=named):
        LimitSurface(positions, shares)


def test_every_pressure_has_its_name_in_the_configuration():
    assert get_args(PressureName) == tuple(PRESSURES)
