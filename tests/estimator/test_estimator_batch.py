"""Many fingers in one call: the same numbers as one by one."""

import numpy as np
import pytest

import estimator
from tests.estimator.exact_records import RATE

pytestmark = pytest.mark.parametrize("name", estimator.names())


def random_signals(n, samples, seed=0):
    """Signals that visit every branch: stick, slip, spin, fast rises and losses of contact.

    Every other stretch of 80 samples is a stick and slip along a steady force, in five and seven samples.

    Returns:
        wrenches (samples, n, 4) and twists (samples, n, 3).
    """
    rng = np.random.default_rng(seed)
    wrenches = rng.normal(scale=(1.0, 1.0, 1.0, 0.02), size=(samples, n, 4))
    wrenches[..., 2] = np.maximum(4.0 + np.cumsum(0.5 * wrenches[..., 2], axis=0), 0.0) % 9.0
    moving = np.repeat(rng.random((samples // 8 + 1, n, 3)) < 0.5, 8, axis=0)[:samples]
    twists = np.where(moving, rng.normal(scale=(0.01, 0.01, 1.0), size=(samples, n, 3)), 0.0)
    steady = np.arange(samples) // 80 % 2 == 1
    wrenches[steady, :, :3] = 0.02 * rng.normal(size=(steady.sum(), n, 3)) + np.array([1.0, 0.0, 4.0])
    slides = (np.arange(samples) % 12 < 5) | (np.arange(samples) % 80 > 64)
    twists[steady] = np.where(slides[steady], 0.02, 0.0)[:, np.newaxis, np.newaxis] * np.array(
        [1.0, 0.0, 50.0]
    )
    wrenches[steady, :, 3] = 0.008
    return wrenches, twists


def assert_same(actual, expected):
    assert actual.dtype == expected.dtype
    for field in actual.dtype.names:
        np.testing.assert_array_equal(actual[field], expected[field], err_msg=field)


def feed(batch, wrenches, twists, first=0):
    estimates = []
    for k in range(len(wrenches)):
        batch.update((first + k) / RATE, wrenches[k], twists[k])
        estimates.append(batch.estimates.copy())
    return estimates


def test_a_batch_equals_its_fingers_bit_for_bit(name):
    n, samples = 7, 400
    wrenches, twists = random_signals(n, samples)
    options = {} if name == "adaptive" else {"heuristic": True}
    estimates = feed(estimator.make_batch(name, n, **options), wrenches, twists)
    for i in range(n):
        single = estimator.make(name, **options)
        for k in range(samples):
            e = single.update(k / RATE, wrenches[k, i], twists[k, i])
            assert e == estimates[k][i].item()
    everything = np.concatenate(estimates)
    assert everything["halted"].any() == (name != "adaptive")
    assert everything["slipping"].any()
    assert not everything["slipping"].all()
    for count in ("events_mu_s", "updates_mu_c", "updates_r"):
        assert everything[count].max() > 10, count


def test_restored_arrays_continue_bit_for_bit(name):
    wrenches, twists = random_signals(3, 300, seed=1)
    batch = estimator.make_batch(name, 3)
    feed(batch, wrenches[:150], twists[:150])
    states, estimates = batch.states.copy(), batch.estimates.copy()
    first = feed(batch, wrenches[150:], twists[150:], first=150)
    batch.states[:] = states
    batch.estimates[:] = estimates
    assert_same(batch.estimates, estimates)
    for actual, expected in zip(feed(batch, wrenches[150:], twists[150:], first=150), first, strict=True):
        assert_same(actual, expected)


@pytest.mark.parametrize("indices", [[1, 3], np.array([False, True, False, True]), slice(1, None, 2)])
def test_reset_touches_only_its_rows(name, indices):
    wrenches, twists = random_signals(4, 100, seed=2)
    batch, fresh = estimator.make_batch(name, 4), estimator.make_batch(name, 4)
    feed(batch, wrenches, twists)
    states, estimates = batch.states.copy(), batch.estimates.copy()
    batch.reset(indices)
    for actual, kept, start in (
        (batch.states, states, fresh.states),
        (batch.estimates, estimates, fresh.estimates),
    ):
        assert_same(actual[[1, 3]], start[[1, 3]])
        assert_same(actual[[0, 2]], kept[[0, 2]])


def test_rows_may_have_their_own_parameters(name):
    wrenches, twists = random_signals(2, 200, seed=3)
    pair = estimator.make_batch(name, 2)
    alone = [estimator.make_batch(name, 1), estimator.make_batch(name, 1, r0=0.008, mu_c0=0.5, eps_v=2e-3)]
    pair.parameters_array = np.concatenate([batch.parameters_array for batch in alone])
    pair.reset()
    assert pair.estimates["r"].tolist() == [estimator.make(name).parameters.as_array()["r0"][0], 0.008]
    feed(pair, wrenches, twists)
    for i, batch in enumerate(alone):
        feed(batch, np.ascontiguousarray(wrenches[:, i : i + 1]), np.ascontiguousarray(twists[:, i : i + 1]))
        assert_same(pair.states[i : i + 1], batch.states)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("column", range(7))
def test_a_row_that_is_not_finite_is_skipped(name, bad, column):
    wrenches, twists = random_signals(2, 60, seed=4)
    batch = estimator.make_batch(name, 2)
    feed(batch, wrenches[:50], twists[:50])
    states = batch.states.copy()
    (wrenches if column < 4 else twists)[50, 0, column % 4 if column < 4 else column - 4] = bad
    batch.update(50 / RATE, wrenches[50], twists[50])
    assert_same(batch.states[:1], states[:1])
    assert batch.states["samples"].tolist() == [50, 51]


@pytest.mark.parametrize("t", [49 / RATE, 0.0, np.nan, np.inf])
def test_a_sample_whose_time_does_not_advance_or_is_not_finite_is_skipped(name, t):
    wrenches, twists = random_signals(2, 51, seed=5)
    batch = estimator.make_batch(name, 2)
    feed(batch, wrenches[:50], twists[:50])
    states = batch.states.copy()
    batch.update(t, wrenches[50], twists[50])
    assert_same(batch.states, states)


@pytest.mark.parametrize(
    ("wrenches", "twists", "error", "got"),
    [
        (np.zeros((3, 4)), np.zeros((2, 3)), ValueError, r"float64 \(3, 4\) and float64 \(2, 3\)"),
        (np.zeros((2, 3)), np.zeros((2, 4)), ValueError, r"float64 \(2, 3\) and float64 \(2, 4\)"),
        ([[0.0] * 4] * 2, np.zeros((2, 3)), ValueError, r"a list and float64 \(2, 3\)"),
        (np.zeros((2, 4), np.float32), np.zeros((2, 3)), TypeError, r"float32 \(2, 4\) and .* at t = 0\.0"),
        (
            np.zeros((2, 8))[:, ::2],
            np.zeros((2, 3)),
            TypeError,
            r"not contiguous float64 \(2, 4\) and float64",
        ),
    ],
)
def test_wrong_arrays_are_refused(name, wrenches, twists, error, got):
    with pytest.raises(error, match=rf"arrays wrenches \(2, 4\) and twists \(2, 3\).*, got {got}"):
        estimator.make_batch(name, 2).update(0.0, wrenches, twists)
