"""Published static friction is never below published Coulomb friction."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import estimator
from tests.estimator.exact_records import RATE

FINGERS, SAMPLES = 8, 300
everywhere = pytest.mark.parametrize("name", estimator.names())


def signals(seed):
    """Stick, slips longer than a spring, spin, no contact: wrenches (samples, fingers, 4), twists (…, 3)."""
    rng = np.random.default_rng(seed)
    wrenches = rng.normal(scale=(1.0, 1.0, 1.0, 0.02), size=(SAMPLES, FINGERS, 4))
    wrenches[..., 2] = np.maximum(4.0 + np.cumsum(0.5 * wrenches[..., 2], axis=0), 0.0) % 9.0
    moving = np.repeat(rng.random((SAMPLES // 8 + 1, FINGERS, 3)) < 0.5, 8, axis=0)[:SAMPLES]
    return wrenches, np.where(moving, rng.normal(scale=(0.05, 0.05, 5.0), size=(SAMPLES, FINGERS, 3)), 0.0)


@everywhere
@settings(deadline=None, max_examples=15)
@given(seed=st.integers(0, 2**32 - 1), mu_s0=st.floats(0.02, 5.0), mu_c0=st.floats(0.02, 5.0))
def test_mu_s_is_at_least_mu_c(name, seed, mu_s0, mu_c0):
    batch = estimator.make_batch(name, FINGERS, mu_s0=mu_s0, mu_c0=mu_c0)
    assert (batch.estimates["mu_s"] >= batch.estimates["mu_c"]).all()
    wrenches, twists = signals(seed)
    for k in range(SAMPLES):
        batch.update((k + 1) / RATE, wrenches[k], twists[k])
        assert (batch.estimates["mu_s"] >= batch.estimates["mu_c"]).all()
        states, estimates = batch.states, batch.estimates
        start_value = (states["updates_mu_c"] == 0) & (states["events_mu_s"] > 0)
        lower = np.where(start_value, np.minimum(states["mu_c"], states["mu_s"]), states["mu_c"])
        np.testing.assert_array_equal(estimates["mu_c"], lower)
        np.testing.assert_array_equal(estimates["mu_s"], np.maximum(states["mu_s"], lower))


@pytest.mark.parametrize("name", sorted({*estimator.names()} - {"adaptive"}))
def test_the_signals_above_reach_the_limit(name):
    """ "adaptive" has no such limit: its state is the logarithm of a ratio of at least 1."""
    batch = estimator.make_batch(name, FINGERS)
    wrenches, twists = signals(1)
    below = 0
    for k in range(SAMPLES):
        batch.update((k + 1) / RATE, wrenches[k], twists[k])
        below += (batch.states["mu_s"] < batch.states["mu_c"]).sum()
    assert below > 0


@everywhere
def test_start_values_and_rows_reset_to_them_keep_the_order(name):
    est = estimator.make(name, mu_s0=0.3, mu_c0=0.6)
    assert (est.estimate.mu_s, est.estimate.mu_c) == (0.6, 0.6)
    batch = estimator.make_batch(name, 3, mu_s0=0.3, mu_c0=0.6)
    batch.reset([1])
    assert batch.estimates["mu_s"].tolist() == [0.6, 0.6, 0.6]
    assert batch.states["mu_s"].tolist() == [0.3, 0.3, 0.3]
