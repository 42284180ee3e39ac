"""How soon mu_c is right again after a jump of friction in the loop."""

import numpy as np
import pytest
from typer.testing import CliRunner

from policies.commands.leaderboard import app
from policies.research.leaderboard.jumps import ENOUGH, TASKS, jumps, watched


def test_a_finger_counts_if_it_was_right_and_slips():
    slipped, again = watched(TASKS[0], 6, 3, 1.35, estimator="adaptive", sensors="realistic")
    assert slipped.shape == again.shape == (6, 2)
    right = np.isfinite(again)
    assert right.any()
    assert (again[right] <= slipped[right]).all()
    assert (again[right] > 0.0).all()  # it was wrong at the jump
    assert (slipped[np.isnan(again)] == 0.0).all()


def test_an_estimator_that_never_learns_is_never_right_again():
    deaf = {"name": "adaptive", "mu_c0": 0.5, "sd_log_mu_c0": 1e-9, "drift": 1e-9, "drift_at_rest": 0.0}
    deaf |= {"sd_jump": 1e-9, "sd_load_exponent": 1e-9, "hard": 0.0}
    found = jumps(4, 0, TASKS[:1], deaf)
    assert not found["at all"].fillna(0.0).any()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("--jumps", "--closed-loop 64"),
        ("--closed-loop 2 --jumps --estimators disc", "without --estimators"),
        ("--closed-loop 2 --jumps --parameter drif=1", "did you mean 'drift'"),
        ("--closed-loop 2 --jumps --task holdd", "hold"),
    ],
)
def test_the_command_says_what_it_cannot_do(words, said):
    asked = CliRunner().invoke(app, words.split())
    assert asked.exit_code != 0
    assert said in " ".join(asked.output.replace("│", " ").split())


@pytest.mark.slow
def test_it_is_right_again_after_little_slip():
    """LinearSlip: nearly all fingers, with either sensors. PlanarSlip: the typical one; see the page."""
    found = jumps(32, 500)
    linear = found[found["task"] == "LinearSlip"]
    assert (linear["within 0.5 s"] >= 90.0).all()
    assert (found["median"] <= ENOUGH).all()
    assert (found["seen"] >= 20).all()
