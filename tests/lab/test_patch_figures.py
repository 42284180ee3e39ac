"""The distributed contact's figures can fail, and hold where they are not printed."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lab.limit_surface_exact import exact_friction
from lab.validation.patch_rate import rate_form
from lab.validation.patch_steps import profile, step_difference
from lab.validation.patch_stick import CREEP_BOUND, energy_gain, hold
from lab.validation.patch_surface import MU_C, MU_S, RADIUS, steady_friction
from slipgym.contact import DistributedContact
from slipgym.contact.limit_surface import LimitSurface
from slipgym.synthetic import Course

DISC = 1.5  # radius of a uniform disc over r


def test_steps_lead_to_the_limit_surface_of_any_pressure():
    loads = np.random.default_rng(5).random((9, 9)) ** 3
    contact = DistributedContact(RADIUS, 9, loads, MU_C, MU_C, sigma_2=0.0)
    surface = LimitSurface(contact.positions, contact.shares)
    twists = np.random.default_rng(6).normal(size=(50, 3))
    scale = 1.0, 1.0, surface.effective_radius
    # cells nearest to a centre of rotation slip 1e-4 of the patch and more, 200 times their reach
    np.testing.assert_allclose(
        steady_friction(contact, twists), surface.exact(twists / scale) / scale, atol=1e-6
    )


@pytest.mark.parametrize("direction", [(1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.3, 0.5, 0.6), (-0.8, 0.2, -0.3)])
def test_a_slow_slip_breaks_away_on_the_static_limit_surface(direction):
    contact = DistributedContact(RADIUS, 21, "uniform", MU_C, MU_S)
    r, u = contact.effective_radius, np.array(direction)
    twist = 1e-5 * u / (1.0, 1.0, r)
    forces = [np.linalg.norm(contact.step(twist, 5.0, 0.01) / np.array([1.0, 1.0, r])) for _ in range(200)]
    expected = 5.0 * MU_S * np.linalg.norm(exact_friction("uniform", [u * (1.0, 1.0, DISC)]) * (1, 1, DISC))
    # at 1e-5 m/s g is below mu_s by 1e-4 of it at most and bristle damping adds 1e-3
    assert forces[-1] == pytest.approx(expected, rel=6e-3)
    assert forces[1] < 0.5 * expected  # still elastic


def test_a_load_below_the_static_limit_is_held():
    assert 1e3 * hold((0.5, -0.4, 0.77), 0.8) <= CREEP_BOUND


def test_a_load_above_the_static_limit_slides():
    assert hold((1.0, 0.0, 0.0), 1.4) > 1e-4  # 147 % at the tremble's peak, where 137.5 % is mu_s


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from(["uniform", "hertz", "rim"]))
def test_friction_never_gives_energy(seed, pressure):
    assert energy_gain(seed, pressure, steps=100) <= 1e-12


def test_a_tenth_of_the_step_hardly_matters():
    course = Course.start(normal=5.0).to("stick", 0.02).to("planar", 0.1, v_x=0.006, omega=0.5)
    course = course.to("reversal", 0.15, v_x=-0.006).to("stop", 0.1, v_x=0.0, omega=0.0)
    # 0.019 % over the profile of 10 s; here transients are a third of the time
    assert step_difference(course, cells=7) < 2e-3


def test_the_profile_has_every_kind_of_slip():
    course = profile()
    v_x, v_y, omega = course.at(np.linspace(0.0, course.times[-1], 10001))[:3]
    v_t = np.hypot(v_x, v_y)
    assert 0.020 <= v_t.max() <= 0.030
    assert 2.0 <= np.abs(omega).max() <= 3.0
    for kind in (v_t > 0, omega != 0, (v_t > 0) & (omega != 0), (v_t == 0) & (omega == 0)):
        assert 0.1 < kind.mean() < 0.9
    assert (np.diff(np.sign(v_x[np.abs(v_x) > 1e-5])) != 0).sum() >= 2


def test_the_rate_form_is_an_elastic_bristle_first_and_coulomb_in_the_end():
    course = Course.start(normal=5.0).to("slip", 0.001, v_x=1e-4).to("slip", 0.03)
    course = course.to("fast", 0.2, v_x=0.02).to("fast", 0.05)
    force = rate_form(course, np.zeros((1, 2)), np.ones(1), 1e-4)[:, 0]
    moved = 1e-4 * (0.003 - 0.0005)
    assert force[29] == pytest.approx(-5.0 * (1e6 * moved + 80.0 * 1e-4 + 0.2 * 1e-4), rel=1e-4)
    assert force[-1] == pytest.approx(-5.0 * (0.4 + 0.2 * 0.02), rel=1e-6)
    slow = 0.4 + 0.15 * math.exp(-0.01)
    assert force[309] == pytest.approx(-5.0 * (slow + 0.2e-4), rel=1e-3)
