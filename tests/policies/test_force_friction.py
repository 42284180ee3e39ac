"""Friction by forces: exact on its limit surfaces, honest between them."""

import numpy as np
import pytest

from estimator.limit_surface.disc import DISC_RADIUS, disc_friction
from policies.controllers.force_friction import Found, Ratios, merge, solve

MU_S, MU_C, R = 0.6, 0.4, 0.008
NONE = Ratios(*np.zeros((5, 1)))


def on(kind, mu, ratio):
    """f_t / f_n and tau / f_n of a slip with the velocity ratio v / (omega R), on a limit surface."""
    if kind == "disc":
        force, torque = disc_friction(ratio)
        return mu * force, mu * torque / DISC_RADIUS * R
    size = np.hypot(ratio, 1.0)
    return mu * ratio / size, mu / size * R


def sums(*samples):
    found = NONE
    for force, torque in samples:
        found = found.add(
            np.array([True]), np.array([1e-4]), np.array([force]), np.array([torque]), np.array([R])
        )
    return found


@pytest.mark.parametrize("kind", ["disc", "ellipsoid"])
@pytest.mark.parametrize(("lever", "largest"), [(0.2, 0.025), (1.0, 0.055)])
def test_the_truth_lies_within_what_is_stated(kind, lever, largest):
    """Break-away and slide with the load's torque, turn in a firm grip, without noise.

    What no forces tell is the limit surface: the errors grow with the torque.
    """
    static, slide = sums(on(kind, MU_S, 1.0 / lever)), sums(on(kind, MU_C, 1.0 / lever))
    turn = sums(on(kind, MU_C, 0.35))
    found = solve(static, slide, turn, np.array([0.01]), np.zeros(1))
    errors = np.log(found.values[:, 0] / (MU_S, MU_C, R))
    assert np.all(np.abs(errors) < 2.0 * found.deviations[:, 0])
    assert np.abs(errors).max() < largest


def test_without_a_torque_mu_does_not_depend_on_the_limit_surface():
    found = solve(sums((MU_S, 0.0)), sums((MU_C, 0.0)), NONE, np.array([R]), np.zeros(1))
    assert found.values[:2, 0] == pytest.approx((MU_S, MU_C), rel=1e-3)
    assert found.deviations[:2, 0] == pytest.approx(0.01, rel=1e-2)
    assert found.values[2, 0] == 1.0
    assert np.isinf(found.deviations[2, 0])


def test_samples_of_different_torque_are_averaged_on_the_surface():
    """The mean of two points of an ellipse is none of its points; means of their powers are exact."""
    slide = sums(on("ellipsoid", MU_C, 5.0), on("ellipsoid", MU_C, 1.0))
    turn = sums(on("ellipsoid", MU_C, 0.3), on("ellipsoid", MU_C, 0.5))
    force, torque = (slide.means(True)[0] - turn.means(True)[0]), (turn.means(True)[1] - slide.means(True)[1])
    assert np.sqrt(torque / force) == pytest.approx(R, rel=1e-9)


def test_a_sample_with_a_torque_counts_less():
    assert sums(on("ellipsoid", MU_C, 1.0)).weight < 0.3 * sums((MU_C, 0.0)).weight


def test_merging_weighs_by_variance_and_states_no_more_than_the_better():
    observed, deviations = np.full((3, 1), 0.5), np.array([[0.02], [0.0], [1.0]])
    own = Found(np.array([[0.51], [0.6], [0.7]]), np.array([[0.02], [0.01], [np.inf]]))
    values, merged = merge(observed, deviations, own)
    assert values[:, 0] == pytest.approx((np.sqrt(0.5 * 0.51), 0.5, 0.5), rel=1e-6)
    assert merged[:, 0] == pytest.approx((0.02, 0.0, 1.0))


def test_a_contradiction_widens_the_deviation():
    own = Found(np.full((3, 1), 0.6), np.full((3, 1), 0.01))
    _, merged = merge(np.full((3, 1), 0.5), np.full((3, 1), 0.01), own)
    assert merged[:, 0] == pytest.approx(0.01 * np.log(1.2) / np.hypot(0.01, 0.01))
