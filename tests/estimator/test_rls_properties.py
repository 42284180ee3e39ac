"""Properties that hold for any input."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import estimator
from tests.estimator.exact_records import RATE


def steps(low, high, per_unit):
    """Multiples of 1 / per_unit in [low, high]: far from subnormal numbers, which do not scale exactly."""
    return st.integers(low * per_unit, high * per_unit).map(lambda k: k / per_unit)


unhurried = settings(deadline=None)
"""The first example may compile the kernel."""
anything = st.floats(allow_nan=False, allow_infinity=False)
force, torque, speed, spin = steps(-20, 20, 256), steps(-1, 1, 4096), steps(-1, 1, 16384), steps(-3, 3, 512)
gripping = st.lists(
    st.tuples(force, force, steps(0, 20, 256), torque, *[st.one_of(st.just(0.0), speed)] * 2, spin),
    min_size=1,
    max_size=40,
)
extreme = st.lists(
    st.tuples(*[st.one_of(anything, force)] * 4, *[st.one_of(anything, speed)] * 3), min_size=1, max_size=40
)


def feed(rows, dt=1 / RATE, **parameters):
    est = estimator.make("rls", **parameters)
    return [est.update((k + 1) * dt, row[:4], row[4:]) for k, row in enumerate(rows)]


@unhurried
@given(st.one_of(extreme, gripping))
def test_estimates_stay_finite_positive_and_in_bounds(rows):
    limits = estimator.RlsParameters()
    for e in feed(rows):
        assert limits.mu_min <= e.mu_s <= limits.mu_max
        assert limits.mu_min <= e.mu_c <= limits.mu_max
        assert limits.r_min <= e.r <= limits.r_max
        assert 0.0 <= e.gamma_t <= 1.0
        assert 0.0 <= e.gamma_tau <= 1.0
        for confidence in (e.confidence_mu_s, e.confidence_mu_c, e.confidence_r):
            assert 0.0 <= confidence <= 1.0


def test_a_sample_whose_squares_overflow_teaches_nothing():
    est = estimator.make("rls")
    before = est.estimate
    est.update(0.0, (1.0, 0.0, 1e200, 1.0), (0.01, 0.0, 1.0))
    assert est.estimate[:3] == before[:3]
    assert (est.batch.states["covariance_mu_c"][0], est.batch.states["covariance_r"][0]) == (1.0, 1.0)
    stuck = est.update(1.0, (1.0, 0.0, 1.0, 1e308), (0.0, 0.0, 0.0))
    assert (stuck.gamma_t, stuck.gamma_tau) == (0.0, 0.0)


@unhurried
@given(st.lists(st.tuples(*[st.floats()] * 7), min_size=1, max_size=40))
def test_nan_never_travels_into_the_state(rows):
    batch = estimator.make_batch("rls", 1)
    for k, row in enumerate(rows):
        batch.update(k / RATE, np.array([row[:4]]), np.array([row[4:]]))
    for name in batch.states.dtype.names or ():
        if name != "buffer":
            assert np.isfinite(batch.states[name]).all(), name
    assert not np.isnan(batch.states["buffer"]).any()


@unhurried
@given(gripping, st.integers(-6, 6))
def test_the_unit_of_force_does_not_matter(rows, exponent):
    """Friction and radius are ratios. The gain weighs phi^2 with P0, so P0 scales. Powers of 2: exact."""
    k = 2.0**exponent
    defaults = estimator.RlsParameters()
    scaled = [(*(k * force for force in row[:4]), *row[4:]) for row in rows]
    parameters = {
        "eps_fn": k * defaults.eps_fn,
        "eps_delta": k * defaults.eps_delta,
        "p0": defaults.p0 / k**2,
    }
    assert feed(scaled, **parameters) == feed(rows)


@unhurried
@given(gripping)
def test_mirroring_the_finger_does_not_matter(rows):
    mirrored = [(f_x, f_y, f_n, -tau, v_x, v_y, -omega) for f_x, f_y, f_n, tau, v_x, v_y, omega in rows]
    assert feed(mirrored) == feed(rows)


@unhurried
@given(gripping)
def test_a_quarter_turn_of_the_plane_does_not_matter(rows):
    turned = [(-f_y, f_x, f_n, tau, -v_y, v_x, omega) for f_x, f_y, f_n, tau, v_x, v_y, omega in rows]
    assert feed(turned) == feed(rows)


@unhurried
@given(gripping)
def test_counts_only_grow_by_one(rows):
    previous = (0, 0, 0)
    for e in feed(rows):
        counts = (e.events_mu_s, e.updates_mu_c, e.updates_r)
        assert all(0 <= new - old <= 1 for new, old in zip(counts, previous, strict=True))
        if e.halted:
            assert counts == previous
        previous = counts


@unhurried
@given(st.floats(0.05, 2.0), st.floats(0.004, 0.02), st.floats(3.0, 9.0))
def test_translation_then_spin_finds_any_truth(mu_c, r, f_n):
    """Closed form: n steps of constant phi leave 1 / (1 + phi^2 P0 sum lambda^-i) of the start error."""
    n = 240
    slide = [(mu_c * f_n, 0.0, f_n, 0.0, 0.02, 0.0, 0.0)] * n
    spin = [(0.0, 0.0, f_n, mu_c * f_n * r, 0.0, 0.0, 4.0)] * n
    last = feed(slide + spin)[-1]
    growth = sum(0.98**-i for i in range(1, n + 1))

    def left(phi):
        return 1.0 / (1.0 + phi**2 * growth)

    assert last.mu_c == pytest.approx(mu_c + (1.3 - mu_c) * left(f_n), rel=1e-9)
    spun = mu_c * r / last.mu_c
    assert last.r == pytest.approx(spun + (0.02 - spun) * left(last.mu_c * f_n), rel=1e-9)
