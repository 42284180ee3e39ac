import math

import numpy as np
import pytest

from policies.evaluation.statistics import mean_interval, share_interval


@pytest.mark.parametrize(("successes", "n"), [(0, 10), (7, 10), (10, 10), (80, 160)])
def test_share_interval_solves_the_score_equation(successes, n):
    value, low, high = share_interval(successes, n)
    z = 1.959963984540054
    assert value == successes / n
    for bound in (low, high):  # Wilson: bounds p with (value - p)^2 = z^2 p (1 - p) / n
        assert (value - bound) ** 2 == pytest.approx(z**2 * bound * (1.0 - bound) / n, abs=1e-12)
    assert 0.0 <= low <= value <= high <= 1.0


@pytest.mark.parametrize(("successes", "n"), [(1, 0), (3, 2), (-1, 5)])
def test_impossible_shares_are_refused(successes, n):
    with pytest.raises(ValueError, match="no share"):
        share_interval(successes, n)


def test_mean_interval_matches_the_normal_one_for_many_normal_values():
    values = np.random.default_rng(1).normal(3.0, 2.0, 400)
    value, low, high = mean_interval(values)
    half = 1.96 * values.std(ddof=1) / math.sqrt(len(values))
    assert value == values.mean()
    assert low == pytest.approx(value - half, abs=0.1 * half)
    assert high == pytest.approx(value + half, abs=0.1 * half)


def test_mean_interval_covers_the_mean_of_skewed_values():
    rng = np.random.default_rng(2)
    covered = 0
    for _ in range(60):
        _, low, high = mean_interval(rng.exponential(1.0, 40))
        covered += low <= 1.0 <= high
    assert covered >= 51  # 95 % nominal; 51 of 60 is below the 0.5 % quantile of a binomial


def test_mean_interval_repeats_itself():
    values = np.random.default_rng(3).normal(size=20)
    assert mean_interval(values) == mean_interval(values)


def test_mean_interval_of_too_little():
    assert mean_interval(np.array([2.0, 2.0, 2.0])) == (2.0, 2.0, 2.0)
    value, low, high = mean_interval(np.array([np.nan, 4.0]))
    assert value == 4.0
    assert math.isnan(low)
    assert math.isnan(high)
    assert math.isnan(mean_interval(np.array([])).value)
