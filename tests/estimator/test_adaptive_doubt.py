"""A motion that may have been the spring of the pad says less of friction than a long slip."""

import numpy as np
import pytest

import estimator
from estimator.augmented.model_error import doubt_of
from estimator.augmented.parameters import AdaptiveParameters
from estimator.augmented.slip_law import R
from estimator.augmented.static_friction import _of_radius
from tests.estimator.exact_records import RATE


def slid(length, ratio=0.25, f_n=6.0, slips=1, **parameters):
    """Slips of `length` [m] at 20 mm/s, with rests between, at 0.8 of the static ratio; the estimator."""
    est, k = estimator.make("adaptive", **parameters), 0
    for _ in range(slips):
        for i in range(40 + max(round(length / 0.02 * RATE), 1) + 12):
            moves = 40 <= i < 40 + max(round(length / 0.02 * RATE), 1)
            force = ratio * f_n * (0.8 if moves else min(1.0, i / 36.0))
            est.update((k := k + 1) / RATE, (0.0, force, f_n, 0.0), (0.0, 0.02 if moves else 0.0, 0.0))
    return est


def test_a_short_motion_under_a_small_load_is_doubted_and_a_long_slip_is_not():
    short, long = slid(0.0006), slid(0.02)
    assert short.estimate.events_mu_s == long.estimate.events_mu_s == 1
    assert not short.batch.states["certain"][0]
    assert long.batch.states["certain"][0]
    assert short.estimate.sd_mu_s > 2.0 * long.estimate.sd_mu_s
    assert long.batch.states["doubt"][0] == 0.0


def test_the_doubt_grows_with_the_distance_from_what_is_expected():
    p = AdaptiveParameters().as_array()[0]
    doubts = [doubt_of(p, value, 0.9) for value in (1.2, 0.9, 0.6, 0.4, 0.2)]
    assert doubts[:2] == [0.0, 0.0]
    assert doubts == sorted(doubts)
    assert doubts[-1] < np.log(0.9 / 0.2) ** 2  # certainly a spring


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 1.0])
def test_an_uncertain_radius_makes_a_load_under_torque_uncertain(share):
    """A small deviation: the derivative by ln r; a large one: the load for a radius so much smaller."""
    state = estimator.make_batch("adaptive", 1).states[0]
    for sd, rel in ((1e-3, 1e-2), (0.7, 1e-6)):
        state["covariance"][R, R] = sd * sd
        exact = 0.5 * np.log((1.0 - share) + share * np.exp(2.0 * sd))
        assert _of_radius.py_func(np.rec.array(state), share) == pytest.approx(exact**2, rel=1e-6, abs=1e-15)
        if sd < 0.1:
            assert exact == pytest.approx(share * sd, rel=rel, abs=1e-12)


def test_break_aways_that_contradict_each_other_widen_the_deviation():
    """The variance of an event is a mean over the events and what is expected of one before."""
    even, uneven = slid(0.02, 0.5, slips=2), estimator.make("adaptive")
    k = 0
    for ratio in (0.8, 0.5):
        for i in range(80):
            moves = 40 <= i < 64
            force = ratio * 6.0 * (0.8 if moves else min(1.0, i / 36.0))
            uneven.update((k := k + 1) / RATE, (0.0, force, 6.0, 0.0), (0.0, 0.02 if moves else 0.0, 0.0))
    assert even.estimate.events_mu_s == 2
    assert uneven.estimate.events_mu_s >= 2
    relative = [est.estimate.sd_mu_s / est.estimate.mu_s for est in (even, uneven)]
    assert relative[1] > 1.5 * relative[0]
