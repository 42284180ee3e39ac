"""Warnings about implausible results of a record."""

from dataclasses import replace

import pytest

from estimator import DEFAULT, records
from estimator.records.summary import warnings
from slipgym.envs.arguments import DEFAULT_ESTIMATOR

GOOD = {"mu_s": 0.5, "mu_c": 0.4, "r": 0.01}


@pytest.fixture
def result(table, save):
    return records.estimate(records.load(save(table)), "rls")


def ending(result, **values):
    """The result, with other final values, all of them observed."""
    estimates = result.estimates.copy()
    for name, value in {**GOOD, **values}.items():
        estimates[name][-1], estimates[f"confidence_{name}"][-1] = value, 0.9
    for name in ("events_mu_s", "updates_mu_c", "updates_r"):
        estimates[name][-1] = 50
    return replace(result, estimates=estimates)


def test_plausible_values_are_observed(result):
    assert warnings(ending(result)) == []
    assert records.report(ending(result)).endswith("Everything was observed.")


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"mu_s": 0.011, "mu_c": 0.01}, "mu_s = 0.011 is implausible, outside 0.05 to 3"),
        ({"mu_c": 0.011}, "mu_c = 0.011 is implausible"),
        ({"mu_s": 9.0}, "mu_s = 9 is implausible"),
        ({"mu_s": 0.4}, "mu_s is not above mu_c = 0.4"),
        ({"mu_s": 0.3}, "mu_s is not above mu_c = 0.4"),
        ({"r": 0.0004}, "r = 0.4 mm is implausible, outside 1 to 50 mm"),
        ({"r": 0.06}, "r = 60 mm is implausible"),
        ({"r": 1e-4}, "r = 0.1 mm is at its lower bound"),
        ({"r": 0.1}, "r = 100 mm is at its upper bound r_max"),
    ],
)
def test_implausible_values_are_named(result, values, words):
    wrong = ending(result, **values)
    assert any(words in line for line in warnings(wrong))
    assert words in records.report(wrong)
    assert "Everything was observed" not in records.report(wrong)


def test_the_pad_bounds_the_radius(table, save):
    """A pad of 8 mm under a contact of 12 mm."""
    found = records.estimate(records.load(save(table)), "joint", r0=0.008, r_max=0.008)
    assert "r = 8 mm is at its upper bound" in records.report(found)


def test_start_values_need_no_warning(result):
    estimates = result.estimates.copy()
    for name in GOOD:
        estimates[name][-1], estimates[f"confidence_{name}"][-1] = 5.0, 0.0
    assert warnings(replace(result, estimates=estimates)) == []


def test_the_default_is_that_of_the_environments(table, save):
    assert DEFAULT_ESTIMATOR == DEFAULT == "adaptive"
    assert records.estimate(records.load(save(table))).estimator == DEFAULT
