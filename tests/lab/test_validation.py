"""The figures of the laboratory hold; `slipgym validate-parts` prints the same ones."""

import pytest

from lab.validation import EXPERIMENTS

QUICK = {"agreement", "tilt"}
"""Those of few seconds; `make validate` and `make test-all` run all."""
CASES = [
    pytest.param(
        experiment, id=experiment.__name__, marks=[pytest.mark.slow] * (experiment.__name__ not in QUICK)
    )
    for experiment in EXPERIMENTS
]


@pytest.mark.parametrize("experiment", CASES)
def test_figures(experiment):
    figures = list(experiment())
    assert figures
    assert [figure for figure in figures if not figure.ok] == []
