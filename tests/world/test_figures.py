"""The acceptance figures hold; `scripts/validate.py` prints the same ones."""

import pytest

from slipgym.validation import EXPERIMENTS, Figure

SLOW = {"creep"}
"""Those of several seconds; `make validate` and `make test-all` run all."""
CASES = [
    pytest.param(experiment, id=experiment.__name__, marks=[pytest.mark.slow] * (experiment.__name__ in SLOW))
    for experiment in EXPERIMENTS
]


@pytest.mark.parametrize("experiment", CASES)
def test_acceptance_figures(experiment):
    figures = list(experiment())
    assert figures
    assert [figure for figure in figures if not figure.ok] == []


@pytest.mark.parametrize(("measured", "ok"), [(0.9, True), (1.0, True), (1.1, False), (float("nan"), False)])
def test_a_figure_knows_whether_it_holds(measured, ok):
    assert Figure("anything", 1.0, measured, "m").ok is ok
