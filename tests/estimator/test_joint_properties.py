"""Properties of the estimators that learn from true sliding, "joint" first, that hold for any input."""

import numpy as np
import pytest
from hypothesis import example, given, settings
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
    st.tuples(force, force, steps(1, 20, 256), torque, *[st.one_of(st.just(0.0), speed)] * 2, spin),
    min_size=1,
    max_size=40,
)
extreme = st.lists(
    st.tuples(*[st.one_of(anything, force)] * 4, *[st.one_of(anything, speed)] * 3), min_size=1, max_size=40
)


def feed(rows, name="joint", **parameters):
    est = estimator.make(name, **parameters)
    return [est.update((k + 1) / RATE, row[:4], row[4:]) for k, row in enumerate(rows)]


@pytest.mark.parametrize("name", ["disc", "joint", "ukf"])
@unhurried
@example([(0, 0, 1, 0, 0, 0, 0), (0, 4e27, 1, 1, 0, 0, 0), (0, 0, 1, 0, 0, 0, 3e125), (0, 0, 1, 0, 0, 1, 0)])
@given(st.one_of(extreme, gripping))
def test_estimates_stay_finite_positive_and_in_bounds(name, rows):
    limits = estimator.JointParameters()
    for e in feed(rows, name):
        assert limits.mu_min <= e.mu_s <= limits.mu_max
        assert limits.mu_min <= e.mu_c <= limits.mu_max
        assert limits.r_min <= e.r <= limits.r_max
        assert 0.0 <= e.gamma_t <= 1.0
        assert 0.0 <= e.gamma_tau <= 1.0
        for sd in (e.sd_mu_s, e.sd_mu_c, e.sd_r):
            assert 0.0 <= sd < np.inf


@pytest.mark.parametrize("name", ["disc", "joint", "ukf"])
@unhurried
@given(st.lists(st.tuples(*[st.floats()] * 7), min_size=1, max_size=40))
def test_nan_never_travels_into_the_state(name, rows):
    batch = estimator.make_batch(name, 1)
    for k, row in enumerate(rows):
        batch.update(k / RATE, np.array([row[:4]]), np.array([row[4:]]))
    for name in set(batch.states.dtype.names or ()) - {"buffer", "forces", "twist"}:
        assert np.isfinite(batch.states[name]).all(), name
    for name in ("buffer", "forces", "twist"):
        assert not np.isnan(batch.states[name]).any(), name


@unhurried
@given(gripping, st.integers(-6, 6))
def test_the_unit_of_force_does_not_matter(rows, exponent):
    """Friction and radius are ratios, and so is a signal by its noise. Powers of 2: exact."""
    k, p = 2.0**exponent, estimator.JointParameters()
    names = ("eps_fn", "sd_force", "sd_normal", "sd_torque")
    scaled = [(*(k * force for force in row[:4]), *row[4:]) for row in rows]
    assert feed(scaled, **{name: k * getattr(p, name) for name in names}) == feed(rows)


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
def test_it_says_when_it_learns(rows):
    previous = (0, 0)
    for e in feed(rows, heuristic=True):
        assert (e.updates_mu_c - previous[0], e.updates_r - previous[1]) == (
            e.observable_mu_c,
            e.observable_r,
        )
        assert not (e.halted and (e.observable_mu_c or e.observable_r))
        previous = (e.updates_mu_c, e.updates_r)


def test_tiny_values_divide_by_nothing():
    """Far below any noise, with a noise model that lets everything through."""
    silent = dict.fromkeys(("sd_force", "sd_normal", "sd_torque", "sd_speed", "sd_spin"), 1e-300)
    for law_error in (0.0, 0.02):
        est = estimator.make("joint", law_error=law_error, **silent)
        for k, f_t in enumerate((1e-200, 1e-290, 1.0, 1e200, 1e-200, 1.0)):
            e = est.update(k / RATE, (f_t, 0.0, 1.0, f_t), (1e-1, 0.0, 1e-200))
            assert np.isfinite(e).all()
