"""The distributed contact at its limits: steady translation and spin, stick, bad values."""

import numpy as np
import pytest

from slipgym.contact import DistributedContact

FRICTION = {"mu_c": 0.5, "mu_s": 0.7, "sigma_2": 0.0}


def steady(contact: DistributedContact, twist: tuple[float, float, float]) -> tuple[float, float, float]:
    """Friction at 5 N after 50 ms at the same twist."""
    for _ in range(500):
        wrench = contact.step(twist, 5.0, 1e-4)
    return wrench


@pytest.mark.parametrize(
    ("pressure", "ratio"),
    [("uniform", 2 / 3), ("hertz", 3 * np.pi / 16), ("rim", 1.0), ("punch", np.pi / 4)],
)
def test_steady_translation_and_spin_of_named_pressures(pressure, ratio):
    contact = DistributedContact(radius=0.015, cells=21, pressure=pressure, **FRICTION)
    assert steady(contact, (0.03, 0.04, 0.0)) == pytest.approx((-1.5, -2.0, 0.0), abs=1e-9)
    torque = -steady(contact, (0.0, 0.0, 20.0))[2]
    assert contact.effective_radius == pytest.approx(ratio * 0.015, rel=1e-12)
    assert torque == pytest.approx(0.5 * 5.0 * ratio * 0.015, rel=1e-9)


def test_anisotropic_friction_is_normal_to_the_stretched_surface():
    contact = DistributedContact(anisotropy=0.2, **FRICTION)
    even = DistributedContact(**FRICTION)
    a, b = 1.2, 0.8
    f_x, f_y, tau = steady(contact, (0.03, 0.04, 0.0))
    size = np.hypot(a * 0.03, b * 0.04)
    assert (f_x, f_y) == pytest.approx((-2.5 * a * a * 0.03 / size, -2.5 * b * b * 0.04 / size), rel=1e-9)
    assert tau == pytest.approx(0.0, abs=1e-9)
    np.testing.assert_allclose(contact.positions, even.positions, rtol=1e-15)
    assert contact.effective_radius == pytest.approx(even.effective_radius, rel=1e-15)


def test_a_patch_may_be_a_single_cell():
    contact = DistributedContact(cells=1, **FRICTION)
    assert contact.effective_radius == 0.0
    assert steady(contact, (0.03, 0.04, 5.0)) == pytest.approx((-1.5, -2.0, 0.0), abs=1e-9)


def test_sticks_without_drift_below_break_away():
    contact = DistributedContact(**FRICTION)
    push = (1e-6, 0.0, 0.0)
    for _ in range(2000):
        contact.step(push, 5.0, 1e-4)  # 0.2 um in all, where 1 um would slide
    before = contact.bristles
    for _ in range(1000):
        force = contact.step((0.0, 0.0, 0.0), 5.0, 1e-4)
    assert np.array_equal(contact.bristles, before)
    assert force[0] == pytest.approx(-5.0 * 1e6 * 2e-7)


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ({"mu_s": 0.1}, "mu_s"),
        ({"cells": 0}, "cells"),
        ({"pressure": "square"}, "'hertz'"),
        ({"pressure": np.ones((3, 3))}, r"\(21, 21\)"),
        ({"radius": -1.0}, "radius"),
        ({"anisotropy": 0.5}, r"anisotropy = 0.5 must be in"),
    ],
)
def test_refuses_bad_parameters_by_name(change, named):
    with pytest.raises(ValueError, match=named):
        DistributedContact(**{"mu_c": 0.5, "mu_s": 0.7, **change})


def test_refuses_a_twist_that_is_not_finite():
    with pytest.raises(ValueError, match="twist"):
        DistributedContact().step((0.0, np.nan, 0.0), 5.0, 1e-4)
