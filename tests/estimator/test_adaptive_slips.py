"""Errors of the model that one slip has as a whole: the deviation falls with slips that agree."""

import numpy as np
import pytest

import estimator
from tests.estimator.exact_records import RATE

NOISE = 0.02, 0.02, 0.04, 5e-4
EXACT = {"sd_zero": 1e-3, "sd_tilt": 1e-3}
"""Forces without zero error and tilt."""


def course(ratios, samples=40, f_n=4.0, seed=0, **parameters):
    """Slips of 20 mm/s along y, each with its own friction, and rests between; estimates after each."""
    est, k, after = estimator.make("adaptive", **EXACT, **parameters), 0, []
    rng = np.random.default_rng(seed)
    for mu_c in ratios:
        for i in range(samples + 24):
            slips = i >= 24
            force = mu_c * f_n if slips else 0.8 * mu_c * f_n
            wrench = np.array([0.0, force, f_n, 0.0]) + rng.normal(size=4) * NOISE
            estimates = est.update((k := k + 1) / RATE, wrench, (0.0, 0.02 if slips else 0.0, 0.0))
        after.append(estimates)
    return est, after


def relative(estimates):
    return estimates.sd_mu_c / estimates.mu_c


def test_slips_that_agree_lower_the_deviation():
    _, after = course([0.4] * 6)
    assert relative(after[0]) > relative(after[2]) > relative(after[5])
    assert after[5].confidence_mu_c > 0.5


def test_slips_that_disagree_do_not():
    """Each slip is 25 % off another way: many samples say little of the next slip."""
    even, uneven = course([0.4] * 8), course([0.3, 0.5] * 4)
    assert relative(uneven[1][-1]) > 2.0 * relative(even[1][-1])
    assert abs(uneven[1][-1].mu_c - 0.4) < 2.0 * uneven[1][-1].sd_mu_c


def held_at(est, f_n):
    """The estimate after half a second at rest under a normal force [N]."""
    k = est.batch.states["samples"][0]
    for i in range(k, k + 60):
        held = est.update((i + 1) / RATE, (0.0, 1.0, f_n, 0.0), (0.0, 0.0, 0.0))
    return held


def test_a_load_at_which_nothing_slipped_is_not_known():
    """Slips at 4 N do not show the friction at 12 N; only the noise of the normal force seems to."""
    est, after = course([0.4] * 8)
    assert relative(held_at(est, 12.0)) > 1.2 * relative(after[-1])


def test_what_all_slips_share_remains():
    """A gain or anisotropy is not seen by slips of one direction, however many."""
    est, after = course([0.4] * 20)
    assert relative(after[-1]) > est.parameters.sd_gain


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_slow_slide_that_turns_is_a_slip(sign):
    """8 mm/s under 12 N, the wrench on the object or on the finger: the pad does not spring all the time."""
    est = estimator.make("adaptive")
    for k in range(360):
        angle, moves = 1.5 * k / RATE, k >= 60
        unit = np.array([np.cos(angle), np.sin(angle)])
        force = sign * 0.8 * 12.0 * unit * min(max((k - 57) / 3.0, 0.0), 1.0)
        twist = 0.008 * unit * moves
        est.update((k + 1) / RATE, (*force, 12.0, 0.0), (*twist, 0.0))
    assert est.estimate.mu_c == pytest.approx(0.8, rel=0.05)
    assert est.estimate.confidence_mu_c > 0.4
