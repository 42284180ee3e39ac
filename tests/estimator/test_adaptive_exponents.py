"""Hard pads or rubber: what "adaptive" publishes far from the loads at which the object slipped."""

import numpy as np
import pytest
from scipy.stats import multivariate_normal, norm

import estimator
from estimator.augmented.exponents import exponents, group_weights
from estimator.augmented.load import limit
from estimator.augmented.parameters import AdaptiveParameters
from estimator.augmented.slip_law import COP, FALLS, GROWS, SHAPE, STATES, ZERO
from tests.estimator.exact_records import RATE

P = AdaptiveParameters()
NOISE = 0.02, 0.02, 0.04, 5e-4


E = [FALLS, GROWS]
SPREADS = np.array([P.sd_load_exponent, P.sd_radius_exponent])
SENSORS = range(ZERO, SHAPE + 1)
ERRORS = np.repeat([P.sd_zero, P.sd_tilt, P.sd_cop, P.sd_shape], [2, 2, 2, 1])
"""Spread of each of `SENSORS`; the filter assumes the fraction `caution`."""


def published(x, covariance, **parameters):
    """`exponents` of these states: both, and their covariance (11, 12, 22)."""
    batch = estimator.make_batch("adaptive", 1, **parameters)
    batch.states[0]["x"], batch.states[0]["covariance"] = x, covariance
    p = AdaptiveParameters.create(**parameters).as_array().view(np.recarray)[0]
    weights = np.zeros(4)
    group_weights(p, weights)
    return exponents(batch.states.view(np.recarray)[0], p, weights)


def learned(seed, n, b, samples):
    """A linear filter that has seen noisy sums of its states, of which the exponents are n and b.

    Returns:
        Its states and their covariance; what the data alone say of the exponents; and the covariances of the
        errors of that and of the states' exponents if the sensors' errors have their whole spread.
    """
    rng = np.random.default_rng(seed)
    truth = np.zeros(STATES)
    truth[E] = n, b
    h = rng.normal(size=(samples, STATES))
    h[:, :ZERO] = 0.0
    h[:, E] /= SPREADS
    h[:, SENSORS] /= ERRORS
    y = h @ truth + rng.normal(size=samples)
    assumed = np.ones(STATES)
    assumed[E], assumed[SENSORS] = SPREADS, P.caution * ERRORS
    covariance = np.linalg.inv(np.diag(1.0 / assumed**2) + h.T @ h)
    gain = covariance @ h.T
    # what the data say: the prior of the exponents is taken out of the posterior of both
    both = covariance[np.ix_(E, E)]
    information = np.linalg.inv(both) - np.diag(1.0 / SPREADS**2)
    read = np.linalg.solve(information, np.linalg.solve(both, gain[E]))

    def of_sensors(rows):
        errors = rows @ h[:, SENSORS] * ERRORS
        return rows @ rows.T + errors @ errors.T

    missed = (gain[E] @ h[:, E] - np.eye(2)) * SPREADS
    error = of_sensors(gain[E]) + missed @ missed.T
    return gain @ y, covariance, read @ y, of_sensors(read), error


def probability_of_rubber(said, error, hard):
    """By sums over a grid of both exponents, each hypothesis with its likelihood."""
    grid = np.linspace(-0.8, 0.8, 1601)
    x, y = np.meshgrid(grid, grid, indexing="ij")
    likelihood = multivariate_normal(said, error + P.sd_fall**2 * np.eye(2))
    prior = norm.pdf(x, 0.0, SPREADS[0]) * norm.pdf(y, 0.0, SPREADS[1])
    rubber = (likelihood.pdf(np.stack([x, y], -1)) * prior).sum() * (grid[1] - grid[0]) ** 2
    return (1.0 - hard) * rubber / ((1.0 - hard) * rubber + hard * likelihood.pdf((0.0, 0.0)))


@pytest.mark.parametrize("hard", [0.0, 0.5, 0.9])
@pytest.mark.parametrize(
    ("n", "b", "samples"), [(0.0, 0.0, 30), (0.1, 0.05, 12), (0.3, 0.2, 30), (0.2, 0.1, 16)]
)
def test_it_is_the_median_of_both_hypotheses(n, b, samples, hard):
    """Rubber has the filter's exponents. Polya's normal quantile is off by up to 0.03 above -2.5."""
    x, covariance, said, of_said, error = learned(samples, n, b, samples)
    found = published(x, covariance, hard=hard)
    rubber = probability_of_rubber(said, of_said, hard)
    error = error + P.sd_fall**2 * np.diag((1.0 - covariance[E, E] / SPREADS**2) ** 2)
    for k, most in enumerate((0.5, 1.0 / 3.0)):
        spread = error[k, k] ** 0.5
        median = norm.ppf(max(1.0 - 0.5 / rubber, 0.0), x[E[k]], spread)
        assert found[k] == pytest.approx(min(max(median, 0.0), most), abs=0.04 * spread)
    off = x[E] - found[:2]
    squares = rubber * (error + np.outer(off, off)) + (1.0 - rubber) * np.outer(found[:2], found[:2])
    assert found[2:] == pytest.approx([squares[0, 0], squares[0, 1], squares[1, 1]], rel=1e-3, abs=1e-6)


def test_errors_of_the_sensors_are_no_exponent():
    """An exponent that an error of the centre of pressure may be, too, is not believed: 1 mm is 0.1 of it."""
    x, covariance = np.zeros(STATES), np.diag(np.full(STATES, 4e-4))
    x[FALLS], covariance[COP, COP] = 0.12, (P.caution * P.sd_cop) ** 2
    alone = published(x, covariance)
    covariance[FALLS, COP] = covariance[COP, FALLS] = 0.1 * covariance[COP, COP]
    explained = published(x, covariance)
    assert alone[0] > 0.05
    assert explained[0] == 0.0


def test_without_data_it_is_the_prior():
    covariance = np.diag(np.ones(STATES))
    covariance[E, E] = SPREADS**2
    n, b, of_n, both, of_b = published(np.zeros(STATES), covariance)
    assert (n, b) == (0.0, 0.0)
    assert of_n == pytest.approx((1.0 - P.hard) * P.sd_load_exponent**2, rel=1e-3)
    assert of_b == pytest.approx((1.0 - P.hard) * P.sd_radius_exponent**2, rel=1e-3)
    assert abs(both) < 1e-6


def test_a_prior_that_the_data_refute_does_not_overflow():
    x, covariance = np.zeros(STATES), np.diag(np.full(STATES, 1e-12))
    x[E] = 0.3
    found = published(x, covariance, load_exponent0=0.3, sd_load_exponent=1e-5, sd_fall=0.0)
    assert np.all(np.isfinite(found))


def held_at(f_n, exponent, seed=0):
    """Slips at 2 and 4 N, then a rest under another load; the estimate over the truth, and its sd."""
    est, rng, k = estimator.make("adaptive"), np.random.default_rng(seed), 0
    for load in (2.0, 4.0) * 4:
        mu_c = 0.4 * load**-exponent
        for i in range(60):
            slips = i >= 24
            force = mu_c * load * (1.0 if slips else 0.8)
            wrench = np.array([0.0, force, load, 0.0]) + rng.normal(size=4) * NOISE
            est.update((k := k + 1) / RATE, wrench, (0.0, 0.02 if slips else 0.0, 0.0))
    for _ in range(60):
        held = est.update((k := k + 1) / RATE, (0.0, 0.8, f_n, 0.0), (0.0, 0.0, 0.0))
    return held.mu_c / (0.4 * f_n**-exponent), held.sd_mu_c / held.mu_c


def test_a_hard_pad_and_rubber_are_told_apart():
    """At five times the load: a hard pad within 3 %, rubber within its deviation, which is larger."""
    hard, rubber = held_at(20.0, 0.0), held_at(20.0, 0.3)
    assert hard[0] == pytest.approx(1.0, abs=0.03)
    assert rubber[0] == pytest.approx(1.0, abs=1.5 * rubber[1])
    assert rubber[0] < 1.3  # a hard pad's friction would be 1.6 times as large
    assert rubber[1] > hard[1]


def limited(x, covariance, limits=(-9.0, 9.0, -9.0, 9.0, 0.0, 0.5, 0.0, 1.0 / 3.0)):
    """`limit`, of a copy of the states."""
    batch = estimator.make_batch("adaptive", 1)
    state = batch.states.view(np.recarray)[0]
    state.x[:], state.covariance[:], state.limits[:] = x, covariance, limits
    limit(state, batch.parameters_array.view(np.recarray)[0])
    return state.x


@pytest.mark.parametrize(
    ("exponent", "beyond", "bound"),
    [(FALLS, -0.07, 0.0), (FALLS, 0.6, 0.5), (GROWS, -0.2, 0.0), (GROWS, 0.5, 1.0 / 3.0)],
)
def test_an_exponent_beyond_its_bound_takes_the_other_states_along(exponent, beyond, bound):
    """The mean of all states, if the exponent is known to be at the bound."""
    rng = np.random.default_rng(exponent)
    root = 0.1 * rng.normal(size=(STATES, STATES))
    covariance, x = root @ root.T, rng.normal(size=STATES)
    x[FALLS] = x[GROWS] = 0.1
    x[exponent] = beyond
    others = [j for j in range(STATES) if j != exponent]
    known = np.linalg.inv(covariance)
    expected = x.copy()
    expected[exponent] = bound
    expected[others] -= np.linalg.solve(
        known[np.ix_(others, others)], known[others, exponent] * (bound - beyond)
    )
    other = FALLS + GROWS - exponent
    found = limited(x, covariance)
    rest = [j for j in range(STATES) if j != other]
    assert found[rest] == pytest.approx(expected[rest], rel=1e-6)


def test_within_the_bounds_nothing_moves():
    rng = np.random.default_rng(0)
    root, x = rng.normal(size=(STATES, STATES)), rng.normal(size=STATES)
    x[FALLS], x[GROWS] = 0.2, 0.1
    assert np.array_equal(limited(x, root @ root.T), x)
