"""The Stribeck curve is one function, and the solvers' shortcuts keep their tolerance for every exponent."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from slipgym.contact import (
    DistributedContact,
    EllipsoidContact,
    cell_levels,
    ellipsoid_kernel,
    stribeck,
)
from slipgym.contact.pressure import patch_cells
from slipgym.contact.records import pads, patch

EXPONENTS = (0.5, 1.0, 2.0, 4.0)
H = 2.5e-4
CELLS = patch_cells("uniform", 5)
"""Positions and loads."""
LAW = {"mu_c": 0.4, "mu_s": 0.55, "stribeck_velocity": 1e-3, "sigma_0": 1e6, "sigma_1": 80.0, "r": 0.01}


def curve(speed, exponent):
    """g of `LAW`, written from its equation."""
    return 0.4 + 0.15 * np.exp(-((speed / 1e-3) ** exponent))


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_both_models_read_the_same_curve(exponent):
    for speed in (1e-5, 3e-4, 1e-3, 2e-3, 5e-3, 0.1):
        expected = -curve(speed, exponent) * 5.0
        for contact in (
            EllipsoidContact(stribeck_exponent=exponent, sigma_2=0.0),
            DistributedContact(stribeck_exponent=exponent, sigma_2=0.0, cells=5),
        ):
            for _ in range(20):  # steps of the bristles' whole length: steady slip
                force = contact.step((speed, 0.0, 0.0), 5.0, 2e-6 / speed)
            assert force[0] == pytest.approx(expected, rel=1e-12), type(contact)


@pytest.mark.parametrize("exponent", [*EXPONENTS, 1.5, 2.3, 3.0, 6.0])
def test_the_slope_is_bounded_as_said(exponent):
    speeds = np.geomspace(1e-4, 1e2, 20001)
    slope = np.abs(np.diff(np.exp(-(speeds**exponent))) / np.diff(speeds)).max()
    bound = stribeck.steepest_slope(exponent)
    assert slope <= bound * (1.0 + 1e-9)  # rounding of the differences
    if exponent > 2.5:
        assert slope == pytest.approx(bound, rel=1e-4)  # and not more than it must be


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_the_curve_is_flat_where_it_is_taken_for_flat(exponent):
    assert stribeck.decayed(stribeck.flat_speed(exponent), exponent) == pytest.approx(np.exp(-9.0))
    beyond = stribeck.vanishing_speed(exponent) * (1.0 + 1e-12)
    assert stribeck.friction_level(0.4, 0.8, beyond, exponent) == 0.4


def test_the_default_exponent_has_the_constants_it_always_had():
    assert stribeck.steepest_slope(2.0) == 1.0
    assert stribeck.flat_speed(2.0) == 3.0


speeds = st.floats(-7.0, -1.0).map(lambda power: 10.0**power)


@settings(deadline=None, max_examples=400)
@given(st.sampled_from(EXPONENTS), speeds, speeds, st.floats(-1.0, 1.0))
def test_an_ellipsoids_level_is_that_of_the_speed_found(exponent, slip_speed, found, trend):
    pad = pads(1, stribeck_exponent=exponent, normal=5.0, **LAW)
    pad["slip_speed"], pad["half_step"] = slip_speed, 0.5 * H
    pad["slip_rate"] = trend * slip_speed / H
    before = (0.54e-6, 0.0, 0.0)
    pad["z"][0] = before
    level = ellipsoid_kernel.set_friction_level(pad[0], H)
    pad["z"][0] = (level / 1e6, 0.0, 0.0)  # on the limit: any displacement slips
    new = ellipsoid_kernel.update_friction_level(pad[0], before, (found * H, 0.0, 0.0), H, level)
    assert abs(new - curve(found, exponent)) <= 1.001 * stribeck.LEVEL_TOLERANCE * new


@settings(deadline=None, max_examples=400)
@given(st.sampled_from(EXPONENTS), speeds, speeds)
def test_a_patchs_levels_are_those_of_the_speed_found(exponent, expected, found):
    pad = pads(1, stribeck_exponent=exponent, normal=5.0, **LAW)
    cells = patch(*CELLS)
    cells[cell_levels.SPEED_CAP] = np.inf  # all cells slip
    pad["twist"], pad["half_step"] = (expected, 0.0, 0.0), 0.5 * H
    level = cell_levels.set_friction_levels(pad[0], cells, (expected, 0.0, 0.0))
    new = cell_levels.update_friction_levels(pad[0], cells, (found * H, 0.0, 0.0), H, level)
    assert abs(new - curve(found, exponent)) <= 1.001 * stribeck.LEVEL_TOLERANCE * new


@pytest.mark.parametrize("slope", [-0.1, 0.05, 0.2])
def test_velocity_steps_follow_the_logarithm(slope):
    """Steps up and down: on either limit surface friction is mu_c (1 + a ln(v / 10 mm/s)) beyond v_s."""
    for contact in (EllipsoidContact(sigma_2=0.0), DistributedContact(sigma_2=0.0, cells=5)):
        contact._pads["speed_slope"] = slope
        for speed in (0.01, 0.1, 4e-3, 0.5, 2.0, 1e-3, 0.03):
            for _ in range(20):
                force = contact.step((speed, 0.0, 0.0), 5.0, 2e-6 / speed)
            sliding = 0.4 * (1.0 + slope * np.log(min(speed, 1.0) / 0.01))
            level = sliding + (0.55 - sliding) * np.exp(-((speed / 1e-3) ** 2))
            assert -force[0] / 5.0 == pytest.approx(level, rel=1e-9), type(contact)


@pytest.mark.parametrize("slope", [-0.2, 0.2])
@pytest.mark.parametrize("exponent", [1.0, 2.0, 4.0])
def test_shortcuts_keep_their_tolerance_with_the_logarithm(slope, exponent):
    pad = pads(1, stribeck_exponent=exponent, normal=5.0, speed_slope=slope, **LAW)[0]
    speeds = np.geomspace(1e-6, 2.0, 4001)
    levels = np.array([stribeck.level_at(pad, speed) for speed in speeds])
    for k in (1, 10, 100, 1000):
        same = [stribeck.level_unchanged(pad, change) for change in speeds[k:] - speeds[:-k]]
        assert np.abs(levels[k:] - levels[:-k])[same].max(initial=0.0) <= stribeck.LEVEL_TOLERANCE * 0.4
    assert stribeck.level_unchanged(pad, 1e-7)
    assert levels[0] == pytest.approx(0.55, rel=1e-2 if exponent == 1.0 else 1e-4)
