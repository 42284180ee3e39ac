"""Estimators in the loop: what the table says of them."""

import numpy as np
import pytest

from policies.research.leaderboard.closed_loop import played, present
from slipgym.contact.records import pads


def test_the_truth_is_that_of_the_present_load_and_age():
    pad = pads((1, 2), mu_c=0.4, mu_s=0.5, r=0.01)
    pad["friction_scale"], pad["static_gain"], pad["radius"] = 0.9, 2.0, 0.011
    truth = present(pad)
    assert truth["mu_c"] == pytest.approx(0.36)
    assert truth["mu_s"] == pytest.approx(0.36 + 0.9 * 2.0 * 0.1)
    assert truth["r"] == pytest.approx(0.011)


@pytest.mark.slow
def test_ideal_sensors_are_learned_from_and_solved_with():
    row = played("slipgym/LinearSlip-v0", 16, 0, estimator="rls", sensors="ideal")
    assert row["solved"] >= 90.0
    assert row["dropped"] == 0.0
    assert row["mu_c error"] < 5.0
    assert 0.0 <= row["mu_c in 1 sd"] <= row["mu_c in 2 sd"] <= 100.0
    assert np.isnan(row["r error"])  # it does not turn
    assert row["reversed"] == 0.0
