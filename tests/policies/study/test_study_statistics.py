import numpy as np
import pytest

from policies.evaluation.statistics import Bootstrap, Drawn


def test_the_interval_of_a_mean_is_the_normal_one():
    values = np.random.default_rng(3).normal(5.0, 2.0, 400)
    interval = Bootstrap(np.zeros(400))(values).interval
    half = 1.96 * values.std() / np.sqrt(400)
    assert interval.value == pytest.approx(values.mean())
    # ends of 4000 resamples: off by up to 3 sqrt(0.025 0.975 / 4000) / 0.0584 = 0.127 standard errors
    assert interval.low == pytest.approx(values.mean() - half, abs=0.127 * half / 1.96)
    assert interval.high == pytest.approx(values.mean() + half, abs=0.127 * half / 1.96)


def test_strata_are_resampled_each_by_itself():
    strata = np.repeat([0, 1, 2], 20)
    drawn = Bootstrap(strata)(strata)
    np.testing.assert_allclose(drawn.draws, 1.0)
    assert Bootstrap(np.zeros(60))(strata).draws.std() > 0.05


def test_single_episodes_have_no_interval():
    interval = Bootstrap(np.array([0, 0, 1]))(np.array([1.0, 2.0, 3.0])).interval
    assert interval.value == 2.0
    assert np.isnan([interval.low, interval.high]).all()


def test_pairs_stay_pairs():
    bootstrap = Bootstrap(np.zeros(50))
    values = np.random.default_rng(0).normal(size=50)
    difference = bootstrap(values + 1.0) - bootstrap(values)
    assert difference.interval.low == pytest.approx(1.0)
    assert difference.interval.high == pytest.approx(1.0)
    np.testing.assert_array_equal(Bootstrap(np.zeros(50))(values).draws, bootstrap(values).draws)


def test_a_share_of_a_known_whole():
    bootstrap = Bootstrap(np.zeros(50))
    gain = np.random.default_rng(0).uniform(1.0, 2.0, 50)
    share = bootstrap(0.8 * gain).share_of(bootstrap(gain)).interval
    assert share == pytest.approx((0.8, 0.8, 0.8))


def test_a_resample_without_a_whole_speaks_against_the_share():
    share = Drawn(1.0, np.ones(4)).share_of(Drawn(2.0, np.array([2.0, 0.0, -1.0, 4.0])))
    np.testing.assert_array_equal(share.draws, [0.5, -np.inf, -np.inf, 0.25])
    assert share.interval == (0.5, -np.inf, 0.5)
