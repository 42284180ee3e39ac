import numpy as np
import pytest
from scipy import stats

from slipgym._numba.compiled import compiled
from slipgym.sensors.noise import CELLS, TAIL, interpolated, quantile, standard_normal, uniform

KEYS = np.random.default_rng(0).integers(2**64, size=4, dtype=np.uint64)


@compiled
def _draw(key, out):
    for i in range(out.shape[0]):
        out[i] = standard_normal(key, i)


def draw(key, n=200_000):
    out = np.zeros(n)
    _draw(key, out)
    return out


def test_it_is_splitmix64():
    # the first outputs of the reference implementation (prng.di.unimi.it/splitmix64.c) for the state 1234567
    reference = [6457827717110365317, 3203168211198807973, 9817491932198370423, 4593380528125082431]
    for i, x in enumerate(reference):
        assert uniform(np.uint64(1234567), i) == ((x >> 11) + 0.5) * 2.0**-53


def test_the_quantile_inverts_the_distribution():
    p = np.concatenate([np.geomspace(2.0**-54, 0.5, 4000), 1.0 - np.geomspace(1e-15, 0.5, 4000)])
    found = np.array([quantile(x) for x in p])
    np.testing.assert_allclose(found, stats.norm.ppf(p), rtol=1e-13, atol=1e-15)


def test_the_cubics_stand_for_the_quantile():
    """A cubic with value and slope of f at both ends errs by at most h^4 / 384 of its fourth derivative."""
    p = np.random.default_rng(1).random(20_000)
    away = np.abs([interpolated(x) - quantile(x) for x in p])
    x = -stats.norm.ppf(np.clip(np.minimum(p, 1 - p) - 1 / CELLS, TAIL / CELLS, None))  # the cell's outer end
    fourth = (6.0 * x**3 + 7.0 * x) / stats.norm.pdf(x) ** 4
    assert np.all(away <= fourth / CELLS**4 / 384 + 1e-15)
    assert away.max() < 1e-7
    tail = np.minimum(p, 1 - p) < TAIL / CELLS
    assert tail.sum() > 400
    assert np.all(away[tail] == 0.0)


@pytest.mark.parametrize("key", KEYS)
def test_numbers_are_normal_and_independent(key):
    values = draw(key)
    # with 12 such tests a true generator fails one in 1000 runs; the keys are fixed
    assert stats.kstest(values, "norm").pvalue > 1e-4
    for lag in (1, 6):
        correlation = np.corrcoef(values[:-lag], values[lag:])[0, 1]
        assert abs(correlation) < 4.0 / np.sqrt(len(values))


def test_neighbouring_keys_are_independent():
    key = KEYS[0]
    rows = np.array([draw(key + np.uint64(k), 50_000) for k in range(4)])
    away = np.corrcoef(rows) - np.eye(4)
    assert np.abs(away).max() < 4.5 / np.sqrt(50_000)
