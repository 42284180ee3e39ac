"""Hard pads or rubber: what "adaptive" publishes far from the loads at which the object slipped."""

import numpy as np
import pytest
from scipy.stats import norm

import estimator
from estimator.augmented.load import exponents, limit
from estimator.augmented.parameters import AdaptiveParameters
from estimator.augmented.slip_law import FALLS, GROWS, STATES
from slipgym.validation.records import RATE

P = AdaptiveParameters()
NOISE = 0.02, 0.02, 0.04, 5e-4


def published(n, of_n, b, of_b, **parameters):
    """`exponents` of states with these exponents and their variances."""
    batch = estimator.make_batch("adaptive", 1, **parameters)
    state = batch.states[0]
    state["x"][FALLS], state["covariance"][FALLS, FALLS] = n, of_n
    state["x"][GROWS], state["covariance"][GROWS, GROWS] = b, of_b
    parameters = AdaptiveParameters.create(**parameters)
    array = np.zeros(1, AdaptiveParameters.dtype())
    for name in array.dtype.names:
        array[name] = getattr(parameters, name)
    return exponents(batch.states.view(np.recarray)[0], array.view(np.recarray)[0])


def by_sums(n, of_n, b, of_b, hard):
    """The same by sums over a grid of both exponents, each hypothesis with its likelihood."""
    grid = np.linspace(-1.5, 1.5, 3001)
    likelihoods, means, squares = [], [], []
    for mean, variance, spread in ((n, of_n, P.sd_load_exponent), (b, of_b, P.sd_radius_exponent)):
        information = 1.0 / variance - 1.0 / spread**2
        said, error = mean / variance / information, (1.0 / information + P.sd_fall**2) ** 0.5
        joint = norm.pdf(said, grid, error) * norm.pdf(grid, 0.0, spread)
        total = np.trapezoid(joint, grid)
        likelihoods.append((norm.pdf(said, 0.0, error), total))
        means.append(np.trapezoid(joint * grid, grid) / total)
        squares.append(np.trapezoid(joint * grid**2, grid) / total)
    of_hard, of_rubber = np.prod(likelihoods, axis=0)
    rubber = (1.0 - hard) * of_rubber / ((1.0 - hard) * of_rubber + hard * of_hard)
    return [
        value
        for mean, square in zip(means, squares, strict=True)
        for value in (rubber * mean, rubber * square - (rubber * mean) ** 2)
    ]


@pytest.mark.parametrize("hard", [0.0, 0.5, 0.9])
@pytest.mark.parametrize(
    ("n", "of_n", "b", "of_b"),
    [
        (0.0, 0.001, 0.0, 0.0099),
        (0.1, 0.004, 0.0, 0.0099),
        (0.3, 0.001, 0.2, 0.002),
        (0.05, 0.02, 0.1, 0.004),
    ],
)
def test_it_is_the_mean_of_both_hypotheses(n, of_n, b, of_b, hard):
    found = published(n, of_n, b, of_b, hard=hard)
    assert found == pytest.approx(by_sums(n, of_n, b, of_b, hard), rel=1e-3, abs=1e-6)


def test_without_data_it_is_the_prior():
    n, of_n, b, of_b = published(0.0, P.sd_load_exponent**2, 0.0, P.sd_radius_exponent**2)
    assert (n, b) == (0.0, 0.0)
    assert of_n == pytest.approx((1.0 - P.hard) * P.sd_load_exponent**2, rel=1e-3)
    assert of_b == pytest.approx((1.0 - P.hard) * P.sd_radius_exponent**2, rel=1e-3)


def test_a_prior_that_the_data_refute_does_not_overflow():
    found = published(0.3, 1e-12, 0.3, 1e-12, load_exponent0=0.3, sd_load_exponent=1e-5, sd_fall=0.0)
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
    moved = np.array(x)
    limit(moved, np.ascontiguousarray(covariance), np.array(limits))
    return moved


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
