"""The pressure of a flat punch, 1 / (2 pi a sqrt(a^2 - rho^2)) of the load, by its moments and integrals."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from slipgym.contact import DistributedContact
from slipgym.contact.pressure import patch_cells

CELLS = 41
MU, NORMAL, RADIUS = 0.5, 5.0, 0.015


def test_moments_and_fractions_are_those_of_the_pressure():
    positions, loads = patch_cells("punch", CELLS)
    rho = np.hypot(*positions.T)
    assert loads @ rho == pytest.approx(math.pi / 4.0, rel=1e-12)
    # the integral of rho^3 / sqrt(1 - rho^2): 2/3; less what a cell's mean is nearer to the centre
    assert loads @ rho**2 == pytest.approx(2.0 / 3.0, rel=2e-3)
    for edge in (0.3, 0.6, 0.9):
        inside = loads[rho < edge].sum()
        assert inside == pytest.approx(1.0 - math.sqrt(1.0 - edge**2), abs=0.02)  # a cell counts whole


def test_it_is_higher_at_the_edge_than_in_the_middle():
    positions, loads = patch_cells("punch", CELLS)
    rho, even = np.hypot(*positions.T), 4.0 / (math.pi * CELLS**2)  # of a whole cell under an even pressure
    for inner, outer in ((0.0, 0.2), (0.4, 0.5), (0.7, 0.8)):
        ring = (inner <= rho) & (rho < outer)
        middle = math.sqrt(0.5 * (inner**2 + outer**2))
        assert loads[ring].mean() / even == pytest.approx(0.5 / math.sqrt(1.0 - middle**2), rel=0.03)


def exact(distance: float) -> tuple[float, float]:
    """Force over mu N, torque over mu N a of a disc that turns about a point `distance` a off its centre."""

    def over(read) -> float:
        def ring(angle: float) -> float:  # rho = sin(angle) takes the pressure's edge out of the integral
            rho = math.sin(angle)
            part = quad(lambda phi: read(rho, phi), 0.0, math.pi, points=[0.0], limit=200)[0]
            return rho * part / math.pi

        near = math.asin(min(distance, 1.0))
        return quad(ring, 0.0, near, limit=200)[0] + quad(ring, near, math.pi / 2.0, limit=200)[0]

    def speed(rho: float, phi: float) -> float:
        return math.sqrt(rho * rho + distance * distance + 2.0 * rho * distance * math.cos(phi)) + 1e-15

    force = over(lambda rho, phi: (distance + rho * math.cos(phi)) / speed(rho, phi))
    return force, over(lambda rho, phi: (rho * rho + rho * distance * math.cos(phi)) / speed(rho, phi))


@pytest.mark.parametrize("distance", [0.0, 0.3, 0.75, 1.3, 4.0])
def test_friction_in_steady_slip_is_the_integral_of_the_pressure(distance):
    """In spin the torque is mu N r with r = pi / 4 of the radius."""
    contact = DistributedContact(RADIUS, 21, "punch", MU, MU, sigma_2=0.0)
    for _ in range(12):  # each a slip that leaves the bristles' deflection far behind
        wrench = contact.step((distance * RADIUS * 10.0, 0.0, 10.0), NORMAL, 0.1)
    found = np.array((-wrench[0], -wrench[2] / RADIUS)) / (MU * NORMAL)
    expected = (0.0, math.pi / 4.0) if distance == 0.0 else exact(distance)
    np.testing.assert_allclose(found, expected, atol=5e-3)
